"""`make bench`: how fast it is, beside the floors measured in the same run.

Nothing here passes or fails: machines differ, and ratios are what can be compared.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import click

from tests.bench.coach import coach_costs, coached_keys, mission_s, office_ms, route_p99_ms
from tests.bench.screen import COLUMNS, ROWS, KeyCosts, first_paints_ms, key_costs
from tests.bench.simulation import missions_a_second, simulation_rates
from tests.bench.ssh import at_once
from tests.bench.statistics import analyse_s, analyse_shipped_s, r_s
from tests.bench.together import PARTICIPANTS
from tests.bench.web import in_browsers
from tests.study.server import SSH, SSHD

BUILDINGS = ("harbour", "foundry")
FLOOR = (sys.executable, "-m", "tests.bench.floor")
WALK = ["right"] * 8 + ["left"] * 16 + ["right"] * 8
CLOCK_ROWS = (4, 5, 7)
SEED, KEYS, KEYS_A_SECOND = 1, 150, 10
SWIFT = ("moves_per_second=20", "treat_red_ms=0", "treat_blue_ms=0")


@dataclass(frozen=True)
class Figure:
    """One measured figure, what it is held against, and the most it should be."""

    name: str
    measured: float
    unit: str
    most: float | None = None
    floor: float | None = None

    @property
    def ratio(self) -> float | None:
        return None if self.floor is None else self.measured / self.floor

    @property
    def kept(self) -> bool | None:
        """Whether the figure, or its ratio where there is a floor, is within its bound."""
        if self.most is None:
            return None
        return (self.measured if self.ratio is None else self.ratio) <= self.most


def game(*options: str) -> list[str]:
    return [
        sys.executable,
        "-m",
        "game",
        "play",
        "--now",
        "--seed",
        "1",
        "--log",
        tempfile.mkdtemp(),
        *options,
    ]


def keys() -> Iterator[Figure]:
    """A key over a pseudo-terminal of 120 x 40, 10 a second at pace 20, coach and journal on: once
    as the coach says, with treatments that take no time, and once back and forth against it."""
    floor: KeyCosts = key_costs(FLOOR, WALK)
    coached = coached_keys(SEED, KEYS, 1000 // KEYS_A_SECOND, SWIFT)
    options = [part for setting in SWIFT for part in ("--set", setting)]
    for way, pressed in (("as coached", coached), ("against it", WALK)):
        ours: KeyCosts = key_costs(
            game(*options), pressed, count=KEYS, per_second=KEYS_A_SECOND, ignored_rows=CLOCK_ROWS
        )
        yield Figure(f"{way}: keys answered", ours.answered, f"of {ours.pressed}")
        yield Figure(f"{way}: key to painted, p50", ours.p50_ms, "ms", 3, floor.p50_ms)
        yield Figure(f"{way}: key to painted, p95", ours.p95_ms, "ms", 5, floor.p95_ms)
        yield Figure(f"{way}: bytes a move", ours.bytes_a_key, "B", 2500)
        yield Figure(f"{way}: CPU a move", ours.cpu_ms_a_key, "ms", 6)


def opening() -> Iterator[Figure]:
    """From the command to the first paint."""
    ours, floor = first_paints_ms(game(), FLOOR)
    yield Figure("first paint", ours, "ms", 1.6, floor)


def coaching() -> Iterator[Figure]:
    """Inside the process: the coach's answers, and whole missions on a virtual clock."""
    costs = coach_costs(BUILDINGS, range(5))
    yield Figure("coach step, p99", costs.step_p99, "ms", 2)
    yield Figure("route planned anew, p99", route_p99_ms(BUILDINGS, seed=1), "ms", 5)
    yield Figure("coach step with a new route, p99", costs.plan_p99, "ms")
    for who in ("stranger", "person"):
        costs = coach_costs(BUILDINGS, range(5), "knowledge", who)
        yield Figure(f"knowledge with a {who}: step, p99", costs.step_p99, "ms", 2)
        yield Figure("its choice at a goal and the route, p99", costs.plan_p99, "ms", 25)
    for name in BUILDINGS:
        mission_s(name)
        yield Figure(f"headless mission, {name}", mission_s(name), "s", 0.3)


