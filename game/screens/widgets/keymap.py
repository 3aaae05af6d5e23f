"""Which keys do what in a mission: the usual ones, or those of a file of the player's own."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from textual.keys import KEY_ALIASES, Keys, _character_to_key

from game.errors import AnaError, choose_from

USUAL: Mapping[str, tuple[str, ...]] = {
    "up": ("up", "w", "k"),
    "right": ("right", "d", "l"),
    "down": ("down", "s", "j"),
    "left": ("left", "a", "h"),
    "treat": ("space",),
    "simpler": ("plus", "equals_sign"),
    "shorter": ("minus", "underscore"),
    "pause": ("p",),
    "help": ("question_mark", "f1"),
    "leave": ("q", "escape", "ctrl+q", "ctrl+c"),
}
_BINDINGS = {name: f"mission.{'triage' if name == 'treat' else name}" for name in USUAL}
_LABELS = {
    "up": "↑", "right": "→", "down": "↓", "left": "←", "space": "Space", "plus": "+", "minus": "-",
    "question_mark": "?", "escape": "Esc", "enter": "Enter",
}  # fmt: skip
_KNOWN = {key.value for key in Keys} | set(KEY_ALIASES)
TEMPLATE = """\
# Keys of missions outside studies. Remove the # before a line to change it; a key may be a letter,
# a sign, or a name such as "space", "enter", "f5", "ctrl+t" or "up". Esc, Ctrl+C and Ctrl+Q always
# lead out of a mission.

# up = ["up", "w", "k"]
# right = ["right", "d", "l"]
# down = ["down", "s", "j"]
# left = ["left", "a", "h"]
# treat = ["space"]
# simpler = ["+"]
# shorter = ["-"]
# pause = ["p"]
# help = ["?", "f1"]
# leave = ["q"]
"""


@dataclass(frozen=True)
class KeyMap:
    """The keys that were changed, by what they do; the first of several is the one shown."""

    changed: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def label(self, name: str) -> str:
        """The key for something, as it stands on the screen."""
        key = self.changed.get(name, USUAL[name])[0]
        return _LABELS.get(key, key.upper() if len(key) == 1 else key.capitalize())

    @property
    def walking(self) -> str:
        """The four keys that walk, where any of them was changed; else empty."""
        ways = ("up", "down", "left", "right")
        if not any(way in self.changed for way in ways):
            return ""
        return " ".join(self.label(way) for way in ways)

    @property
    def bindings(self) -> dict[str, str]:
        """The changed keys as Textual takes them: bindings by their ids."""
        return {_BINDINGS[name]: ",".join(_both_cases(keys)) for name, keys in self.changed.items()}


USUAL_KEYS = KeyMap()


def _both_cases(keys: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(
        it
        for key in keys
        for it in ((key, key.upper()) if len(key) == 1 and key.islower() else (key,))
    )


def read_keys(path: Path) -> KeyMap:
    """The keys of the file at `path`; the usual ones where there is none. Raises AnaError, naming
    the line of the file that is wrong, or that cannot be read."""
    try:
        told = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return USUAL_KEYS
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise AnaError(f"the keys cannot be read ({error})", place=str(path)) from error
    changed = {name: _keys_of(name, wanted, path) for name, wanted in told.items()}
    if "leave" in changed:
        always = (key for key in USUAL["leave"][1:] if key not in changed["leave"])
        changed["leave"] += tuple(always)
    _check_apart({**USUAL, **changed}, path)
    return KeyMap(changed)


def write_template(path: Path) -> None:
    """Write a file to be edited, where there is none and that is possible."""
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("x", encoding="utf-8") as file:
            file.write(TEMPLATE)


def _keys_of(name: str, wanted: object, path: Path) -> tuple[str, ...]:
    if name not in USUAL:
        raise AnaError(
            f"there is nothing called '{name}'", place=str(path), hint=choose_from(name, USUAL)
        )
    keys = [wanted] if isinstance(wanted, str) else wanted
    if not isinstance(keys, list) or not keys or not all(isinstance(key, str) for key in keys):
        raise AnaError(
            f"{name} must be a key or a list of keys",
            place=str(path),
            hint=f'Write it as {name} = ["{USUAL[name][0]}"].',
        )
    return tuple(_key(name, key, path) for key in keys)


def _key(name: str, key: str, path: Path) -> str:
    """A key by the name that Textual has for it."""
    if len(key) == 1 and key.isprintable():
        return "space" if key == " " else _character_to_key(key.lower())
    plain = key.lower().strip()
    *modifiers, last = plain.split("+")
    if plain in _KNOWN or (
        modifiers
        and set(modifiers) <= {"ctrl", "alt", "shift"}
        and (last in _KNOWN or len(last) == 1)
    ):
        return plain
    raise AnaError(
        f"{name}: there is no key '{key}'",
        place=str(path),
        hint="Write a letter, a sign, or a name such as space, enter, f5, ctrl+t or up.",
    )


def _check_apart(keys: Mapping[str, tuple[str, ...]], path: Path) -> None:
    """Raises AnaError where one key would do two things."""
    taken: dict[str, str] = {}
    for name, all_of_it in keys.items():
        for key in all_of_it:
            other = taken.setdefault(key.lower(), name)
            if other != name:
                raise AnaError(
                    f"the key '{key}' is given to {other} and to {name}",
                    place=str(path),
                    hint=f"Give {other} or {name} another key.",
                )
