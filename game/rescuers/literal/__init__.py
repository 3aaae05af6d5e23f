"""A rescuer who reads the bar literally: the proof that the instructions mean what they say."""

from game.rescuers.literal.grammar import UnreadableInstruction
from game.rescuers.literal.literal_reader import LiteralReader

__all__ = ["LiteralReader", "UnreadableInstruction"]
