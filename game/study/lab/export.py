"""A study as a Psych-DS dataset: tidy tables, codebook, instruments and raw journals.

The same study gives the same bytes: no export time, everything in order. Sessions of different
modes never share a file. What participants wrote in their own words goes into a file of its own
and is removed from the raw journals.
"""

from __future__ import annotations

import os
import shutil
import tomllib
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec

from game import __version__
from game.errors import disk_hint
from game.forms.reading import BLANK, ReadForms, read_forms
from game.journal.folders import JOURNAL, SESSIONS, journals
from game.journal.reader import Transcript, read_file
from game.journal.records import STUDY_MODES, StudyMode
from game.journal.sink import make_folders
from game.study.folder import INSTRUCTIONS, LEDGER, SETTINGS, TEXTS, VERSIONS, StudyError
from game.study.lab.anonymous import anonymised
from game.study.lab.psychds import (
    IGNORE_FILES,
    IGNORED,
    DatasetNotes,
    codebook_page,
    codebook_table,
    description,
    file_name,
    table_text,
)
from game.study.lab.sessions import sessions_of
from game.study.ledger import Ledger, LedgerEntry, is_closed, slot_of
from game.study.study_settings import StudySettings, read_settings
from game.tables.rows import TableRow
from game.tables.session_tables import ROW_TYPES, Tables, combined, row_types, tables_of
from game.toml_words import in_plain_words, parted

DATASET = "dataset.toml"
"""The optional file of `DatasetNotes` in the study folder."""

DESCRIPTION = "dataset_description.json"
APART = "identifying"
FREE_TEXT = "freetext"


@dataclass(frozen=True)
class Exported:
    """What was written: the number of sessions of each mode, and of rounds with a result.
    `unblinded` means that the study is open and the ledger now records that its allocation was
    looked at; `dropped` are modes that an earlier export in the same place had and this one has
    not."""

    sessions: dict[StudyMode, int]
    rounds: dict[StudyMode, int]
    unblinded: bool
    dropped: tuple[StudyMode, ...] = ()


def export_study(
    folder: Path,
    out: Path,
    modes: Sequence[StudyMode] = ("live",),
    *,
    without: Collection[str] = (),
    anonymous: bool = False,
) -> Exported:
    """Write the dataset of the study in `folder` to `out`, replacing an earlier export there.

    The sessions in the folders `without` are left out, and the dataset says so. `anonymous` gives
    everybody another pseudonym and other dates, and leaves their own words out. Exporting the live
    data of an open study unblinds it, which the ledger records. Raises StudyError if there is no
    session of these modes or `out` is something else, and JournalError for a journal that cannot be
    read or does not belong there; in both cases nothing is changed.
    """
    ledger = Ledger(folder / LEDGER)
    settings, _ = read_settings(folder / SETTINGS)
    forms = read_forms(folder, BLANK)
    entries = ledger.entries()
    found: dict[StudyMode, Tables] = {}
    files: dict[str, bytes] = {}
    for mode in dict.fromkeys(modes):
        sessions = [
            (transcript, without_free_text(_lines_read(transcript)))
            for transcript in sessions_of(folder, mode, entries, without)
        ]
        if anonymous:
            sessions = anonymised(sessions)
        found[mode] = combined(tables_of((transcript for transcript, _ in sessions), forms.forms))
        for transcript, lines in sessions:
            files[f"{_raw(mode)}/{transcript.started.participant}/{JOURNAL}"] = lines
    _all_there(folder, modes, without, entries)
    if not any(tables.participants for tables in found.values()):
        raise _nothing_there(folder, modes)
    files |= _described(folder, settings, forms, found, _Handling(tuple(without), anonymous))
    _check_target(folder, out, files)
    unblinded = "live" in found and ledger.unblind("ana study export")
    dropped = tuple(
        mode for mode in STUDY_MODES if mode not in found and (out / _raw(mode)).is_dir()
    )
    _replace(out, files)
    return Exported(
        sessions={mode: len(tables.participants) for mode, tables in found.items()},
        rounds={mode: sum(row.counts for row in tables.rounds) for mode, tables in found.items()},
        unblinded=unblinded,
        dropped=dropped,
    )


def unblinds(folder: Path, modes: Collection[StudyMode]) -> bool:
    """Whether exporting these modes would unblind the study in `folder`. Raises LedgerError."""
    closed = is_closed(Ledger(folder / LEDGER).entries())
    return "live" in modes and not closed and bool(journals(folder, "live"))


def _raw(mode: StudyMode) -> str:
    """The folder of a mode's journals in a dataset."""
    return f"data/raw/{mode}"


