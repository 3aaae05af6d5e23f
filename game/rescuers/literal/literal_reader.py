"""The literal reader: a rescuer who does what the yellow bar says, word for word.

It receives Observations and the displayed text, and knows nothing of the coach.
"""

from __future__ import annotations

from collections.abc import Mapping

from game.rescuers.literal.execution import Doing, Stuck, Walker
from game.rescuers.literal.grammar import parse
from game.world.events import Action
from game.world.geometry import Cell
from game.world.observation import Observation
from game.world.settings import Controls


class LiteralReader:
    """Carries out the text on the bar; begins again when the text changes, or has been carried out
    and still stands. Notices are not instructions and are passed over.

    `places` maps the names of rooms to their label cells: what somebody must know at C3.
    """

    def __init__(self, controls: Controls, places: Mapping[str, Cell] | None = None) -> None:
        self._controls: Controls = controls
        self._places = places or {}
        self._text = ""
        self._doing: Doing | None = None

    def decide(self, observation: Observation) -> Action | None:
        """The next action; None to wait: during a treatment, with an empty bar, and where the text
        cannot be carried out. Raises `UnreadableInstruction` for a sentence it does not know.

        Call it whenever the rescuer may act, once for each action: it counts its own steps.
        """
        text = observation.guidance.text if observation.guidance else ""
        if observation.ended or observation.treatment is not None or not text:
            return None
        if text != self._text:
            self._text = text
            return self._begin(observation)
        if self._doing is None:
            return None
        try:
            return self._doing.send(observation)
        except StopIteration:
            return self._begin(observation)
        except Stuck:
            self._doing = None
            return None

    def _begin(self, observation: Observation) -> Action | None:
        """Start on the text from here. A text that asks for no action is waited out."""
        walker = Walker(self._controls, self._places, observation.heading)
        self._doing = walker.carry_out(parse(self._text), observation)
        try:
            return next(self._doing)
        except (StopIteration, Stuck):
            self._doing = None
            return None
