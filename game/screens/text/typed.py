"""What a player may type: commands, in short or in the very words of the bar's steps and turns."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

from game.world.events import LevelWish
from game.world.geometry import Heading

Side = Literal["forward", "left", "right", "back"]
Topic = Literal["look", "bar", "status", "seen", "map", "help"]
End = Literal["wall", "door", "end"]
MOST_STEPS = 200
MOST_SECONDS = 3600


@dataclass(frozen=True)
class Face:
    """Turn so as to face a side or a point of the compass."""

    way: Side | Heading


@dataclass(frozen=True)
class Walk:
    """So many steps ahead; or to the last cell before a wall, onto the next door, or as far as the
    floor reaches (`end`), before a wall or a door."""

    steps: int = 1
    until: End | None = None


@dataclass(frozen=True)
class Treat:
    pass


@dataclass(frozen=True)
class Wait:
    """Let time pass; None: until something happens."""

    seconds: int | None


@dataclass(frozen=True)
class Ask:
    want: LevelWish


@dataclass(frozen=True)
class Tell:
    topic: Topic


@dataclass(frozen=True)
class Leave:
    pass


Command = Face | Walk | Treat | Wait | Ask | Tell | Leave


class NotUnderstood(ValueError):
    """Something typed that is no command."""


HELP = (
    "Time passes only while you walk, treat or wait. Take as long as you like to read and type.",
    "f, or forward: a step ahead. f 4: four steps. l, r, b: turn left, right or around. "
    "l 4: turn left and walk four steps.",
    "n, e, s, w: a step north, east, south or west. n 4: four steps.",
    "f wall, f door or f end: walk ahead to the wall, onto the next door, or as far as the floor "
    "reaches.",
    "t, or treat: treat the person you stand on or next to, and stay until it is done.",
    "wait: until something happens. wait 5: five seconds.",
    "look: what is around you. bar, or an empty line: what the bar says. status: time and people.",
    "seen: people you have seen who still wait. map: the building's size and its nearest doors.",
    "plus and minus: ask the coach for simpler or for shorter words.",
    "quit: leave the mission.",
    "Several commands can stand in one line, after full stops or commas. The steps and turns of "
    "the bar can be typed as they are: Turn right. Walk forward 4 steps.",
)

_SIDES: dict[str, Side] = {
    "f": "forward", "forward": "forward", "ahead": "forward", "straight": "forward",
    "l": "left", "left": "left",
    "r": "right", "right": "right",
    "b": "back", "back": "back", "around": "back", "behind": "back",
}  # fmt: skip
_HEADINGS = {heading.name.lower(): heading for heading in Heading} | {
    heading.name.lower()[0]: heading for heading in Heading
}
_TOPICS: dict[str, Topic] = {
    "look": "look", "x": "look",
    "bar": "bar", "": "bar", "again": "bar",
    "status": "status", "time": "status",
    "seen": "seen", "map": "map", "doors": "map",
    "help": "help", "?": "help", "h": "help",
}  # fmt: skip
_WISHES: dict[str, LevelWish] = {
    "plus": "simpler", "+": "simpler", "simpler": "simpler",
    "minus": "shorter", "-": "shorter", "shorter": "shorter",
}  # fmt: skip
_ENDS: dict[str | None, End] = {"wall": "wall", "door": "door", "end": "end"}
_TREAT = re.compile(
    r"t|treat|space|triage|save|utilize medical equipment"
    r"|(?:triage|treat|save|approach and save) the (?:red|blue) victim"
)
_LEAVE = frozenset({"quit", "q", "leave", "exit"})
_STOP = frozenset({"stop", "stay"})
_WALK = re.compile(
    r"(?:walk |go )?([a-z]+)(?: (?:to the |to )?(?:(\d+)(?: steps?)?|(wall|door|end)))?"
)
_WAIT = re.compile(r"(?:wait|z)(?: (\d+)(?: ?s| seconds?)?)?")


def understood(line: str) -> list[Command]:
    """The commands in a line. Raises NotUnderstood, naming the part that is none."""
    parts = [" ".join(part.split()) for part in re.split(r"[.;,]|\bthen\b", line.lower())]
    wanted = [part for part in parts if part] or [""]
    return [command for part in wanted for command in _one(part)]


def _one(part: str) -> list[Command]:
    if part in _TOPICS:
        return [Tell(_TOPICS[part])]
    if part in _WISHES:
        return [Ask(_WISHES[part])]
    if part in _LEAVE:
        return [Leave()]
    if part in _STOP:
        return []
    if _TREAT.fullmatch(part):
        return [Treat()]
    if waited := _WAIT.fullmatch(part):
        return [Wait(min(MOST_SECONDS, int(waited[1])) if waited[1] else None)]
    if part.startswith(("turn ", "face ")):
        return [Face(_way(part.split(maxsplit=1)[1], part))]
    if walked := _WALK.fullmatch(part):
        return _walk(walked, part)
    raise NotUnderstood(part)


def _walk(walked: re.Match[str], part: str) -> list[Command]:
    word, steps, end = walked.groups()
    way = _way(word, part)
    told = bool(steps or end)
    walk = Walk(min(MOST_STEPS, int(steps)) if steps else 1, _ENDS.get(end))
    if way == "forward":
        return [walk]
    return [Face(way), walk] if told or isinstance(way, Heading) else [Face(way)]


def _way(word: str, part: str) -> Side | Heading:
    if word in _SIDES:
        return _SIDES[word]
    if word in _HEADINGS:
        return _HEADINGS[word]
    raise NotUnderstood(part)