def _nothing_there(folder: Path, modes: Sequence[StudyMode]) -> StudyError:
    """The error where there is not one session of these modes."""
    others = {mode: len(journals(folder, mode)) for mode in STUDY_MODES if mode not in modes}
    there = [
        f"{count} {mode} {'session' if count == 1 else 'sessions'}"
        for mode, count in others.items()
        if count
    ]
    give = " or ".join(f"--mode {mode}" for mode, count in others.items() if count)
    return StudyError(
        f"there are no {' or '.join(dict.fromkeys(modes))} sessions to export",
        place=str(folder),
        hint=f"It has {' and '.join(there)}: give {give}" if there else "",
    )


@dataclass(frozen=True)
class _Handling:
    """What was done to the sessions before they were written."""

    without: tuple[str, ...]
    anonymous: bool

    def told(self) -> str:
        """The sentences that say so; empty where nothing was done."""
        left = f" Left out on purpose: {', '.join(self.without)}." if self.without else ""
        if self.anonymous and self.without:
            left = f" Left out on purpose: {len(self.without)}."
        changed = (
            " Pseudonyms are not those of the study, each participant's dates are shifted by a "
            "random time, and answers in participants' own words are left out."
        )
        return left + (changed if self.anonymous else "")


def _all_there(
    folder: Path,
    modes: Sequence[StudyMode],
    without: Collection[str],
    entries: Sequence[LedgerEntry],
) -> None:
    """Raise StudyError unless each of `without` has a session or a place in one of the modes."""
    for name in without:
        if not any(
            (folder / SESSIONS / mode / name).is_dir() or slot_of(entries, name, mode)
            for mode in modes
        ):
            raise StudyError(
                f"there is no session of {name} to leave out",
                place=str(folder),
                hint="Give the name of its folder in sessions",
            )


def _lines_read(transcript: Transcript) -> bytes:
    """The lines of the journal that the transcript was read from; it may have grown since."""
    lines = read_file(Path(transcript.source)).splitlines(keepends=True)
    return b"".join(lines[: transcript.entries[-1].line])


def without_free_text(journal: bytes) -> bytes:
    """The journal with every free-text answer emptied; an unfinished line that may hold such an
    answer is left out."""
    return b"".join(_without_answer(line) for line in journal.splitlines(keepends=True))


def _without_answer(line: bytes) -> bytes:
    if b"free_text" not in line:
        return line
    try:
        fields = msgspec.json.decode(line)
    except msgspec.DecodeError:
        return b""
    if fields.get("type") != "free_text":
        return line
    return msgspec.json.encode(fields | {"answer": ""}) + b"\n"


def _described(
    folder: Path,
    settings: StudySettings,
    forms: ReadForms,
    found: dict[StudyMode, Tables],
    handling: _Handling,
) -> dict[str, bytes]:
    """All files except the raw journals, by path."""
    types = row_types(forms.forms)
    summary = _summary(_task(settings), found)
    texts = {
        _place(file_name(settings.name, mode, table), table): table_text(row, tables.table(table))
        for mode, tables in found.items()
        for table, row in types.items()
        if not (handling.anonymous and table == FREE_TEXT)
    }
    texts |= dict.fromkeys(IGNORE_FILES, IGNORED)
    texts["README.md"] = _readme(settings.name, summary, handling)
    texts["documentation/codebook.md"] = codebook_page(types)
    texts["documentation/codebook.csv"] = codebook_table(types)
    files = {path: text.encode() for path, text in texts.items()}
    rows: Sequence[type[TableRow]] = tuple(types.values())
    files[DESCRIPTION] = description(settings.name, summary + handling.told(), _notes(folder), rows)
    for material in (SETTINGS, TEXTS, forms.name):
        files[f"materials/{material}"] = (folder / material).read_bytes()
    if (folder / INSTRUCTIONS).exists():
        files[f"materials/{INSTRUCTIONS}"] = (folder / INSTRUCTIONS).read_bytes()
    return files | _versions(folder)


def _versions(folder: Path) -> dict[str, bytes]:
    """Every version of what sessions were made from. Raises StudyError where one cannot be read."""
    kept = folder / VERSIONS
    try:
        return {
            f"materials/{VERSIONS}/{version.name}": version.read_bytes()
            for version in sorted(kept.iterdir())
        }
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise StudyError(
            f"the study's earlier versions cannot be read ({error.strerror})",
            place=str(error.filename or kept),
            hint=disk_hint(error),
        ) from error


