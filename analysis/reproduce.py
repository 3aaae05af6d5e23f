"""`make reproduce`: from nothing to journals, tables, numbers, executed notebooks and a report.

`data/simulated/` holds what `tables/` then holds; its README names the command.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import redirect_stdout
from html import escape
from os import cpu_count
from pathlib import Path
from time import monotonic
from typing import TypeAlias

import click
import pandas as pd

from analysis.battery import run_battery, signed
from analysis.execute import executed, html, notebooks, title, write
from analysis.pages.figures import write_figures
from analysis.pages.preset_studies import POPULATIONS, PRESETS, Key, missions_of, write_missions
from analysis.pages.style import SIMULATED
from analysis.sources.recorded import Recorded
from analysis.sources.study_folder import read_study_folder
from analysis.sources.tables_folder import write_tables
from game.cli import main as ana
from game.tables.exclusions import read_rules

PARTICIPANTS = 108
#: Two blocks of the design, for each preset and kind of people.
PARTICIPANTS_EACH = 48
SEED = 2024
#: Some of whom leave early.
PEOPLE = "as-they-come"
MADE = ("study", "presets", "tables", "figures", "notebooks", "report")
#: The notebook about the studies that are simulated meanwhile.
COMPARING = "09_behaviour"

Say: TypeAlias = Callable[[str], None]
Others: TypeAlias = Mapping[Key, Future[pd.DataFrame]]


@click.command()
@click.argument("out", type=click.Path(path_type=Path), default=Path("out"))
@click.option("--participants", type=click.IntRange(1), default=PARTICIPANTS, show_default=True)
@click.option("--each", type=click.IntRange(0), default=PARTICIPANTS_EACH, show_default=True,
              help="Participants for each preset and kind of people; 0: none.")  # fmt: skip
@click.option("--seed", type=click.IntRange(0), default=SEED, show_default=True)
def reproduce(out: Path, participants: int, each: int, seed: int) -> None:
    """Simulate a study, analyse it and write the report, all into OUT, which is replaced."""
    began = monotonic()

    def say(words: str) -> None:
        click.echo(f"[{monotonic() - began:4.0f} s] {words}")

    for name in MADE:
        shutil.rmtree(out / name, ignore_errors=True)
    keys = [(preset, people) for preset in PRESETS for people in POPULATIONS] if each else []
    say(f"A study of {participants} simulated people")
    _simulate(out / "study", participants, seed, PEOPLE)
    pool = ProcessPoolExecutor(cpu_count())
    try:
        if keys:
            say(f"Meanwhile {len(PRESETS)} presets, each with {' and '.join(POPULATIONS)} people")
        others = {key: pool.submit(_other, out / "presets", each, seed, key) for key in keys}
        _analyse(out, others, say)
    finally:
        pool.shutdown(cancel_futures=True)


def _analyse(out: Path, others: Others, say: Say) -> None:
    """Make everything of the study in OUT; `others` are the missions of the other studies."""
    say("Playing every mission again from its actions, and reading the journals")
    recorded = _read(out / "study")
    for path in write_tables(recorded, out / "tables"):
        say(str(path))
    say("Every statistic")
    result = run_battery(recorded.study(), read_rules())
    made = signed(result, out / "study", None, "simulated", verified=True)
    (out / "results.json").write_text(result.to_json(), encoding="utf-8")
    write_figures(result.study, out / "figures", origin=made.line())
    say("The notebooks")
    (out / "report").mkdir(parents=True, exist_ok=True)
    pages = []
    for path, notebook in executed(_in_turn(out / "tables", others), out / "tables"):
        write(notebook, out / "notebooks" / path.name)
        page = out / "report" / f"{path.stem}.html"
        page.write_text(html(notebook), encoding="utf-8")
        pages.append((page.name, title(notebook)))
        say(str(page))
    index = out / "report" / "index.html"
    index.write_text(_index(sorted(pages)), encoding="utf-8")
    say(f"Open {index}")


def _in_turn(tables: Path, others: Others) -> Iterator[Path]:
    """The notebooks; the one about the other studies comes last, when these are in `tables`."""
    paths = {path.stem: path for path in notebooks()}
    last = paths.pop(COMPARING)
    yield from paths.values()
    if others:
        write_missions({key: missions.result() for key, missions in others.items()}, tables)
    yield last


def _simulate(folder: Path, participants: int, seed: int, people: str, *more: str) -> None:
    """`ana simulate`, in this process; its failure, which it has told, ends the whole."""
    sizes = ("--participants", str(participants), "--seed", str(seed))
    if status := ana(["simulate", str(folder), *sizes, "--population", people, *more]):
        raise SystemExit(status)


def _read(folder: Path) -> Recorded:
    with click.progressbar(length=1, label="Verifying", show_pos=True) as bar:

        def tick(done: int, of: int) -> None:
            bar.length = of
            bar.update(done - bar.pos)

        return read_study_folder(folder, "simulated", tick=tick)


def _other(folder: Path, participants: int, seed: int, key: Key) -> pd.DataFrame:
    """The missions of the study of one preset and kind of people, made by this process alone."""
    preset, people = key
    study = folder / f"{preset}-{people}"
    with redirect_stdout(None):
        _simulate(study, participants, seed, people, "--preset", preset, "--jobs", "1")
    return missions_of(
        read_study_folder(
            study, "simulated", check=False, jobs=1, wanted=("participants", "rounds")
        )
    )


def _index(pages: list[tuple[str, str]]) -> str:
    items = "".join(f'<li><a href="{name}">{escape(title)}</a></li>\n' for name, title in pages)
    return (
        "<!doctype html>\n<html lang=en><meta charset=utf-8><title>ana: the report</title>\n"
        "<body style='font-family:sans-serif;max-width:40em;margin:3em auto;line-height:1.6'>\n"
        f"<h1>The report</h1>\n<p>{SIMULATED.capitalize()}: evidence about the software and the "
        f"design's power, never about people.</p>\n<ol>\n{items}</ol>\n"
    )


if __name__ == "__main__":
    reproduce()
