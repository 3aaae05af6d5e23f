"""Studies made from data alone, carried to their ends by keys: in a real Chromium and over SSH."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from game.cli import main
from game.forms.items import AnyQuestion, ChoiceItem, NumberItem, ScaleItem, SliderItem, TextItem
from game.journal.records import MissionStarted, QuestionnaireAnswer, SessionEnded
from game.screens.study.form_screen import FormScreen
from game.study.course import course
from game.study.donors import without_donor
from game.study.folder import Identity, Study, new_study, open_study
from tests.study.participant import TerminalParticipant
from tests.study.people import journal_of, take_part, with_settings
from tests.study.server import ANA, BY_KEY, SSH, SSHD, Server, login
from tests.study.test_ssh_session import CHECK, QUICK
from tests.web.chromium import CHROMIUM, Chromium
from tests.web.served import Served

pytestmark = pytest.mark.slow
needs_chromium = pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed")
needs_sshd = pytest.mark.skipif(
    SSHD is None or SSH is None, reason="OpenSSH's server or client is not installed"
)
P01 = Identity("live", "P01")


class Anybody(TerminalParticipant):
    """Goes through whatever a study has."""

    def take_part(self) -> str:
        """From the first page to the last; the completion code."""
        steps = course(self.study.forms, self.study.settings)
        for step in steps:
            match step.phase:
                case "preflight":
                    self.preflight()
                case "consent":
                    self._choose(self.study.texts.consent.title, 1, lambda: True)
                case "practice":
                    self.practise()
                    self.answer_check(CHECK)
                case "memorise":
                    self.memorise()
                case "label":
                    self.label(step.round, right=1, wrong=1)
                case "mission":
                    self.begin_mission()
                    self.walk()
                case "preference":
                    self.prefer(1)
                    self.explain("Klarer")
                case "debrief":
                    return self.leave()
                case form:
                    self.answer(form)
        raise AssertionError("no debriefing")

    def answer(self, phase: str) -> None:
        """Answer every question of a form, each where it is in view."""
        form = self.study.forms.occasion(phase).form
        self._face(form.title, FormScreen.DEAF_S)
        for number, question in enumerate(form.questions, 1):
            last = number == len(form.questions)
            typed = isinstance(question, NumberItem | TextItem)
            keys = [_key(question), *(["enter" if last else "down"] if typed else [])]
            self._press(self._answered(self.journal.answers + 1), *keys)
            if not (typed or last):
                self._press(self._settled(), "down")
        if not typed:
            self.terminal.press("enter")
        self._wait(self._shows(form.title, no=True))


def _key(question: AnyQuestion) -> str:
    match question:
        case SliderItem():
            return "7"
        case ScaleItem() | ChoiceItem():
            return "2"
        case NumberItem():
            return "30"
        case TextItem():
            return "x"


def two_by_two(folder: Path) -> Study:
    """German: two memorise times and two static levels, with workload, demographics and an
    attention check."""
    new_study(folder, seed=3, blocks=1, language="de")
    ready = [
        subprocess.run(
            [ANA, "study", "forms", name, "--language", "de"],
            capture_output=True,
            check=True,
            text=True,
        ).stdout
        for name in ("nasa-tlx", "demographics", "attention-check")
    ]
    with (folder / "forms.toml").open("a", encoding="utf-8") as file:
        file.write("\n".join(["", *ready]))
    _add(folder, "static_levels = [1, 3]")
    return open_study(folder)


def yoked(folder: Path) -> Study:
    """ANA against an instructor that repeats the levels of somebody else's mission."""
    new_study(folder, seed=3, blocks=1)
    _add(folder, 'instructors = ["ana", "yoked"]')
    return open_study(folder)


def _add(folder: Path, line: str) -> None:
    path = folder / "study.toml"
    path.write_text(path.read_text().replace("label_seconds", f"{line}\nlabel_seconds", 1))


def in_chromium(study: Study, _: Path) -> None:
    with Served(study) as server, Chromium() as chromium:
        tab = chromium.tab()
        tab.open(server.link("P01"))
        code = Anybody(tab, study, P01).take_part()
        tab.wait_for_notice(study.texts.browser.finished.title)
        assert tab.evaluate("document.querySelector('#notice code').textContent") == code
        assert tab.complaints == []


def over_ssh(study: Study, keys: Path) -> None:
    with (
        Server(study.folder, keys, {"p01": BY_KEY.format("P01")}) as server,
        login(server, "p01") as terminal,
    ):
        Anybody(terminal, study, P01).take_part()


@pytest.mark.parametrize(
    "line",
    [pytest.param(in_chromium, marks=needs_chromium), pytest.param(over_ssh, marks=needs_sshd)],
)
@pytest.mark.parametrize("made", [two_by_two, yoked])
def test_a_study_made_from_data_is_carried_to_its_end(
    made: Callable[[Path], Study], line: Callable[[Study, Path], None], tmp_path: Path
) -> None:
    study = with_settings(made(tmp_path / "study"), QUICK)
    if other := study.settings.yoked_to:
        assert main(["study", "check", str(study.folder)]) == 2, "no pilot has been"
        for number in range(8):
            take_part(study, Identity("pilot", f"T{number}"))
        assert not without_donor(study.folder, study.buildings, other)
    assert main(["study", "check", str(study.folder)]) == 0
    line(study, tmp_path / "keys")
    records = [entry.record for entry in journal_of(study, P01).entries]
    assert records[-1] == SessionEnded("finished")
    given = {it.item for it in records if isinstance(it, QuestionnaireAnswer)}
    assert given >= {question.id for form in study.forms.forms for question in form.questions}
    coaches = {it.coach.kind for it in records if isinstance(it, MissionStarted)}
    assert {it.kind for it in study.settings.pair} <= coaches
    assert main(["verify", str(study.folder)]) == 0
    assert main(["study", "export", str(study.folder), str(tmp_path / "dataset")]) == 0
