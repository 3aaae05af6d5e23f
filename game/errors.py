"""The one kind of error that a user is shown."""

from __future__ import annotations


class AnaError(Exception):
    """Something the user can mend; `ana` prints it to the error stream and leaves with status 2.

    `message` says what is wrong, `place` where (a file, a line and column, an option) and `mend`
    what to do about it; the last two may be empty. Rooms subclass it and keep its arguments.
    """

    def __init__(self, message: str, *, place: str = "", mend: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.place = place
        self.mend = mend

    def __str__(self) -> str:
        where = f"{self.place}: " if self.place else ""
        what = f"{self.message.rstrip('.')}. {self.mend}" if self.mend else self.message
        return where + what
