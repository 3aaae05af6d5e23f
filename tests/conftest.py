"""What all tests share: hypothesis does not fail for a slow machine, and repeats itself in CI."""

import os

import pytest
from hypothesis import settings

settings.register_profile("local", deadline=None)
settings.register_profile("ci", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("ci" if os.environ.get("CI") else "local")

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
