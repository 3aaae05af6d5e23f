"""The pins, the wheel and the set-up say one and the same thing."""

import re
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

from game import __version__

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
TIERS = ("play", "web", "all")


def pins(tier: str) -> set[str]:
    """Every `name==version ; marker` of a tier."""
    text = (ROOT / "requirements" / f"{tier}.txt").read_text()
    return {line.removesuffix("\\").strip() for line in text.splitlines() if line[:1].isalnum()}


def names(requirements: list[str]) -> set[str]:
    found = (re.match(r"[\w-]+", requirement) for requirement in requirements)
    return {match[0] for match in found if match}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> zipfile.ZipFile:
    folder = tmp_path_factory.mktemp("wheel")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    [path] = folder.glob("*.whl")
    assert path.name == f"ana-{__version__}-py3-none-any.whl"
    return zipfile.ZipFile(path)


@pytest.mark.parametrize("tier", TIERS)
def test_pins_name_no_place_to_fetch_from(tier: str) -> None:
    lines = (ROOT / "requirements" / f"{tier}.txt").read_text().splitlines()
    assert lines
    for line in lines:
        assert re.fullmatch(
            r"[a-z0-9-]+==[\w.]+( ;.*)? \\|    --hash=sha256:[0-9a-f]{64}( \\)?", line
        )


def test_play_is_part_of_all_so_that_none_undoes_another() -> None:
    assert pins("play") < pins("web") < pins("all")


def test_the_game_tier_is_small_and_whole() -> None:
    pinned = {pin.partition("==")[0] for pin in pins("play")}
    assert names(PROJECT["project"]["dependencies"]) <= pinned
    assert "hatchling" in pinned
    assert not pinned & names(PROJECT["project"]["optional-dependencies"]["analysis"])


def test_the_tier_for_browsers_is_the_game_and_what_it_is_served_with() -> None:
    pinned = {pin.partition("==")[0] for pin in pins("web")}
    assert names(PROJECT["project"]["optional-dependencies"]["web"]) <= pinned


def test_the_build_backend_is_the_pinned_one() -> None:
    [backend] = PROJECT["build-system"]["requires"]
    assert PROJECT["dependency-groups"]["build"] == [backend]
    assert backend in pins("play")


def test_dev_means_everything_but_what_needs_older_libraries() -> None:
    extras = dict(PROJECT["project"]["optional-dependencies"])
    assert names(extras.pop("bayes")) <= {"ana", "bambi", "matplotlib"}
    everything = f"ana[{','.join(sorted(set(extras) - {'dev'}))}]"
    assert everything in extras["dev"]
    pinned = {pin.partition("==")[0] for pin in pins("all")}
    wanted = {name for extra in extras.values() for name in names(extra)} - {"ana"}
    assert wanted <= pinned


def test_the_wheel_holds_both_packages_and_their_texts(wheel: zipfile.ZipFile) -> None:
    held = {name for name in wheel.namelist() if ".dist-info/" not in name}
    shipped = {
        path.relative_to(ROOT).as_posix()
        for package in ("game", "analysis")
        for path in (ROOT / package).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    assert held == shipped


def test_the_wheel_gives_the_command(wheel: zipfile.ZipFile) -> None:
    scripts = wheel.read(f"ana-{__version__}.dist-info/entry_points.txt").decode()
    assert scripts.split("\n")[:2] == ["[console_scripts]", "ana = game.cli:main"]


def test_the_version_is_written_once() -> None:
    assert PROJECT["project"]["dynamic"] == ["version"]
    assert PROJECT["tool"]["hatch"]["version"] == {"path": "game/__init__.py"}


@pytest.mark.parametrize("file", ["Makefile", ".ci/run", "pyproject.toml", "requirements/all.txt"])
def test_set_up_names_no_address(file: str) -> None:
    assert "://" not in (ROOT / file).read_text()


def test_the_make_targets_are_listed() -> None:
    text = (ROOT / "Makefile").read_text()
    [phony] = re.findall(r"^\.PHONY: (.*)$", text, re.MULTILINE)
    assert set(re.findall(r"^([a-z]+):.*## ", text, re.MULTILINE)) == set(phony.split())


@pytest.mark.parametrize(
    ("script", "told"),
    [
        ("[ $1 = -V ] && echo Python 3.9.2; exit 1", "3.11 or newer; '{}' is Python 3.9.2"),
        ("case $2 in *version_info*) exit 0;; *) exit 1;; esac", "apt install python3-venv"),
        (None, "there is no '{}' here"),
    ],
    ids=["old", "without venv", "missing"],
)
def test_a_python_that_will_not_do_is_told_so(
    script: str | None, told: str, tmp_path: Path
) -> None:
    python = tmp_path / "some-python"
    if script is not None:
        python.write_text(f"#!/bin/sh\n{script}\n")
        python.chmod(0o755)
    run = subprocess.run(
        ["make", "-f", ROOT / "Makefile", f"PYTHON={python}", ".venv/pyvenv.cfg"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    assert run.returncode == 2
    assert told.format(python) in run.stderr
    assert not (tmp_path / ".venv").exists()
