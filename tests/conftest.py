"""What all tests share: the order they run in, and what they may be skipped for.

Hypothesis does not fail for a slow machine, and repeats itself in CI.
"""

import gc
import os
from contextlib import suppress
from importlib import import_module
from itertools import groupby
from pathlib import Path

import pytest
from hypothesis import settings

settings.register_profile("local", deadline=None)
settings.register_profile("ci", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("ci" if os.environ.get("CI") else "local")

TESTS = Path(__file__).parent

MISSING = {
    "root may read everything": "a user who is not root",
    "OpenSSH's server or client is not installed": "an OpenSSH server",
    "Chromium is not installed": "Chromium",
    "no font has the signs of the map": "the font DejaVu Sans Mono",
    "R is not installed": "R",
    "the extra `cluster` is not installed": "the extra cluster",
    "the extra `bayes` is not installed": "the extra bayes",
}
"""The reasons for which a test may be skipped, and what is missing then."""

LAST_LINE = pytest.StashKey[str]()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """Two workers a core: a test of a screen or of a terminal waits for most of its time."""
    return 2 * (os.cpu_count() or 1)


def pytest_collection(session: pytest.Session) -> None:
    """In the whole suite, import the files from another one on in each worker.

    Pytest rewrites the assertions of every file and keeps the result: where all workers began with
    the first file, each would rewrite every file itself when nothing is kept yet.
    """
    worker = getattr(session.config, "workerinput", None)
    if worker is None or session.config.args != session.config.getini("testpaths"):
        return
    files = sorted(TESTS.rglob("test_*.py"))
    first = len(files) * int(worker["workerid"].removeprefix("gw")) // worker["workercount"]
    for file in files[first:] + files[:first]:
        with suppress(Exception):  # what is wrong with a file is said when it is collected
            import_module(".".join(file.relative_to(TESTS.parent).with_suffix("").parts))


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Deal what is `long`, file by file, to the beginnings of what the workers are given first.

    `worksteal` gives each worker a run of tests, all of a length, and moves tests from the ends of
    these runs later.
    """
    if not hasattr(config, "workerinput"):
        return
    workers = config.workerinput["workercount"]
    long = [item for item in items if item.get_closest_marker("long")]
    others = [item for item in items if not item.get_closest_marker("long")]
    files = [list(group) for _, group in groupby(long, key=lambda item: item.path)]
    ordered: list[pytest.Item] = []
    for worker in range(workers):
        first = [item for file in files[worker::workers] for item in file]
        rest = (len(items) - len(ordered)) // (workers - worker) - len(first)
        ordered += first + others[:rest]
        del others[:rest]
    items[:] = ordered


def pytest_collection_finish() -> None:
    """Leave what was imported out of every later collection of garbage."""
    gc.collect()
    gc.freeze()


@pytest.hookimpl(tryfirst=True)
def pytest_sessionfinish(session: pytest.Session) -> None:
    """Fail where a test was skipped for any other reason than a missing program."""
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    if reporter is None:
        return
    skipped = [str(report.longrepr[2]) for report in reporter.stats.get("skipped", ())]
    reasons = [reason.removeprefix("Skipped: ") for reason in skipped]
    strange = sorted({reason for reason in reasons if reason not in MISSING})
    missing = sorted({MISSING[reason] for reason in reasons if reason in MISSING})
    if strange:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED
        session.config.stash[LAST_LINE] = f"no reason to skip a test: {'; '.join(strange)}"
    elif missing:
        session.config.stash[LAST_LINE] = f"not tested for want of: {', '.join(missing)}"


def pytest_unconfigure(config: pytest.Config) -> None:
    """Say what was missing, in the very last line."""
    if line := config.stash.get(LAST_LINE, ""):
        config.get_terminal_writer().line(line)
