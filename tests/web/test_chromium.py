"""Taking part in a real Chromium: the page, its keys, and lines that break."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from game.cli import main
from game.journal.records import Covered, Debriefed, Resumed
from game.screens.study.pages import PageScreen
from game.screens.widgets.glyphs import HEADING_ARROWS, HEADING_GLYPHS
from game.study.folder import Identity, Study
from game.study.texts import BrowserWords
from game.web.hosted import Limits
from tests.study.people import cut_off, finished_study, journal_of, small_study
from tests.web.chromium import CHROMIUM, Chromium, Tab, Wire
from tests.web.served import Served, until

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed"),
]
READY = "arrow keys"
MAP = "Memorise the map"


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Study:
    return small_study(tmp_path_factory.mktemp("web") / "study")


@pytest.fixture(scope="module")
def words(study: Study) -> BrowserWords:
    return study.texts.browser


@pytest.fixture(scope="module")
def served(study: Study) -> Iterator[Served]:
    with Served(study) as server:
        yield server


@pytest.fixture(scope="module")
def chromium() -> Iterator[Chromium]:
    with Chromium() as browser:
        yield browser


@pytest.fixture(scope="module")
def tab(served: Served, chromium: Chromium) -> Tab:
    """P01 on the first screen; nothing is changed there."""
    tab = chromium.tab()
    tab.open(served.link("P01"))
    tab.wait_for(READY)
    return tab


def half_way(study: Study, name: str) -> Identity:
    identity = Identity("live", name)
    cut_off(study, identity, at="memorise")
    return identity


# --- the page -----------------------------------------------------------------------------------


def test_nothing_is_asked_of_any_other_host_and_nothing_complains(tab: Tab, served: Served) -> None:
    assert tab.asked
    assert [it for it in tab.asked if not it.startswith(served.address)] == []
    assert tab.complaints == []


def test_the_page_is_called_as_the_study(tab: Tab, study: Study) -> None:
    assert tab.evaluate("document.title") == study.settings.name


def test_keys_work_without_a_click_and_after_one_elsewhere(
    served: Served, chromium: Chromium
) -> None:
    tab = chromium.tab()
    tab.open(served.link("P02"))
    tab.wait_for(READY)
    tab.press("up", "down")
    tab.click("body")
    tab.press("left", "right", "space")
    tab.wait_for("All keys work")
    tab.close()


def test_signs_are_as_wide_as_letters(tab: Tab) -> None:
    loaded = tab.evaluate("[...document.fonts].filter(it => it.status === 'loaded').length")
    if loaded < 2:
        pytest.skip("no font has the signs of the map")
    signs = "".join(
        sorted(
            set("".join((*HEADING_GLYPHS.values(), *HEADING_ARROWS.values()))) | set("←→↑↓✓▀▄█●◖◗")
        )
    )
    widths = tab.evaluate(
        "(() => { const pen = new OffscreenCanvas(9, 9).getContext('2d');"
        f" pen.font = '20px \"Roboto Mono\"'; return [...'W{signs}'].map("
        "it => pen.measureText(it).width) })()"
    )
    assert max(widths) <= 1.02 * widths[0], dict(zip(f"W{signs}", widths, strict=True))


@pytest.mark.parametrize("size", [(1366, 657), (1920, 1080), (1000, 900)])
def test_letters_are_as_large_as_the_window_allows(tab: Tab, size: tuple[int, int]) -> None:
    tab.resize(*size)
    time.sleep(0.8)
    width, height = size
    box = tab.evaluate(
        "(({width, height}) => [width, height])"
        "(document.querySelector('.xterm-screen').getBoundingClientRect())"
    )
    assert box[0] <= width
    assert box[1] <= height
    assert max(box[0] / width, box[1] / height) > 0.9
    columns, rows = (float(it) for it in (120, 40))
    assert box[0] / columns < box[1] / rows, "a cell is taller than wide"
    tab.resize(1366, 768)
    tab.wait_for(READY)


def test_a_browser_without_webgl_has_all_columns(served: Served, chromium: Chromium) -> None:
    tab = chromium.tab()
    tab.before_each_page(
        "const real = HTMLCanvasElement.prototype.getContext;"
        "HTMLCanvasElement.prototype.getContext = function (kind, ...more) {"
        " return kind === 'webgl2' ? null : real.call(this, kind, ...more); };"
    )
    tab.open(served.link("P03"))
    tab.wait_for(READY)
    screen, letter = tab.evaluate(
        "(() => { const pen = new OffscreenCanvas(9, 9).getContext('2d');"
        " pen.font = `${document.querySelector('#terminal').dataset.fontSize}px \"Roboto Mono\"`;"
        " return [document.querySelector('.xterm-screen').getBoundingClientRect().width,"
        " pen.measureText('W').width] })()"
    )
    assert tab.evaluate("document.querySelectorAll('.xterm-rows > div').length") == 40
    assert screen / letter == pytest.approx(120, abs=0.5)
    assert screen <= tab.evaluate("innerWidth")
    tab.close()


def test_the_wheel_does_nothing(tab: Tab) -> None:
    before = tab.keys
    for pixels in (300, -300) * 5:
        tab.wheel(pixels)
    time.sleep(0.3)
    assert tab.keys == before


@pytest.mark.parametrize("size", [(390, 844), (800, 350)])
def test_a_phone_or_a_small_window_is_told_so(
    tab: Tab, words: BrowserWords, size: tuple[int, int]
) -> None:
    tab.resize(*size)
    tab.wait_for_notice(words.too_small.title)
    told = tab.evaluate(
        "[...document.querySelectorAll('#notice h1, #notice .text')].map(it => {"
        " const {left, top, right, bottom} = it.getBoundingClientRect();"
        " return [left, top, right, bottom] })"
    )
    for left, top, right, bottom in told:
        assert 0 <= left < right <= size[0]
        assert 0 <= top < bottom <= size[1]
    tab.resize(1366, 768)
    tab.wait_for_notice("")
    tab.wait_for(READY)


def test_a_wrong_link_says_so_and_opens_no_line(
    served: Served, chromium: Chromium, words: BrowserWords
) -> None:
    tab = chromium.tab()
    assert tab.open(f"{served.address}?link=P01.AAAAAAAAAAAAAAAAAAAAAA") == 403
    assert tab.notice() == words.wrong_link.title
    assert tab.lines == 0
    tab.close()


def test_a_page_from_elsewhere_cannot_use_a_participants_link(
    served: Served, chromium: Chromium
) -> None:
    tab = chromium.tab()
    tab.page.set_default_timeout(5000)
    tab.open("data:text/html,<title>evil</title>")
    line = f"ws://localhost:{served.port}/line?tab=abcdefgh&ticket={served.ticket('P03')}"
    opened = tab.evaluate(
        f"new Promise(done => {{ const it = new WebSocket('{line}');"
        "it.onopen = () => done(true); it.onerror = () => done(false); })"
    )
    assert opened is False
    tab.close()


# --- the end ------------------------------------------------------------------------------------


def test_whoever_finished_is_taken_back_to_the_panel(tmp_path: Path, chromium: Chromium) -> None:
    study = finished_study(tmp_path / "study")
    path = study.folder / "study.toml"
    address = 'return_url = "https://panel.example/done?cc={code}"'
    path.write_text(path.read_text().replace('return_url = ""', address))
    assert main(["study", "amend", str(study.folder), "--why", "panel"]) == 0
    with Served(study) as server:
        tab = chromium.tab()
        tab.stand_in("https://panel.example/", "welcome back")
        tab.open(f"{server.address}?link={server.ticket('P01', pilot=True)}")
        tab.wait_for(study.texts.debrief.title)
        tab.read_for(PageScreen.DEAF_S)
        tab.press("enter")
        until(lambda: tab.page.url.startswith("https://panel.example/"))
        (code,) = {it.record.completion_code for it in journal_of(study).entries
                   if isinstance(it.record, Debriefed)}  # fmt: skip
        assert tab.page.url == f"https://panel.example/done?cc={code}"
        assert tab.dialogs == 0
        tab.close()


@pytest.mark.slow
def test_a_full_server_asks_to_come_back_and_lets_in_when_there_is_room(
    tmp_path: Path, chromium: Chromium, words: BrowserWords
) -> None:
    study = small_study(tmp_path / "study")
    with Served(study, limits=Limits(sessions=1, away_s=0.5)) as server:
        first, second = chromium.tab(), chromium.tab()
        first.open(server.link("P01"))
        first.wait_for(READY)
        second.open(server.link("P02"))
        second.wait_for_notice(words.full.title)
        first.close()
        until(lambda: not server.programs())
        second.click("#notice button")
        second.wait_for(READY)
        (program,) = server.programs()
        os.kill(program, signal.SIGKILL)
        second.wait_for_notice(words.failed.title)
        second.close()


# --- lines that break ---------------------------------------------------------------------------


def test_a_line_that_drops_for_five_seconds_finds_the_running_program(
    served: Served, chromium: Chromium, words: BrowserWords
) -> None:
    identity = half_way(served.study, "P11")
    with Wire(served.port) as wire:
        tab = chromium.tab()
        tab.open(served.link("P11").replace(served.address, wire.address))
        tab.wait_for(MAP)
        programs = served.programs("P11")
        wire.cut()
        tab.wait_for_notice(words.interrupted.title)
        tab.press("enter")
        time.sleep(5)
        tab.forget()
        tab.resize(390, 844)
        wire.mend()
        tab.wait_for_notice(words.too_small.title)
        tab.resize(1366, 768)
        tab.wait_for_notice("")
        until(lambda: bool(tab.chunks))
        tab.wait_for(MAP)
        assert served.programs("P11") == programs != []
        tab.close()
    kinds = [type(entry.record) for entry in journal_of(served.study, identity).entries]
    assert kinds.count(Resumed) == 1, "from the cut before"
    assert Covered in kinds


@pytest.mark.slow
def test_keys_pressed_while_the_line_stalls_keep_their_order(
    served: Served, chromium: Chromium
) -> None:
    with Wire(served.port) as wire:
        tab = chromium.tab()
        tab.open(served.link("P12").replace(served.address, wire.address))
        tab.wait_for(READY)
        wire.hold(back=True)
        tab.press("up", "down", "left", "right")
        time.sleep(2)
        assert tab.notice() == ""
        tab.press("space")
        wire.hold(back=False)
        tab.wait_for("All keys work")
        tab.close()


@pytest.mark.slow
def test_a_line_that_falls_silent_is_given_up_and_found_again(
    served: Served, chromium: Chromium, words: BrowserWords
) -> None:
    with Wire(served.port) as wire:
        tab = chromium.tab()
        tab.open(served.link("P14").replace(served.address, wire.address))
        tab.wait_for(READY)
        programs = served.programs("P14")
        wire.hold(back=True)
        tab.wait_for_notice(words.interrupted.title)
        wire.hold(back=False)
        tab.wait_for_notice("")
        tab.press("up", "down", "left", "right", "space")
        tab.wait_for("All keys work")
        assert served.programs("P14") == programs != []
        tab.close()


def test_two_tabs_take_over_only_when_asked(
    served: Served, chromium: Chromium, words: BrowserWords
) -> None:
    half_way(served.study, "P13")
    person = chromium.person()
    first, second = chromium.tab(person), chromium.tab(person)
    first.open(served.link("P13"))
    first.wait_for(MAP)
    programs = served.programs("P13")
    second.open(served.link("P13"))
    second.wait_for(MAP)
    first.wait_for_notice(words.elsewhere.title)
    time.sleep(2.5)
    assert (first.lines, second.lines) == (1, 1)
    assert second.notice() == ""
    first.forget()
    first.click("#notice button")
    second.wait_for_notice(words.elsewhere.title)
    first.wait_for_notice("")
    first.wait_for(MAP)
    assert served.programs("P13") == programs != []
    first.close()
    second.close()


@pytest.mark.slow
def test_a_server_that_is_killed_and_started_again_goes_on_where_it_was(
    tmp_path: Path, chromium: Chromium, words: BrowserWords
) -> None:
    study = small_study(tmp_path / "study")
    identity = half_way(study, "P01")
    tab = chromium.tab()
    with Served(study) as server:
        port = server.port
        tab.open(server.link("P01"))
        tab.wait_for(MAP)
        os.kill(server.process.pid, signal.SIGKILL)
        tab.wait_for_notice(words.interrupted.title)
        until(lambda: not server.programs())
    tab.forget()
    with Served(study, "--port", str(port)):
        tab.wait_for_notice("")
        tab.wait_for(MAP)
    kinds = [type(entry.record) for entry in journal_of(study, identity).entries]
    assert kinds.count(Resumed) == 2
    tab.close()


@pytest.mark.slow
def test_twenty_people_at_once(tmp_path: Path, chromium: Chromium) -> None:
    study = small_study(tmp_path / "study")
    with Served(study) as server:
        tabs = [chromium.tab() for _ in range(20)]
        for number, tab in enumerate(tabs):
            tab.open(server.link(f"P{number:02}"))
        for tab in tabs:
            tab.wait_for(READY, 120)
        assert len(server.programs()) == 20
        for tab in tabs:
            tab.press("up", "down", "left", "right", "space")
        for tab in tabs:
            tab.wait_for("All keys work", 60)
            assert tab.notice() == ""
            assert tab.complaints == []
            tab.close()
    assert server.programs() == []
