"""Buildings, sight, the mission and its rules: pure and deterministic."""

from game.world.library import load_building

__all__ = ["load_building"]
