"""`ana analyse`: every statistic of the paper, and of a reviewer's questions, for one source."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Protocol

import click

from analysis.stats.level import ALPHA
from game.errors import AnaError
from game.journal.records import STUDY_MODES, StudyMode


class StudySide(Protocol):
    """What the command is given by the game."""

    def refuse_unlike_ledger(self, folder: Path, mode: StudyMode) -> None:
        """Raise JournalError where the sessions of a study folder are not those of its ledger."""
        ...

    def unblind(self, folder: Path) -> str:
        """Record in a study folder, unless the study is closed, that its allocation was looked at;
        return what to tell of that."""
        ...


_PATH = click.Path(path_type=Path)


@click.command(name="analyse")
@click.pass_obj
@click.argument("source", type=_PATH)
@click.option("--json", "out", type=_PATH, metavar="OUT.json", help="Write all numbers there.")
@click.option("--report", type=_PATH, metavar="DIR",
              help="Write a results section in the paper's order into DIR.")  # fmt: skip
@click.option("--prereg", type=_PATH, metavar="FILE",
              help="Write the planned analysis of a study to FILE (.md, .docx).")  # fmt: skip
@click.option("--figures", type=_PATH, metavar="DIR", help="Draw the figures into DIR.")
@click.option("--quiz", type=_PATH, metavar="FILE", help="The quiz scores of a CSV source.")
@click.option("--columns", type=_PATH, metavar="FILE.toml",
              help="What is what in a table of another study.")  # fmt: skip
@click.option("--mode", type=click.Choice(STUDY_MODES),
              help="Which sessions of a study folder, where there are several kinds.")  # fmt: skip
@click.option("--alpha", type=click.FloatRange(0, 0.5, min_open=True, max_open=True),
              default=ALPHA, show_default=True,
              help="Tests are judged at it, and intervals are made for it.")  # fmt: skip
@click.option("--bayes", is_flag=True,
              help="Bayesian mixed models too (minutes; needs the extra bayes).")  # fmt: skip
@click.option("--verify/--no-verify", "check", default=True, show_default=True,
              help="Play every mission again first; it must come out as recorded.")  # fmt: skip
def command(
    game: StudySide,
    source: Path,
    out: Path | None,
    report: Path | None,
    prereg: Path | None,
    figures: Path | None,
    quiz: Path | None,
    columns: Path | None,
    mode: StudyMode | None,
    alpha: float,
    bayes: bool,
    check: bool,
) -> int:
    """Analyse SOURCE: write all numbers to OUT.json, or a report into DIR.

    SOURCE is a study folder, the tables of one, or one table (CSV, .xlsx, .parquet). Exit status 2
    where a planned analysis could not be made; all others are written all the same. The ledger of
    a live study that is open records that it was analysed, which unblinds.

    A report is `results.html` with every number and figure of the paper's sections 5.3 to 5.5, ours
    beside the printed, `tables/` (CSV, LaTeX, docx) and `figures/` (SVG, PDF, PNG).
    """
    from analysis.battery import analyse_source, preregister
    from analysis.sources.source import holds_live_sessions, is_study_source
    from analysis.sources.study_folder import mode_of

    if not source.exists():
        raise AnaError(
            "there is nothing there",
            place=str(source),
            hint="Give a study folder, a dataset that `ana study export` has made, or a table",
        )
    if prereg is not None:
        if out or report or figures:
            raise click.UsageError("--prereg reads no data: give it without --json or --report.")
        with _writing(prereg):
            preregister(source, prereg, alpha)
        click.echo(f"The planned analysis stands in {prereg}")
        return 0
    if out is None and report is None:
        raise click.UsageError("Say what to write: --json OUT.json, --report DIR, or both.")

    if is_study_source(source):
        game.refuse_unlike_ledger(source, mode_of(source, mode))

    def loaded() -> None:
        if holds_live_sessions(source, mode):
            click.echo(game.unblind(source), err=True, nl=False)

    with _writing(out or report):
        result = analyse_source(
            source,
            quiz,
            figures,
            mode,
            columns=columns,
            report=report,
            check=check,
            tick=_tell,
            loaded=loaded,
            alpha=alpha,
            bayes=bayes,
        )
        if out is not None:
            out.write_text(result.to_json(), encoding="utf-8")
    click.echo(result.table())
    if report is not None:
        click.echo(f"Open {report / 'results.html'}")
    return result.exit_status


@contextmanager
def _writing(place: Path | None) -> Iterator[None]:
    """Raise AnaError for what cannot be written."""
    try:
        yield
    except OSError as error:
        raise AnaError(
            f"the results cannot be written ({error.strerror})",
            place=str(error.filename or place),
            hint="Give a file or folder in a folder that exists and that you may write to.",
        ) from error


def _tell(done: int, of: int) -> None:
    """Count the journals on a terminal's error stream."""
    if sys.stderr.isatty():
        click.echo(f"\r{done} of {of} journals read", err=True, nl=done == of)
