"""The small words of a mission's screen and of its keys: English, unless a study says otherwise.

They stand apart from the study, because free play does not load it, and from the screens, because
a study's texts are checked without a terminal.
"""

from __future__ import annotations

import msgspec


class _Words(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    pass


class KeyNames(_Words, frozen=True):
    """What stands on the keys. `yes` and `no` are letters that answer a question."""

    enter: str = "Enter"
    space: str = "Space"
    delete: str = "Del"
    page: str = "PgUp PgDn"
    letters: str = "A-Z"
    yes: str = "y"
    no: str = "n"

    def __post_init__(self) -> None:
        for name in ("yes", "no"):
            key = getattr(self, name)
            if len(key) != 1 or not key.isalpha() or key in "qQ":
                raise ValueError(f"{name} must be a single letter other than q, not '{key}'")
        if self.yes.casefold() in (self.no.casefold(), "n") or self.no.casefold() == "y":
            raise ValueError("yes and no must be different letters")


class Directions(_Words, frozen=True):
    """The four headings, north first."""

    north: str = "north"
    east: str = "east"
    south: str = "south"
    west: str = "west"


class Panel(_Words, frozen=True):
    """The panel beside the office: clock, rescued, the red victims' time, heading, treatment."""

    left: str = "left"
    rescued: str = "{count} rescued"
    points: str = "{count} points"
    for_reds: str = "{time} for reds"
    out_of_time: str = "out of time"
    facing: str = "facing {direction}"
    treats: str = "treats"
    stand_beside: str = "stand beside to treat"


class Legend(_Words, frozen=True):
    """What each sign means, what the keys do, and by when red victims must be treated."""

    you: str = "you: an arrowhead pointing the way you face"
    red: str = "red victim: dies unless treated {in_time}"
    blue: str = "blue victim: hurt, can wait until the end"
    treated: str = "being treated: stay until it is finished"
    rescued: str = "rescued"
    lost: str = "lost"
    wall: str = "wall"
    door: str = "door: stand next to it to see through"
    floor: str = "floor in view"
    seen_floor: str = "floor you have seen before"
    by_half_time: str = "by half time"
    before_the_end: str = "before the end"
    in_the_first: str = "in the first {time}"
    walk: str = "walk; also W A S D and H J K L"
    walk_ahead: str = "walk the way you face; also W and K"
    turn: str = "turn; also A D and H L"
    treat: str = "treat the victim under or next to you"


class MissionWords(_Words, frozen=True):
    """All of them."""

    panel: Panel = Panel()
    directions: Directions = Directions()
    legend: Legend = Legend()
    keys: KeyNames = KeyNames()


ENGLISH = MissionWords()


def asked_words(want: str, *, answered: bool) -> str:
    """What is told in free play when `simpler` or `shorter` words were asked for; `answered` is
    whether others stand on the bar then."""
    return f"You asked for {want} words" if answered else f"The coach has no {want} words"
