"""Every number a mission is played by, in one place; the journal keeps a copy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from game.world.building import Severity

Controls = Literal["compass", "turn"]


@dataclass(frozen=True)
class MissionSettings:
    """The rules of one mission (paper 5.1.1; times in whole milliseconds).

    Raises ValueError, naming the setting, when one is out of its range.
    """

    duration_ms: int = 240_000
    red_expiry_ms: int | None = None
    """When red victims expire, counted from the start; None: at half time (`reds_expire_ms`)."""
    treat_red_ms: int = 6_000
    treat_blue_ms: int = 3_000
    sight_radius: int = 5
    moves_per_second: float = 5.0
    controls: Controls = "compass"
    points_red: int = 30
    points_blue: int = 10
    show_score: bool = True
    """False in a study, whose measure is the number rescued."""
    allow_pause: bool = True
    """False in a study."""
    level_key: bool = False
    """Whether the rescuer may ask the coach for simpler or shorter words."""

    def __post_init__(self) -> None:
        for name, low, high in RANGES:
            value = getattr(self, name)
            if value is not None and not low <= value <= high:
                raise ValueError(f"{name} must be between {low} and {high}, not {value}")
        if self.controls not in ("compass", "turn"):
            raise ValueError(f"controls must be compass or turn, not {self.controls}")

    @property
    def reds_expire_ms(self) -> int:
        """When red victims expire, counted from the start."""
        return self.duration_ms // 2 if self.red_expiry_ms is None else self.red_expiry_ms

    @property
    def pace_ms(self) -> int:
        """Least time between two moves."""
        return round(1000 / self.moves_per_second)

    def treatment_ms(self, severity: Severity) -> int:
        return self.treat_red_ms if severity is Severity.RED else self.treat_blue_ms

    def points(self, severity: Severity) -> int:
        return self.points_red if severity is Severity.RED else self.points_blue


RANGES = (
    ("duration_ms", 1_000, 3_600_000),
    ("red_expiry_ms", 1, 3_600_000),
    ("treat_red_ms", 0, 60_000),
    ("treat_blue_ms", 0, 60_000),
    ("sight_radius", 1, 20),
    ("moves_per_second", 0.5, 100),
    ("points_red", 0, 1_000),
    ("points_blue", 0, 1_000),
)
"""The least and the greatest value of every setting that is a number."""

FREE_PLAY = MissionSettings(level_key=True)
"""What a mission outside a study is played by, where nothing else is said."""
