"""What the coach says, at three levels of abstraction (paper 5.1.2)."""

from game.coach.instructions.course import course
from game.coach.instructions.notices import correction
from game.coach.instructions.scene import Instruction, Pose, Scene
from game.coach.instructions.transformation import instruct, lower

__all__ = ["Instruction", "Pose", "Scene", "correction", "course", "instruct", "lower"]