def generating() -> Iterator[Figure]:
    """Offices made from a seed."""
    spent = sorted(map(office_ms, range(60)))
    yield Figure("office from a seed, p50", spent[len(spent) // 2], "ms", 150)
    yield Figure("office from a seed, slowest of 60", spent[-1], "ms", 300)


def simulating() -> Iterator[Figure]:
    """Whole study sessions of simulated people on one core, journals written."""
    rates = simulation_rates()
    yield Figure("simulated sessions", rates.sessions_per_s, "/s")
    yield Figure("their missions, practice too", rates.missions_per_s, "/s")
    yield Figure("mission time to processor time", rates.sped, "")
    for coach in ("static", "ana", "knowledge"):
        rate = missions_a_second(coach)
        yield Figure(f"four-minute missions a core, {coach}", rate, "/s")


def statistics() -> Iterator[Figure]:
    """`ana analyse` from the command to the numbers, beside R's packages for the same tests; the
    processor's seconds, cold."""
    yield Figure("analyse, the shipped study", analyse_shipped_s(), "s", 3.5)
    theirs = r_s()
    if theirs is None:
        click.echo("statistics: R or one of the packages of `make reference` is not installed")
    yield Figure("analyse, 100 people; floor: R", analyse_s(), "s", theirs and 0.5, theirs)


def ssh() -> Iterator[Figure]:
    """Participants at once in the mission of a study, 8 keys a second each at pace 20, over a real
    OpenSSH server on the loopback."""
    if SSHD is None or SSH is None:
        click.echo("ssh: left out, since OpenSSH's server or client is not installed")
        return
    floor = at_once(("cd", str(Path.cwd()), "&&", "exec", *FLOOR), WALK)
    ours = at_once(None, WALK, ignored_rows=CLOCK_ROWS)
    yield Figure(f"{PARTICIPANTS} over ssh, keys answered", ours.answered, f"of {ours.pressed}")
    yield Figure("key to painted, p50", ours.p50_ms, "ms", floor=floor.p50_ms)
    yield Figure("key to painted, p95", ours.p95_ms, "ms", 5, floor.p95_ms)
    yield Figure("the same in milliseconds", ours.p95_ms, "ms", 20)
    yield Figure("memory a participant, PSS", ours.pss_mb, "MB", 40)


def web() -> Iterator[Figure]:
    """Participants at once in the mission of a study, 8 keys a second each at pace 20, over the
    websockets of `ana study serve`; the floor is the same on bare terminals."""
    bare, ours = in_browsers(WALK, ignored_rows=CLOCK_ROWS)
    yield Figure(f"{PARTICIPANTS} in browsers, keys answered", ours.answered, f"of {ours.pressed}")
    yield Figure("key to painted, p50", ours.p50_ms, "ms", floor=bare.p50_ms)
    yield Figure("key to painted, p95", ours.p95_ms, "ms", 1.5, bare.p95_ms)
    yield Figure("memory a participant, PSS", ours.pss_mb, "MB", 40)


PARTS: dict[str, Callable[[], Iterator[Figure]]] = {
    "keys": keys,
    "opening": opening,
    "coaching": coaching,
    "generating": generating,
    "simulating": simulating,
    "statistics": statistics,
    "ssh": ssh,
    "web": web,
}


@click.command()
@click.argument("parts", nargs=-1, type=click.Choice(list(PARTS)))
def bench(parts: tuple[str, ...]) -> None:
    """Measure PARTS, or everything."""
    click.echo(f"{'':34} {'measured':>10} {'':4} {'floor':>8} {'ratio':>6} {'most':>7}")
    for part in parts or PARTS:
        for figure in PARTS[part]():
            click.echo(_row(figure))
    click.echo(f"terminal {COLUMNS} x {ROWS}; floor: an empty Textual app that repaints one cell")


def _row(figure: Figure) -> str:
    floor = "" if figure.floor is None else f"{figure.floor:.1f}"
    ratio = "" if figure.ratio is None else f"{figure.ratio:.2f}"
    most = "" if figure.most is None else f"{figure.most:g}"
    verdict = {True: "kept", False: "MISSED", None: ""}[figure.kept]
    return (
        f"{figure.name:34} {figure.measured:10.2f} {figure.unit:6} {floor:>6} {ratio:>6} {most:>7}"
        f"  {verdict}"
    )


if __name__ == "__main__":
    bench()
