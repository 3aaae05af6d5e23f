"""The one kind of error that a user is shown, and the hint for a misspelt name."""

from __future__ import annotations

from collections.abc import Iterable
from errno import EACCES, EDQUOT, EFBIG, ENOSPC, EPERM
from pathlib import Path

STATUS_TROUBLE = 2
"""The exit status when the user can fix what is wrong."""
STATUS_DEFECT = 1
"""The exit status when something of ours failed that the user cannot fix."""
_PACKAGE = Path(__file__).resolve().parent


class AnaError(Exception):
    """Something the user can fix; `ana` prints it to the error stream and exits with status 2.

    `message` says what is wrong, `place` where (a file, a line and column, an option), and `hint`
    what to do about it; `place` and `hint` may be empty. Subclasses keep these arguments.
    """

    def __init__(self, message: str, *, place: str = "", hint: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.place = place
        self.hint = hint

    def __str__(self) -> str:
        where = f"{self.place}: " if self.place else ""
        what = f"{self.message.rstrip('.')}. {self.hint}" if self.hint else self.message
        return where + what


def did_you_mean(name: str, names: Iterable[str]) -> str:
    """`Did you mean X?` with the nearest of `names`, whatever its capitals; else empty."""
    known = {one.casefold(): one for one in names}
    near = nearest(name.casefold(), known)
    return f"Did you mean {known[near]}?" if near else ""


def nearest(name: str, names: Iterable[str]) -> str:
    """The one of `names` that is spelt most like `name`; empty where none is much like it."""
    from difflib import get_close_matches

    return next(iter(get_close_matches(name, names, 1)), "")


def choose_from(name: str, names: Iterable[str], also: str = "") -> str:
    """The hint for a `name` that is none of `names`: the nearest, then all, then `also`."""
    names = tuple(names)
    return f"{did_you_mean(name, names)} Choose from {', '.join(names)}{also}.".lstrip()


def disk_hint(error: OSError) -> str:
    """What to do about a file of a study that the system refuses; empty where that is unknown."""
    if error.errno in (ENOSPC, EDQUOT, EFBIG):
        return "Free some space on this disk"
    if error.errno in (EACCES, EPERM):
        return "Give it to the account that owns the study: sudo chown -R ACCOUNT FOLDER"
    return ""


def where(error: BaseException) -> str:
    """Which kind of error it is, and the innermost line of ours that it came from."""
    from traceback import extract_tb

    ours = [
        f"{Path(frame.filename).relative_to(_PACKAGE)}:{frame.lineno}"
        for frame in extract_tb(error.__traceback__)
        if Path(frame.filename).is_relative_to(_PACKAGE)
    ]
    return f"{type(error).__name__} at {ours[-1] if ours else '?'}"
