"""The looks that the mission has had: a study keeps the one it was made with."""

from __future__ import annotations

from typing import Literal

Look = Literal[1, 2]
CellSize = Literal["normal", "large"]
LOOK: Look = 2
"""The look of today. In look 1, doors were filled and reds and unseen floor had less contrast."""
