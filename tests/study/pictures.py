"""`python -m tests.study.pictures FOLDER`: what participants see in a terminal, phase by phase."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from game.forms.reading import paper_forms
from game.study.folder import Identity, Study, new_study, open_study
from game.study.protocol.practice import practice_legs
from game.study.protocol.study_session import session_seed
from game.study.ready import ready_text
from game.study.texts import Texts
from tests.study.participant import TerminalParticipant
from tests.study.people import cut_off
from tests.study.server import ANA
from tests.terminal import Terminal

COLOURS = 48
SETTLE_S = 1.5
"""A page takes no keys for a moment, and shows that."""
ALL_COLOURS = {"COLORTERM": "truecolor"}


@dataclass(frozen=True)
class Phase:
    """A phase, and where to cut a participant off to have them come back to the page with that
    title: when they do `at` for so many times after they did `since`. `go` is what they then do
    before the picture."""

    name: str
    title: Callable[[Texts], str]
    at: str
    since: str = ""
    times: int = 1
    go: Callable[[TerminalParticipant], None] = lambda _: None


def _enter(shows: str) -> Callable[[TerminalParticipant], None]:
    def go(person: TerminalParticipant) -> None:
        person.terminal.press("enter")
        person.terminal.wait_for(shows)

    return go


def _play(person: TerminalParticipant) -> None:
    person.begin_mission()
    person.walk(lambda now: now.actions >= 25)


TITLES = {form.id: form.title for form in paper_forms().forms}
PHASES = (
    Phase("preflight", lambda its: its.words.preflight.title, "check"),
    Phase("memorise", lambda its: its.memorise.title, "memorise", go=_enter(" left")),
    Phase("label", lambda its: its.label.title, "label", go=_enter(" left")),
    Phase("mission-page", lambda its: its.mission.title, "read", since="label"),
    Phase("mission", lambda its: its.mission.title, "read", since="label", go=_play),
    Phase("sliders", lambda _: TITLES["sliders"], "answer", since="label"),
    Phase("likert", lambda _: TITLES["likert"], "answer", since="label", times=5),
    Phase("preference", lambda its: its.preference.title, "prefer"),
    Phase("reason", lambda its: its.reason.title, "explain"),
    Phase("debrief", lambda its: its.debrief.title, "read", since="explain"),
)


def _remind(person: TerminalParticipant) -> None:
    _play(person)
    person.terminal.press("?")
    person.terminal.wait_for(person.study.texts.lessons.walking.title)


def _answer(person: TerminalParticipant) -> None:
    for key in ("4", "down", "1", "3", "6", *"racing games"):
        person.terminal.press(key)
        person.terminal.read_for(0.3)


FORM = "gaming-experience"
IN_A_TERMINAL = (
    *PHASES,
    Phase("check", lambda _: TITLES["check"], "answer"),
    Phase("reminder", lambda its: its.mission.title, "read", since="label", go=_remind),
)


def take_pictures(folder: Path) -> None:
    """Write the pictures to `folder`, as study-PHASE.png."""
    with tempfile.TemporaryDirectory() as place:
        study = _study(Path(place) / "study")
        for number, phase in enumerate(IN_A_TERMINAL):
            identity = Identity("live", f"P{number:02}")
            cut_off(study, identity, at=phase.at, since=phase.since, times=phase.times)
            _save(study, identity, phase, folder)
        _first_pages(study, folder)
        asking = _study(Path(place) / "asking", FORM)
        cut_off(asking, Identity("live", "P01"), at="answer")
        title = next(form.title for form in asking.forms.forms if form.places == ("before",))
        phase = Phase("form", lambda _: title, "answer", go=_answer)
        _save(asking, Identity("live", "P01"), phase, folder)


def _study(folder: Path, form: str = "") -> Study:
    new_study(folder, seed=1)
    if form:
        with (folder / "forms.toml").open("a", encoding="utf-8") as file:
            file.write(f"\n{ready_text(form, 'en')}")
    return open_study(folder)


def _at_a_terminal(study: Study, identity: Identity) -> Terminal:
    command = (ANA, "study", "run", study.folder, "--participant", identity.participant)
    return Terminal(command, columns=120, rows=40, env=ALL_COLOURS)


def _save(study: Study, identity: Identity, phase: Phase, folder: Path) -> None:
    with _at_a_terminal(study, identity) as terminal:
        terminal.wait_for(phase.title(study.texts))
        terminal.read_for(SETTLE_S)
        phase.go(TerminalParticipant(terminal, study, identity))
        _write(terminal, folder, phase.name)


def _first_pages(study: Study, folder: Path) -> None:
    """What nothing can be cut off at, since nothing is recorded before consent, and how practice
    begins."""
    identity, texts = Identity("live", "P50"), study.texts
    first, *_ = practice_legs(study.practice, session_seed(study, identity))
    with _at_a_terminal(study, identity) as terminal:
        person = TerminalParticipant(terminal, study, identity)
        person.preflight()
        _write(terminal, folder, "consent")
        person.consent()
        for name, following in (
            ("", texts.lessons.walking.title),
            ("practice", texts.lessons.of(first.level).title),
        ):
            terminal.read_for(SETTLE_S)
            if name:
                _write(terminal, folder, name)
            terminal.press("enter")
            terminal.wait_for(following)
        _write(terminal, folder, "lesson")
        terminal.press("enter")
        terminal.read_for(SETTLE_S)
        _write(terminal, folder, "leg")


def _write(terminal: Terminal, folder: Path, name: str) -> None:
    terminal.read_for(SETTLE_S)
    image = terminal.image().convert("RGB").quantize(COLOURS)
    image.save(folder / f"study-{name}.png", optimize=True)


if __name__ == "__main__":
    take_pictures(Path(sys.argv[1]))
