"""The error that every problem with a journal raises, with a hint on how to fix it."""

from __future__ import annotations

import errno
from pathlib import Path

from game.errors import AnaError

_FULL = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG})
_FORBIDDEN = frozenset({errno.EACCES, errno.EPERM, errno.EROFS})


class JournalError(AnaError):
    """A journal cannot be written or read; `place` is the file, with the line if it is known."""


def cannot_write(path: Path, error: OSError) -> JournalError:
    """The JournalError for a failed operation on the journal at `path`."""
    if error.errno in _FULL:
        reason = "the disk is full"
        hint = "Free some space and start again; everything recorded so far is kept."
    elif error.errno in _FORBIDDEN:
        reason = f"there is no permission to write the journal here ({error.strerror})"
        hint = "Make the folder writable, or choose another: --log DIR."
    else:
        reason = f"the journal cannot be written ({error.strerror})"
        hint = "Check the disk and the folder, or choose another: --log DIR."
    return JournalError(reason, place=str(path), hint=hint)


def cannot_read(path: Path, error: OSError) -> JournalError:
    """The JournalError for a journal at `path` that cannot be opened."""
    return JournalError(
        f"the journal cannot be read ({error.strerror})",
        place=str(path),
        hint="Give the path of a journal.jsonl that you have permission to read.",
    )
