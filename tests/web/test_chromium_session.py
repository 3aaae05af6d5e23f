"""A participant goes through a whole study in a real Chromium, by keys alone, from the link to the
completion code, and reloads the page in mid-mission."""

from __future__ import annotations

import os
import subprocess
import time
from pathlib import Path

import pytest

from game.journal.folders import JOURNAL
from game.journal.history import Step
from game.journal.records import Covered, Debriefed, PhaseEnded, PreferenceGiven, Resumed
from game.study.folder import Identity
from tests.study.participant import TerminalParticipant
from tests.study.people import journal_of, small_study
from tests.study.server import ANA
from tests.web.chromium import CHROMIUM, Chromium
from tests.web.served import Served

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed"),
]
PICTURES = os.environ.get("ANA_PICTURES", "")
"""A folder for pictures of every phase, where they are wanted."""
P01 = Identity("live", "P01")
QUICK = {
    "memorise_seconds": "[1, 2]",
    "label_seconds": "60",
    "duration_ms": "5000",
    "moves_per_second": "100",
    "treat_red_ms": "200",
    "treat_blue_ms": "100",
}
SLIDERS = {"engagement": 81, "confidence": 100, "frustration": 7, "confusion": 42}
STATEMENTS = {"pref1": 5, "pref2": 4, "pref3": 3, "pref4": 1}


def test_a_whole_session_by_keys_with_a_reload_in_mid_mission(tmp_path: Path) -> None:
    study = small_study(tmp_path / "study", **QUICK)
    with Served(study) as server, Chromium() as chromium:
        tab = chromium.tab()
        assert tab.open(server.link("P01")) == 200
        person = TerminalParticipant(tab, study, P01)
        person.preflight()
        person.consent()
        person.practise()
        person.answer_check((1, 2, 3, 3))
        person.memorise()
        person.label(1, right=2, wrong=1)
        person.begin_mission()
        person.walk(lambda now: now.exposure_ms >= 1000)
        tab.forget()
        began = time.monotonic()
        tab.reload()
        person.slide(SLIDERS)
        assert time.monotonic() - began < 60
        assert tab.dialogs == 1, "leaving in mid-mission is asked about"
        person.rate(STATEMENTS)
        person.memorise()
        person.label(2, right=1, wrong=1)
        person.begin_mission()
        person.walk()
        person.slide(SLIDERS)
        person.rate(STATEMENTS)
        person.prefer(2)
        person.explain("It was clearer, where to go")
        code = person.leave()
        tab.wait_for_notice(study.texts.browser.finished.title)
        assert tab.evaluate("document.querySelector('#notice code').textContent") == code
        tab.resize(390, 844)
        time.sleep(0.6)
        assert tab.notice() == study.texts.browser.finished.title, "the code stays in sight"
        assert tab.complaints == []
        assert [it for it in tab.asked if not it.startswith(server.address)] == []
    entries = journal_of(study, P01).entries
    records = [entry.record for entry in entries]
    ended = [
        (Step(entry.envelope.phase, entry.envelope.round), entry.record.ending)
        for entry in entries
        if isinstance(entry.record, PhaseEnded)
    ]
    assert ended == [(step, "completed") for step in study.course]
    assert Covered in map(type, records), "the page was away for a moment"
    assert Resumed not in map(type, records), "but found the running program"
    assert [it.completion_code for it in records if isinstance(it, Debriefed)] == [code]
    assert [it.preferred_round for it in records if isinstance(it, PreferenceGiven)] == [2]
    verified = subprocess.run([ANA, "verify", study.home(P01) / JOURNAL], capture_output=True)
    assert verified.returncode == 0, verified.stdout
