"""Everything recorded about one participant, for that participant."""

from __future__ import annotations

from pathlib import Path

from game.journal.folders import JOURNAL
from game.journal.reader import read_file, read_journal
from game.study.folder import Identity, Study, StudyError
from game.study.lab.leaving import recorded
from game.study.lab.psychds import codebook_page, table_text
from game.tables.session_tables import row_types, session_tables


def write_own_data(study: Study, identity: Identity, out: Path) -> int:
    """Write the journal, its tables and their codebook to the new folder `out`; how many files.

    Raises StudyError where the study never heard of the participant, nothing was recorded, or `out`
    is there already or cannot be written.
    """
    path = study.home(identity) / JOURNAL
    found = recorded(study, identity)
    if found.trouble:
        raise StudyError(f"their data cannot be given: {found.trouble}")
    if not found.records:
        raise StudyError(
            f"nothing has been recorded about {identity.participant}", place=str(study.folder)
        )
    if out.exists():
        raise StudyError("there already is such a folder", place=str(out), hint="Choose a new one")
    tables = session_tables(read_journal(path), forms=study.forms)
    types = row_types(study.forms)
    files = {JOURNAL: read_file(path), "codebook.md": codebook_page(types).encode()}
    for name, row in types.items():
        files[f"{name}.csv"] = table_text(row, tables.table(name)).encode()
    try:
        out.mkdir(mode=0o700, parents=True)
        for name, data in files.items():
            (out / name).write_bytes(data)
    except OSError as error:
        raise StudyError(
            f"the data cannot be written ({error.strerror})",
            place=str(out),
            hint="Choose a folder that you can write to",
        ) from error
    return len(files)
