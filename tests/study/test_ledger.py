"""The ledger: atomic, durable, auditable."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections import Counter
from multiprocessing import get_context
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.study.design import design_cell
from game.study.ledger import Ledger, LedgerError, SessionOutcome, SlotTaken, StudyCreated, slot_of

ASK = "import sys; from pathlib import Path; from game.study.ledger import Ledger; "


@pytest.fixture
def ledger(tmp_path: Path) -> Ledger:
    ledger = Ledger(tmp_path / "ledger.jsonl", now=lambda: "2026-01-01T00:00:00.000+00:00")
    ledger.create(seed=5, blocks=1, settings_hash="abc")
    return ledger


def ask(path: Path, participant: str) -> None:
    Ledger(path).allocate(participant, "live")


def test_twenty_at_once_get_twenty_slots_in_exact_balance(ledger: Ledger) -> None:
    asking = [
        get_context("fork").Process(target=ask, args=(ledger.path, f"P{number:02}"))
        for number in range(20)
    ]
    for process in asking:
        process.start()
    for process in asking:
        process.join(60)
    assert [process.exitcode for process in asking] == [0] * 20
    taken = [entry for entry in ledger.entries() if isinstance(entry, SlotTaken)]
    assert sorted(entry.slot for entry in taken) == list(range(20))
    assert len({entry.participant for entry in taken}) == 20
    assert [entry.cell for entry in taken] == [design_cell(5, "live", slot) for slot in range(20)]
    first_half = [entry.cell.static_level for entry in taken[:12]]
    assert set(Counter(first_half).values()) == {4}


def test_asking_again_gives_the_same_slot(ledger: Ledger) -> None:
    first = ledger.allocate("P1", "live")
    ledger.allocate("P2", "live")
    assert ledger.allocate("P1", "live") == first
    assert slot_of(ledger.entries(), "P3", "live") is None


def test_pilot_and_simulated_sessions_take_no_live_slot(ledger: Ledger) -> None:
    ledger.allocate("P1", "pilot")
    ledger.allocate("P1", "simulated")
    assert ledger.allocate("P1", "live").slot == 0


def test_a_full_study_says_so(ledger: Ledger) -> None:
    for number in range(24):
        ledger.allocate(f"P{number}", "live")
    with pytest.raises(LedgerError, match="all 24 places"):
        ledger.allocate("P24", "live")


def test_a_dropouts_slot_is_given_again_only_by_setting(ledger: Ledger) -> None:
    dropped = ledger.allocate("P1", "live")
    ledger.end_session("P1", "live", "dropped")
    ledger.end_session("P1", "live", "dropped")
    assert sum(isinstance(entry, SessionOutcome) for entry in ledger.entries()) == 1
    assert ledger.allocate("P2", "live").slot == 1
    again = ledger.allocate("P3", "live", refill=True)
    assert (again.slot, again.cell, again.refill) == (dropped.slot, dropped.cell, True)
    assert ledger.allocate("P4", "live", refill=True).slot == 2


def test_a_lock_held_by_a_killed_process_is_free(ledger: Ledger) -> None:
    code = ASK + (
        "import time; ledger = Ledger(Path(sys.argv[1]))\n"
        "with ledger._locked(): print('held', flush=True); time.sleep(60)"
    )
    holder = subprocess.Popen(
        [sys.executable, "-c", code, str(ledger.path)], stdout=subprocess.PIPE, text=True
    )
    assert holder.stdout is not None
    assert holder.stdout.readline() == "held\n"
    holder.send_signal(signal.SIGKILL)
    holder.wait(10)
    holder.stdout.close()
    assert ledger.allocate("P1", "live").slot == 0


@given(cut=st.integers(0, 400))
def test_a_torn_tail_never_counts_and_is_repaired(tmp_path_factory, cut: int) -> None:  # type: ignore[no-untyped-def]
    ledger = Ledger(tmp_path_factory.mktemp("torn") / "ledger.jsonl", now=lambda: "2026")
    ledger.create(seed=5, blocks=1, settings_hash="abc")
    start = ledger.path.stat().st_size
    ledger.allocate("P1", "live")
    ledger.allocate("P2", "live")
    os.truncate(ledger.path, max(start, ledger.path.stat().st_size - cut))
    survived = sum(isinstance(entry, SlotTaken) for entry in ledger.entries())
    assert ledger.allocate("P9", "live").slot == survived
    assert ledger.path.read_bytes().endswith(b"\n")
    assert isinstance(ledger.entries()[0], StudyCreated)


def test_a_garbled_entry_is_named_by_its_line(ledger: Ledger) -> None:
    with ledger.path.open("a") as file:
        file.write('{"type": "slot_taken"\n')
    with pytest.raises(LedgerError, match="line 2"):
        ledger.allocate("P1", "live")


def test_a_second_study_in_the_same_folder_is_refused(ledger: Ledger) -> None:
    with pytest.raises(LedgerError, match="already"):
        ledger.create(seed=1, blocks=1, settings_hash="abc")


def test_the_ledger_is_private(ledger: Ledger) -> None:
    assert ledger.path.stat().st_mode & 0o777 == 0o600
