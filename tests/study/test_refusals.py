"""What participants who cannot take part read: the study's words, never a path or a hint."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from game.journal.records import PracticeChecked, SessionEnded
from game.screens.study.choice import ChoiceScreen
from game.screens.study.pages import PageScreen
from game.study.folder import Identity, Study, open_study
from game.study.lab.leaving import drop_out, withdraw
from game.study.ledger import ending_of
from game.study.texts import shipped_texts
from tests.study.people import cut_off, journal_of, small_study, take_part
from tests.study.server import ANA, BY_KEY, SSH, SSHD, Server, login
from tests.terminal import Terminal

P01 = Identity("live", "P01")
NO_PLACE = "No place is left"
EXPERIMENTERS_WORDS = (
    "ledger",
    ".jsonl",
    "Traceback",
    "Create another",
    "Put it back",
    "ana study",
)


def unfit_words(study: Study, shown: str) -> list[str]:
    return [word for word in (str(study.folder), *EXPERIMENTERS_WORDS) if word in shown]


def at_login(study: Study, columns: int = 120, rows: int = 40) -> Terminal:
    """What the server runs for P01, who logs in with their own key."""
    command: list[str | Path] = [ANA, "study", "login", study.folder]
    env = {"ANA_PARTICIPANT": P01.participant}
    return Terminal(command, columns=columns, rows=rows, env=env)


@pytest.fixture
def study(tmp_path: Path) -> Study:
    study = small_study(tmp_path / "study")
    study.ledger.agree(study.inputs)
    return study


@pytest.fixture
def server(study: Study, tmp_path: Path) -> Iterator[Server]:
    if SSHD is None or SSH is None:
        pytest.skip("OpenSSH's server or client is not installed")
    with Server(study.folder, tmp_path / "keys", {"p01": BY_KEY.format("P01")}) as running:
        yield running


def test_a_newcomer_to_a_closed_study_is_told_so_over_ssh(server: Server, study: Study) -> None:
    study.ledger.close()
    before = study.ledger.path.read_bytes()
    with login(server, "p01") as terminal:
        shown = terminal.wait_for(NO_PLACE)
        terminal.read_for(PageScreen.DEAF_S)
        terminal.press("enter")
        assert terminal.wait() == 0
        assert unfit_words(study, shown + terminal.text()) == []
    assert study.ledger.path.read_bytes() == before
    assert not study.home(P01).exists()


def test_the_words_for_a_newcomer_need_no_large_window(study: Study) -> None:
    study.ledger.close()
    with at_login(study, columns=80, rows=24) as terminal:
        shown = terminal.wait_for("experimenter")
        assert NO_PLACE in shown
        terminal.read_for(PageScreen.DEAF_S)
        terminal.press("enter")
        assert terminal.wait() == 0


def test_people_who_practise_while_the_study_is_closed_are_told_afterwards(study: Study) -> None:
    check = study.forms.check
    assert check is not None
    cut_off(study, P01, at="answer", times=len(check.questions))
    last = check.questions[-1]
    with at_login(study) as terminal:
        terminal.wait_for(last.text)
        study.ledger.close()
        terminal.read_for(ChoiceScreen.DEAF_S)
        terminal.press(str(last.right), "enter")
        terminal.wait_for(study.texts.check_right.title)
        terminal.read_for(PageScreen.DEAF_S)
        terminal.press("enter")
        shown = terminal.wait_for(NO_PLACE)
        terminal.read_for(PageScreen.DEAF_S)
        terminal.press("enter")
        assert terminal.wait() == 0
        assert unfit_words(study, shown + terminal.text()) == []
    kept = [entry.record for entry in journal_of(study, P01).entries]
    assert any(isinstance(record, PracticeChecked) for record in kept)
    assert kept[-1] == SessionEnded("turned_away")
    assert ending_of(study.ledger.entries(), "P01", "live") == "turned_away"


def test_a_drop_out_whose_place_was_given_away_is_told_the_same(tmp_path: Path) -> None:
    study = small_study(tmp_path / "study", refill_dropouts="true")
    cut_off(study, P01, at="label")
    drop_out(study, P01)
    study.ledger.allocate("P02", "live", refill=True)
    with at_login(study) as terminal:
        shown = terminal.wait_for(NO_PLACE)
        terminal.read_for(PageScreen.DEAF_S)
        terminal.press("enter")
        assert terminal.wait() == 0
        assert unfit_words(study, shown + terminal.text()) == []


def test_people_who_have_withdrawn_are_told_that_their_data_are_deleted(study: Study) -> None:
    take_part(study, P01)
    withdraw(study, P01)
    with at_login(study) as terminal:
        shown = terminal.wait_for(study.texts.withdrawn.title)
        terminal.read_for(PageScreen.DEAF_S)
        terminal.press("enter")
        assert terminal.wait() == 0
        assert unfit_words(study, shown + terminal.text()) == []


def test_problems_are_shown_without_paths(study: Study) -> None:
    take_part(study, P01)
    path = study.folder / "study.toml"
    path.write_text(path.read_text().replace("label_seconds = 6", "label_seconds = 7"))
    with at_login(study) as terminal:
        shown = terminal.wait_for("changed after")
        terminal.read_for(PageScreen.DEAF_S)
        terminal.press("enter")
        assert terminal.wait() == 2
        assert study.texts.words.trouble.title in shown
        assert unfit_words(study, shown + terminal.text()) == []


@pytest.mark.parametrize("spoilt", ["study.toml", "texts.toml"])
def test_a_study_that_cannot_be_opened_says_so_in_the_studys_words(
    study: Study, spoilt: str
) -> None:
    path = study.folder / spoilt
    path.write_text(path.read_text().replace("[", "[[", 1))
    with at_login(study) as terminal:
        assert terminal.wait() == 2
        shown = terminal.text()
    assert shipped_texts().words.trouble.title in shown
    assert unfit_words(study, shown) == []


def test_a_translated_study_asks_for_the_id_in_its_own_words(study: Study) -> None:
    path = study.folder / "texts.toml"
    shipped = study.texts.login.ask
    path.write_text(path.read_text().replace(shipped, "Ihre Teilnehmernummer:"))
    assert open_study(study.folder).texts.login.ask == "Ihre Teilnehmernummer:"
    command: list[str | Path] = [ANA, "study", "login", study.folder]
    with Terminal(command, columns=120, rows=40) as terminal:
        terminal.wait_for("Ihre Teilnehmernummer:")
        terminal.write(b"a b\r")
        assert unfit_words(study, terminal.wait_for("'a b' is not")) == []


def test_an_undecodable_id_is_asked_for_again(study: Study) -> None:
    command: list[str | Path] = [ANA, "study", "login", study.folder]
    env = {"PYTHONIOENCODING": "utf-8:strict"}
    with Terminal(command, columns=120, rows=40, env=env) as terminal:
        terminal.wait_for(study.texts.login.ask)
        terminal.write(b"\xe4\r")
        assert unfit_words(study, terminal.wait_for("is not a participant ID")) == []