def _place(name: str, table: str) -> str:
    return f"data/{APART}/{name}" if table == FREE_TEXT else f"data/{name}"


_DONE = {
    "memorise": "memorised a map",
    "label": "labelled its rooms",
    "mission": "played a rescue mission",
}


def _task(settings: StudySettings) -> str:
    """What participants did, in a sentence or two."""
    if settings.instructors is None and settings.rounds == 2:
        return (
            "Participants memorised the maps of two buildings, labelled their rooms, and played a "
            "rescue mission in each: one with a static and one with an adaptive instructor."
        )
    first, second = settings.instructors or ("static", settings.coach)
    did = ", ".join(_DONE[phase] for phase in settings.round_phases if phase in _DONE)
    return (
        f"Rounds: {settings.rounds}. In each, participants {did}. The missions were led by one of "
        f"two instructors: {first} (`static` in the tables) or {second} (`adaptive`)."
    )


def _summary(task: str, found: dict[StudyMode, Tables]) -> str:
    counts = ", ".join(f"{len(tables.participants)} {mode}" for mode, tables in found.items())
    warning = " The simulated sessions were played by a program." if "simulated" in found else ""
    return f"{task} Sessions: {counts}.{warning}"


def _readme(name: str, summary: str, handling: _Handling) -> str:
    tables = "\n".join(
        f"- `{table}`: {(row.__doc__ or '').split('.')[0].strip()}."
        for table, row in ROW_TYPES.items()
    )
    return f"""# {name}

{summary}{handling.told()} A Psych-DS dataset, written by ana {__version__}.

- `data/`: tidy tables, one file per table and mode (`session-live`, `-pilot`, `-simulated`).
- `data/{APART}/`: what participants wrote in their own words, which may identify them. Check it,
  or delete the folder, before you share the dataset; the dataset stays valid without it.
- `data/raw/`: the journals that everything here was made from. Answers in participants' own words
  are emptied; every other complete line is unchanged. The journals contain the time of day.
- `documentation/`: the codebook, as text and as a table.
- `materials/`: the study's settings, and every text, question and instruction as participants saw
  it. In `materials/{VERSIONS}/` every version of them, and every building; the numbers in the names
  begin their SHA-256.

{tables}
"""


def _notes(folder: Path) -> DatasetNotes:
    path = folder / DATASET
    if not path.exists():
        return DatasetNotes()
    try:
        return msgspec.convert(tomllib.loads(path.read_text(encoding="utf-8-sig")), DatasetNotes)
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError, msgspec.ValidationError) as error:
        fields = ", ".join(DatasetNotes.__struct_fields__)
        raise StudyError(
            f"the notes on the dataset are not valid: {in_plain_words(*parted(str(error))[:1])}",
            place=str(path),
            hint=f"The file can set {fields}",
        ) from error


def _check_target(folder: Path, out: Path, files: dict[str, bytes]) -> None:
    """Raise StudyError unless `out` is free or holds an earlier export and nothing else."""
    if folder.resolve().is_relative_to(out.resolve()):
        raise StudyError("this folder contains the study itself", place=str(out), hint=_CHOOSE)
    if not out.exists():
        return
    if not out.is_dir():
        raise StudyError("this is a file, not a folder", place=str(out), hint=_CHOOSE)
    for path in _files(out):
        known = path.as_posix()
        if (known not in files and path.parts[0] != "data") or not (out / DESCRIPTION).exists():
            raise StudyError(
                f"the folder contains {path}, which is not part of an earlier export",
                place=str(out),
                hint=_CHOOSE,
            )


_CHOOSE = "Choose a new folder"


def _files(root: Path) -> Iterator[Path]:
    return (path.relative_to(root) for path in sorted(root.rglob("*")) if path.is_file())


def _replace(out: Path, files: dict[str, bytes]) -> None:
    """Put all files into `out`, or none."""
    fresh, old = (out.with_name(f".{out.name}.{part}") for part in ("new", "old"))
    try:
        for leftover in (fresh, old):
            shutil.rmtree(leftover, ignore_errors=True)
        for path, data in sorted(files.items()):
            _write(fresh / path, data)
        if out.exists():
            out.rename(old)
        fresh.rename(out)
    except OSError as error:
        raise StudyError(
            f"the dataset cannot be written ({error.strerror})",
            place=str(out),
            hint="Free some space, or choose a folder that you can write to",
        ) from error
    shutil.rmtree(old, ignore_errors=True)


def _write(path: Path, data: bytes) -> None:
    make_folders(path.parent)
    descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(descriptor, "wb") as file:
        file.write(data)
