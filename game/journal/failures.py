"""What can go wrong with a journal, said so that it can be mended."""

from __future__ import annotations

import errno
from pathlib import Path

from game.errors import AnaError

_FULL = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG})
_FORBIDDEN = frozenset({errno.EACCES, errno.EPERM, errno.EROFS})


class JournalError(AnaError):
    """A journal cannot be written or read; `place` names the file, and the line where known."""


def cannot_write(path: Path, error: OSError) -> JournalError:
    """The JournalError for a failed operation on the journal at `path`."""
    if error.errno in _FULL:
        reason = "the disk is full"
        mend = "Free some space and start again; all that was recorded until now is kept."
    elif error.errno in _FORBIDDEN:
        reason = f"the journal may not be written here ({error.strerror})"
        mend = "Make the folder writable, or choose another: --log DIR."
    else:
        reason = f"the journal cannot be written ({error.strerror})"
        mend = "Check the disk and the folder, or choose another: --log DIR."
    return JournalError(reason, place=str(path), mend=mend)


def cannot_read(path: Path, error: OSError) -> JournalError:
    """The JournalError for a journal at `path` that cannot be opened."""
    return JournalError(
        f"the journal cannot be read ({error.strerror})",
        place=str(path),
        mend="Give the path of a journal.jsonl that you may read.",
    )
