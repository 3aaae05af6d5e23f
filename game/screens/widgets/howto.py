"""How to play: what one sees, the keys, the coach's three ways of speaking."""

from __future__ import annotations

from collections.abc import Iterable
from typing import ClassVar, Protocol, runtime_checkable

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.screen import Screen

from game.screens.widgets.canvas import BLANK, Canvas, Row, Run, beside
from game.screens.widgets.glyphs import PLAIN, SOLID, STYLES, GlyphSet, Kind, player_kind
from game.screens.widgets.keyline import KeyLine
from game.screens.widgets.keymap import USUAL_KEYS, KeyMap
from game.screens.widgets.statuspanel import clock_text
from game.world.geometry import Heading
from game.world.settings import FREE_PLAY, MissionSettings

_MARGIN = "  "
_LEGEND = (
    (player_kind(Heading.NORTH), "you: an arrowhead pointing the way you face"),
    (Kind.RED, "red victim: dies unless treated {in_time}"),
    (Kind.BLUE, "blue victim: hurt, can wait until the end"),
    (Kind.TREATED_RED, "being treated: stay until it is finished"),
    (Kind.RESCUED, "rescued"),
    (Kind.EXPIRED, "lost"),
    (Kind.WALL, "wall"),
    (Kind.DOOR, "door: stand next to it to see through"),
    (Kind.FLOOR, "floor in view"),
    (Kind.SEEN_FLOOR, "floor you have seen before"),
)
_COMPASS_KEYS = (
    ("↑ ↓ ← →", "walk; also W A S D and H J K L"),
    ("Space", "treat the victim under or next to you"),
)
_TURN_KEYS = (
    ("↑", "walk the way you face; also W and K"),
    ("← →", "turn; also A D and H L"),
    ("Space", "treat the victim under or next to you"),
)
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
    in_time = red_time(rules)
    long = [_sign(glyphs, *sign, in_time) for sign in _LEGEND if sign[0] not in _FEW_WORDS]
    short = [_sign(glyphs, *sign) for sign in _LEGEND if sign[0] in _FEW_WORDS]
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


def walking_rows(*, turning: bool, keys: KeyMap = USUAL_KEYS) -> list[Row]:
    """The keys by which the rescuer acts."""
    treat = keys.label("treat"), _COMPASS_KEYS[-1][1]
    usual = _TURN_KEYS if turning else _COMPASS_KEYS
    if not keys.walking:
        return _keys((*usual[:-1], treat))
    if turning:
        turn = f"{keys.label('left')} {keys.label('right')}"
        return _keys([(keys.label("up"), "walk the way you face"), (turn, "turn"), treat])
    return _keys([(keys.walking, "walk"), treat])


def sign_rows(glyphs: GlyphSet, rules: MissionSettings) -> list[Row]:
    """What each sign of the office means."""
    return [_sign(glyphs, kind, meaning, red_time(rules)) for kind, meaning in _LEGEND]


def red_time(rules: MissionSettings) -> str:
    """By when a red victim must be treated."""
    if 2 * rules.reds_expire_ms == rules.duration_ms:
        return "by half time"
    if rules.reds_expire_ms >= rules.duration_ms:
        return "before the end"
    return f"in the first {clock_text(rules.reds_expire_ms)}"


def _sign(glyphs: GlyphSet, kind: Kind, meaning: str, in_time: str = "") -> Row:
    return ((_MARGIN, ""), glyphs[kind], (f"  {meaning.format(in_time=in_time)}", ""))


def _keys(keys: Iterable[tuple[str, str]]) -> list[Row]:
    return [_key(f" {key:^7} ", does) for key, does in keys]


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
