"""`make reproduce`: from nothing to journals, tables, numbers, executed notebooks and a report.

`data/simulated/` holds what `tables/` then holds; its README names the command.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Iterator
from html import escape
from pathlib import Path
from time import monotonic

import click

from analysis.battery import run_battery, signed
from analysis.execute import executed, html, notebooks, title, write
from analysis.pages.figures import write_figures
from analysis.pages.preset_studies import POPULATIONS, PRESETS, Key, missions_of, write_missions
from analysis.pages.style import SIMULATED
from analysis.sources.recorded import Recorded
from analysis.sources.study_folder import read_study_folder
from analysis.sources.tables_folder import write_tables
from game.tables.exclusions import read_rules

PARTICIPANTS = 108
#: Two blocks of the design, for each preset and kind of people.
PARTICIPANTS_EACH = 48
SEED = 2024
#: Some of whom leave early.
PEOPLE = "as-they-come"
BLOCK = 24
MADE = ("study", "presets", "tables", "figures", "notebooks", "report")
DEFAULT_PRESET = 'preset = "floodfill"'


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
    say(f"A study of {participants} simulated people")
    _simulate(out / "study", participants, seed, "--population", PEOPLE)
    say("Playing every mission again from its actions, and reading the journals")
    recorded = _read(out / "study")
    for path in write_tables(recorded, out / "tables"):
        say(str(path))
    if each:
        say(f"{len(PRESETS)} presets, each with {' and '.join(POPULATIONS)} people")
        table = missions_of(dict(_preset_studies(out / "presets", each, seed)))
        say(str(write_missions(table, out / "tables")))
    say("Every statistic")
    result = run_battery(recorded.study(), read_rules())
    made = signed(result, out / "study", None, "simulated", verified=True)
    (out / "results.json").write_text(result.to_json(), encoding="utf-8")
    write_figures(result.study, out / "figures", origin=made.line())
    say("The notebooks")
    (out / "report").mkdir(parents=True, exist_ok=True)
    pages = []
    for path, notebook in executed(notebooks(), out / "tables"):
        write(notebook, out / "notebooks" / path.name)
        page = out / "report" / f"{path.stem}.html"
        page.write_text(html(notebook), encoding="utf-8")
        pages.append((page.name, title(notebook)))
        say(str(page))
    index = out / "report" / "index.html"
    index.write_text(_index(pages), encoding="utf-8")
    say(f"Open {index}")


def _simulate(folder: Path, participants: int, seed: int, *more: str) -> None:
    count = ("--participants", str(participants))
    _ana("simulate", str(folder), *count, "--seed", str(seed), *more)


def _ana(*arguments: str, quiet: bool = False) -> None:
    """Run the command line; its failure, which it has told, ends the whole."""
    command = [sys.executable, "-m", "game", *arguments]
    out = subprocess.DEVNULL if quiet else None
    if status := subprocess.run(command, check=False, stdout=out).returncode:
        raise SystemExit(status)


def _read(folder: Path) -> Recorded:
    with click.progressbar(length=1, label="Verifying", show_pos=True) as bar:

        def tick(done: int, of: int) -> None:
            bar.length = of
            bar.update(1)

        return read_study_folder(folder, "simulated", tick=tick)


def _preset_studies(folder: Path, each: int, seed: int) -> Iterator[tuple[Key, Recorded]]:
    for preset in PRESETS:
        for people in POPULATIONS:
            study = folder / f"{preset}-{people}"
            blocks = str(-(-each // BLOCK))
            _ana("study", "new", str(study), "--seed", str(seed), "--blocks", blocks, quiet=True)
            _choose(study / "study.toml", preset)
            _simulate(study, each, seed, "--population", people)
            yield (preset, people), read_study_folder(study, "simulated", check=False)


def _choose(settings: Path, preset: str) -> None:
    text = settings.read_text(encoding="utf-8")
    if DEFAULT_PRESET not in text:
        raise ValueError(f"{settings}: no line {DEFAULT_PRESET}")
    settings.write_text(text.replace(DEFAULT_PRESET, f'preset = "{preset}"'), encoding="utf-8")


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
