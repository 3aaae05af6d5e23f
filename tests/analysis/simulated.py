"""Small simulated studies for the tests."""

from pathlib import Path

from game.rescuers.person import POPULATIONS
from game.simulation.simulated_study import simulate
from game.simulation.workers import here
from game.study.folder import new_study

SHIPPED = Path(__file__).resolve().parents[2] / "data" / "simulated"
SEED = 2024
BLOCKS = 5


def first_of_the_shipped(folder: Path, participants: int, population: str = "as-they-come") -> None:
    """The first participants of the shipped study, simulated again; or others in their place."""
    new_study(folder, SEED, BLOCKS)
    for _ in simulate(folder, participants, SEED, POPULATIONS[population], here):
        pass
