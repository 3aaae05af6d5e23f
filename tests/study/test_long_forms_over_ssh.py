"""German and Japanese studies with ten sliders and twelve statements, done over SSH by keys."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest

from game.journal.history import Step
from game.journal.records import QuestionnaireAnswer, SessionEnded
from game.session.verification import verify
from game.study.folder import Identity, Study, new_study, open_study
from tests.screens.study.test_languages import japanese_study
from tests.study.participant import TerminalParticipant
from tests.study.people import journal_of, with_settings
from tests.study.server import BY_KEY, SSH, SSHD, Server, login
from tests.study.test_ssh_session import CHECK, QUICK

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        SSHD is None or SSH is None, reason="OpenSSH's server or client is not installed"
    ),
]
P01 = Identity("live", "P01")
MANY = {"sliders": 10, "likert": 12}


def lengthened(study: Study) -> Study:
    """The study with `MANY` questions on each of its long forms: its own, and them again longer."""
    path = study.folder / "forms.toml"
    head, *forms = re.split(r"(?m)^(?=\[\[form\]\]$)", path.read_text("utf-8"))
    for number, form in enumerate(forms):
        for name, wanted in MANY.items():
            if f'id = "{name}"' in form:
                _, *items = re.split(r"(?m)^(?=\[\[form\.item\]\]$)", form)
                more = (again(items[n % len(items)], n) for n in range(wanted - len(items)))
                forms[number] = f"{form.rstrip()}\n\n{''.join(more)}"
    path.write_text(head + "".join(forms), "utf-8")
    return open_study(study.folder)


def again(item: str, number: int) -> str:
    """An item under another id, its text said three times."""
    lines = [line for line in item.splitlines() if line and not line.startswith(("#", "role"))]
    item = "\n".join(lines) + "\n\n"
    item = re.sub(r'(?m)^id = "(\w+)"', rf'id = "\1_{number}"', item)
    return re.sub(r'(?m)^text = "(.*)"', r'text = "\1 \1 \1"', item)


def german_study(folder: Path) -> Study:
    new_study(folder, seed=3, blocks=1, language="de")
    return open_study(folder)


@pytest.mark.parametrize("made", [german_study, japanese_study])
def test_a_long_study_is_carried_to_its_end(made: object, tmp_path: Path) -> None:
    assert callable(made)
    study = lengthened(with_settings(made(tmp_path / "study"), QUICK))
    counts = {name: len(study.forms.occasion(name).form.questions) for name in MANY}
    assert counts == MANY
    with (
        Server(study.folder, tmp_path / "keys", {"p01": BY_KEY.format("P01")}) as server,
        login(server, "p01") as terminal,
    ):
        person = TerminalParticipant(terminal, study, P01)
        person.preflight()
        person.consent()
        person.practise()
        person.answer_check(CHECK)
        for round_ in (1, 2):
            person.memorise()
            person.label(round_, right=1, wrong=1)
            person.begin_mission()
            person.walk()
            person.fill("sliders", "7")
            person.fill("likert", "2")
        person.prefer(1)
        person.explain("größer, 大きい")
        person.leave()
    entries = journal_of(study, P01).entries
    given = Counter(
        Step(it.envelope.phase, it.envelope.round)
        for it in entries
        if isinstance(it.record, QuestionnaireAnswer)
    )
    asked = {Step(name, round_): MANY[name] for name in MANY for round_ in (1, 2)}
    assert {step: given[step] for step in asked} == asked
    assert entries[-1].record == SessionEnded("finished")
    assert verify(study.home(P01) / "journal.jsonl").difference is None
