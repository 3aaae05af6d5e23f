"""What the statistics of one study cost, beside R's own packages for the same tests."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

REFERENCE = Path(__file__).resolve().parents[1] / "reference"
#: 100 people in nine cells of unequal size.
DATASET = "unbalanced"
SHIPPED = Path(__file__).resolve().parents[2] / "data" / "simulated"


def analyse_shipped_s() -> float:
    """Processor seconds of `ana analyse` on the shipped study, cold."""
    return _analyse_s(SHIPPED)


def analyse_s() -> float:
    """Processor seconds of `ana analyse` on the data that R is given, cold."""
    return _analyse_s(
        REFERENCE / f"{DATASET}.csv", "--quiz", str(REFERENCE / f"{DATASET}_quiz.csv")
    )


def r_s() -> float | None:
    """Processor seconds of R for the same tests; None where R or a package is missing."""
    rscript = shutil.which("Rscript")
    if rscript is None:
        return None
    try:
        return _spent_s((rscript, "-e", f'source("statistics.R"); same_tests("{DATASET}")'))
    except subprocess.CalledProcessError:
        return None


def _analyse_s(source: Path, *more: str) -> float:
    with tempfile.TemporaryDirectory() as folder:
        out = str(Path(folder) / "out.json")
        return _spent_s(
            (sys.executable, "-m", "game", "analyse", str(source), "--json", out, *more)
        )


def _spent_s(command: Sequence[str]) -> float:
    """User and system time of a command and its children."""
    before = os.times()
    subprocess.run(
        command, cwd=REFERENCE, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    after = os.times()
    return (
        after.children_user - before.children_user + after.children_system - before.children_system
    )
