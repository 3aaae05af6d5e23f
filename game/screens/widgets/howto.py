"""How to play: what one sees, the keys, the coach's three ways of speaking."""

from __future__ import annotations

from collections.abc import Iterable
from typing import ClassVar, Protocol, runtime_checkable

from rich.cells import cell_len
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.screen import Screen

from game.mission_words import ENGLISH, MissionWords
from game.screens.widgets.canvas import BLANK, Canvas, Row, Run, beside
from game.screens.widgets.glyphs import PLAIN, SOLID, STYLES, GlyphSet, Kind, player_kind
from game.screens.widgets.keyline import KeyLine
from game.screens.widgets.keymap import USUAL_KEYS, KeyMap
from game.screens.widgets.statuspanel import clock_text
from game.world.geometry import Heading
from game.world.settings import FREE_PLAY, MissionSettings

_MARGIN = "  "
_SIGNS = (
    (player_kind(Heading.NORTH), "you"),
    (Kind.RED, "red"),
    (Kind.BLUE, "blue"),
    (Kind.TREATED_RED, "treated"),
    (Kind.RESCUED, "rescued"),
    (Kind.EXPIRED, "lost"),
    (Kind.WALL, "wall"),
    (Kind.DOOR, "door"),
    (Kind.FLOOR, "floor"),
    (Kind.SEEN_FLOOR, "seen_floor"),
)
"""Each with the name of its meaning in the legend."""
_LEVELS = (
    ("C1", "every step:", "Turn right. Walk forward 4 steps."),
    ("C2", "what you pass:", "Enter the third door on your left."),
    ("C3", "by name:", "Go to the Records Room. Triage the red victim."),
)
_TREAT = "Utilize medical equipment."
_FEW_WORDS = frozenset({Kind.RESCUED, Kind.EXPIRED, Kind.WALL, Kind.FLOOR})
"""Signs with so short a meaning that they stand beside the others,"""
_BESIDE = 52
"""from this column on."""


def howto_rows(glyphs: GlyphSet, rules: MissionSettings, keys: KeyMap = USUAL_KEYS) -> list[Row]:
    """The page, drawn with the very glyphs of the mission. It fits the smallest screen."""
    signs = list(zip(_SIGNS, sign_rows(glyphs, rules), strict=True))
    long = [row for (kind, _), row in signs if kind not in _FEW_WORDS]
    short = [row for (kind, _), row in signs if kind in _FEW_WORDS]
    wishes = f"{keys.label('simpler')} {keys.label('shorter')}"
    others = [(wishes, "simpler or shorter words")] if rules.level_key else []
    others += [(keys.label("pause"), "pause")] if rules.allow_pause else []
    others += [(keys.label("help"), "help"), (keys.label("leave"), "leave")]
    return [
        _heading("Rescue as many victims as you can. The yellow bar guides you."),
        *walking_rows(turning=rules.controls == "turn", keys=keys),
        tuple(run for key, does in others for run in _key(f" {key} ", does)),
        BLANK,
        _heading("What you see"),
        *beside(long, short, _BESIDE),
        _line("A room's name shows while you see the middle of the room."),
        BLANK,
        _heading("What the coach says"),
        *_levels(),
        _line("ana and knowledge pick the level to suit how well you find your way."),
    ]


def walking_rows(
    *, turning: bool, words: MissionWords = ENGLISH, keys: KeyMap = USUAL_KEYS
) -> list[Row]:
    """The keys by which the rescuer acts."""
    legend, label = words.legend, keys.label
    walk = [(keys.walking or "↑ ↓ ← →", legend.walk if not keys.walking else "walk")]
    ahead = legend.walk_ahead if not keys.walking else "walk the way you face"
    sides = legend.turn if not keys.walking else "turn"
    turn = [(label("up"), ahead), (f"{label('left')} {label('right')}", sides)]
    treat = words.keys.space if "treat" not in keys.changed else label("treat")
    named = [*(turn if turning else walk), (treat, legend.treat)]
    columns = max(7, *(cell_len(key) for key, _ in named))
    return [_key(f" {_in_the_middle(key, columns)} ", does) for key, does in named]


def sign_rows(glyphs: GlyphSet, rules: MissionSettings, words: MissionWords = ENGLISH) -> list[Row]:
    """What each sign of the office means."""
    in_time = red_time(rules, words)
    meanings = [getattr(words.legend, name).replace("{in_time}", in_time) for _, name in _SIGNS]
    return [
        ((_MARGIN, ""), glyphs[kind], (f"  {meaning}", ""))
        for (kind, _), meaning in zip(_SIGNS, meanings, strict=True)
    ]


def example_of(level: int) -> str:
    """What a coach may say at a level, 1 to 3."""
    return _LEVELS[level - 1][2]


def red_time(rules: MissionSettings, words: MissionWords = ENGLISH) -> str:
    """By when a red victim must be treated."""
    if 2 * rules.reds_expire_ms == rules.duration_ms:
        return words.legend.by_half_time
    if rules.reds_expire_ms >= rules.duration_ms:
        return words.legend.before_the_end
    return words.legend.in_the_first.replace("{time}", clock_text(rules.reds_expire_ms))


def _in_the_middle(text: str, columns: int) -> str:
    """The text in the middle of so many columns."""
    blank = columns - cell_len(text)
    return f"{' ' * (blank // 2)}{text}{' ' * (blank - blank // 2)}"


def _key(key: str, does: str) -> Row:
    return ((_MARGIN, ""), (key, "key"), (f"  {does}", ""))


def _heading(text: str) -> Row:
    return ((text, "title"),)


def _line(text: str) -> Row:
    return ((_MARGIN + text, ""),)


def _levels() -> Iterable[Row]:
    for level, how, example in _LEVELS:
        runs: list[Run] = [(_MARGIN, ""), (level, "title"), (f" {how:<15}", "quiet")]
        yield (*runs, (f" {example} ", "example"))
    words = (f" {_TREAT} ", "example")
    yield ((f"{_MARGIN:20}", ""), words, (" means: press ", ""), (" Space ", "key"))


@runtime_checkable
class HasKeys(Protocol):
    """A program that knows the keys of missions."""

    keys: KeyMap


class HowTo(Canvas):
    """The page as a widget."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {*STYLES, "title", "key", "quiet", "example"}

    def __init__(self, rules: MissionSettings = FREE_PLAY) -> None:
        super().__init__()
        self._rules = rules

    def on_mount(self) -> None:
        glyphs = PLAIN if self.app.native_ansi_color else SOLID
        keys = self.app.keys if isinstance(self.app, HasKeys) else USUAL_KEYS
        self.draw(howto_rows(glyphs, self._rules, keys))


class HowToScreen(Screen[None]):
    """The page as a screen of its own."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,q,Q,enter,question_mark", "app.pop_screen", "Back", id="howto.back"),
    ]

    def compose(self) -> ComposeResult:
        with VerticalScroll(classes="page"):
            yield HowTo()
        yield KeyLine(("↑ ↓", "scroll"), ("Esc", "back"), id="keys")
