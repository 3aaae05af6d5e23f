"""Finding a building: a shipped one by its name, one made from a seed, or a file by its path."""

from __future__ import annotations

from functools import cache
from os import PathLike, fspath
from pathlib import Path

from game.errors import AnaError, choose_from
from game.world.building import Building
from game.world.reading import decode, parse_building

_SHELF = Path(__file__).with_name("buildings")
_SUFFIX = ".txt"
_CSV = ".csv"
GENERATED = "generated"
"""`generated:SEED` names the office made from that seed."""
_LARGEST_SEED = 10**18
_OR_ANOTHER = f", {GENERATED}:SEED, or give the path of a building file"
_LEGENDS = (".legend.txt", ".legend")


@cache
def shipped_buildings() -> tuple[str, ...]:
    """The names of the buildings that come with the game, in alphabetical order."""
    return tuple(sorted(path.stem for path in _SHELF.glob("*" + _SUFFIX)))


def load_building(name_or_path: str | PathLike[str], seed: int = 0) -> Building:
    """The shipped building of that name, the one made from the seed of `generated:SEED`, or the one
    in that file.

    A file ending in `.csv` is read as a grid; without a legend, `seed` decides what is where.
    Raises BuildingError for a bad file and AnaError if there is no such name or file.
    """
    name = fspath(name_or_path)
    if name in shipped_buildings():
        return parse_building(read_text(_SHELF / (name + _SUFFIX)), name)
    kind, _, text = name.partition(":")
    if kind == GENERATED:
        from game.world.generation.office import generated

        return generated(_seed(text, name))
    path = Path(name)
    if not (path.suffix or path.is_file() or "/" in name):
        raise AnaError(
            f"there is no building '{name}'",
            hint=choose_from(name, shipped_buildings(), _OR_ANOTHER),
        )
    if path.suffix.lower() == _CSV:
        return _load_grid(path, seed)
    return parse_building(read_text(path), name)


def _seed(text: str, name: str) -> int:
    if not (text.isascii() and text.isdigit() and int(text) < _LARGEST_SEED):
        raise AnaError(
            "the seed must be a whole number from 0, of at most 18 digits",
            place=name,
            hint=f"Write it after the colon, as in {GENERATED}:7",
        )
    return int(text)


def _load_grid(path: Path, seed: int) -> Building:
    from game.world.csv_import import import_grid

    beside = (path.with_name(path.stem + suffix) for suffix in _LEGENDS)
    legend = next((candidate for candidate in beside if candidate.is_file()), None)
    return import_grid(
        read_text(path),
        str(path),
        name=path.stem,
        legend=read_text(legend) if legend else None,
        legend_source=str(legend),
        seed=seed,
    )


def read_text(path: Path) -> str:
    """The text of a file. Raises AnaError if it cannot be read, BuildingError if it is not text."""
    try:
        return decode(path.read_bytes(), str(path))
    except OSError as error:
        raise AnaError(
            f"the file cannot be read ({error.strerror})",
            place=str(path),
            hint="Give the path of a building file, or one of "
            + ", ".join((*shipped_buildings(), f"{GENERATED}:SEED")),
        ) from None
