"""Reads the journals of a study folder, through `game.session` alone."""

from collections.abc import Callable, Collection, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from math import ceil
from os import cpu_count
from pathlib import Path

from analysis.sources.absent import SourceError
from analysis.sources.designs import crossed_in
from analysis.sources.recorded import ANALYSED, Recorded, recorded, typed
from game.forms.form import Forms
from game.forms.reading import BLANK, FORMS, ITEMS, paper_forms, read_forms
from game.journal.folders import SESSIONS, journals, misplaced
from game.journal.reader import read_journal
from game.journal.records import STUDY_MODES, StudyMode
from game.session.verification import verify_transcript
from game.tables.columns import cells
from game.tables.session_tables import tables_of

#: From so many journals on they are read by several processes.
MANY = 4
#: So many journals at most are handed to a process at a time; their buildings are parsed once.
HANDFUL = 9
#: So many journals that do not verify are named.
NAMED = 3

Tick = Callable[[int, int], object]
"""Told after each journal how many have been read, and of how many."""


@dataclass(frozen=True)
class _Read:
    """One journal as a worker hands it back."""

    path: Path
    cells: dict[str, list[list[str]]]
    schema: int
    difference: str


def read_study_folder(
    folder: Path,
    mode: StudyMode | None = None,
    *,
    check: bool = True,
    tick: Tick = lambda _done, _all: None,
    jobs: int | None = None,
    wanted: Collection[str] = ANALYSED,
) -> Recorded:
    """The sessions of one mode in a study folder; without `mode`, of the only one there is.

    With `check` every mission is played again from its actions and must come out as recorded. They
    are read by `jobs` processes, one a core if not said. Frames that are not `wanted` are empty.
    Raises SourceError or JournalError, naming the place and a hint.
    """
    mode = mode_of(folder, mode)
    paths = journals(folder, mode)
    if not paths:
        raise SourceError(
            "there are no sessions in it",
            place=str(folder / SESSIONS / mode),
            hint=f"Take those that there are: {_there_are(folder)}",
        )
    forms = forms_of(folder)
    read = _read_all(paths, partial(_read, folder, mode, check, forms, wanted), tick, jobs)
    _refuse_changed(read)
    frames = {
        name: typed(name, [row for one in read for row in one.cells[name]], forms)
        for name in ANALYSED
    }
    schemas = sorted({one.schema for one in read})
    notes = [] if len(schemas) == 1 else [_mixed(schemas)]
    if mode == "pilot":
        notes.append("these are pilot sessions, no data of the study")
    return recorded(frames, folder.resolve().name, notes, forms, crossed_in(folder))


def forms_of(folder: Path) -> Forms:
    """What is asked in a study folder, or was in a dataset's folder of materials; the paper's forms
    where it has no file of them. Raises FormsError for a file that cannot be used."""
    if any((folder / name).is_file() for name in (FORMS, ITEMS)):
        return read_forms(folder, BLANK).forms
    return paper_forms()


def is_study_folder(folder: Path) -> bool:
    """Whether there is a folder of sessions, or a study that has had none yet."""
    return (folder / SESSIONS).is_dir() or (folder / "study.toml").is_file()


def mode_of(folder: Path, mode: StudyMode | None) -> StudyMode:
    """The mode to read: the one asked for, else that of the live sessions, or of the simulated
    ones where they are alone. Raises SourceError where that is not clear."""
    return mode or _only_mode(folder)


def _only_mode(folder: Path) -> StudyMode:
    found: list[StudyMode] = [mode for mode in STUDY_MODES if journals(folder, mode)]
    real = [mode for mode in found if mode != "simulated"]
    if "simulated" in found and real:
        raise SourceError(
            f"it holds {' and '.join(real)} sessions, and simulated ones; they are analysed apart",
            place=str(folder),
            hint=f"Say which: {_options(found)}",
        )
    if found == ["pilot"]:
        raise SourceError(
            "it holds pilot sessions alone, which are no data",
            place=str(folder),
            hint="To try the analysis on them all the same: --mode pilot",
        )
    if not found:
        raise SourceError(
            "there are no sessions in it",
            place=str(folder),
            hint="`ana study run` lets participants in, `ana simulate` simulates some",
        )
    return found[0]


def _there_are(folder: Path) -> str:
    return _options([mode for mode in STUDY_MODES if journals(folder, mode)]) or "none"


def _options(modes: Sequence[StudyMode]) -> str:
    return " or ".join(f"--mode {mode}" for mode in modes)


def _read_all(
    paths: Sequence[Path],
    read_some: Callable[[Sequence[Path]], list[_Read]],
    tick: Tick,
    jobs: int | None,
) -> list[_Read]:
    cores = jobs or cpu_count() or 1
    size = min(HANDFUL, ceil(len(paths) / cores))
    handfuls = [paths[at : at + size] for at in range(0, len(paths), size)]
    if cores == 1 or len(paths) < MANY:
        return _told_of(map(read_some, handfuls), tick, len(paths))
    with ProcessPoolExecutor(min(len(handfuls), cores)) as pool:
        return _told_of(pool.map(read_some, handfuls), tick, len(paths))


def _told_of(parts: Iterable[list[_Read]], tick: Tick, of: int) -> list[_Read]:
    read: list[_Read] = []
    for part in parts:
        read += part
        tick(len(read), of)
    return read


def _read(
    folder: Path,
    mode: StudyMode,
    check: bool,
    forms: Forms,
    wanted: Collection[str],
    paths: Sequence[Path],
) -> list[_Read]:
    transcripts = []
    for path in paths:
        transcript = read_journal(path)
        wrong = misplaced(transcript.started, folder, mode, path.parent.name)
        if wrong:
            raise SourceError(wrong, place=str(path), hint="Put it back where it was recorded")
        transcripts.append(transcript)
    read = []
    for path, transcript, tables in zip(
        paths, transcripts, tables_of(transcripts, forms, wanted), strict=True
    ):
        difference = verify_transcript(transcript).difference if check else None
        told = "" if difference is None else str(difference)
        found = {name: [list(cells(row)) for row in tables.table(name)] for name in ANALYSED}
        read.append(_Read(path, found, transcript.started.versions.schema, told))
    return read


def _refuse_changed(read: Sequence[_Read]) -> None:
    changed = [one for one in read if one.difference]
    if changed:
        told = "; ".join(f"{one.path}: {one.difference}" for one in changed[:NAMED])
        more = f"; and {len(changed) - NAMED} more" if len(changed) > NAMED else ""
        raise SourceError(
            f"{len(changed)} of {len(read)} journals do not verify: {told}{more}",
            hint="Restore the originals, or analyse them as they are with --no-verify",
        )


def _mixed(schemas: Sequence[int]) -> str:
    return (
        f"the journals were written under schemas {', '.join(map(str, schemas))}; the older ones "
        "were read as the newest"
    )
