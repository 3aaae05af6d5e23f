"""The languages that a new study can begin with: English, and one folder for each translation.

A folder holds the texts, the questions and the instructions, as a study folder does, in
`study.toml` the name of the study alone, and in `rooms.toml` those of the shipped buildings' rooms.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable
from importlib import resources

from game.errors import AnaError, choose_from
from game.world import load_building

ENGLISH = "en"
ROOMS = "rooms.toml"
SETTINGS = "study.toml"
_HERE = resources.files("game.study.languages")
_NAME = re.compile(r"^name = .*$", re.MULTILINE)
_ROOM = re.compile(r"^(\S = room )(.+?)(?=\s*$)", re.MULTILINE)


def languages() -> tuple[str, ...]:
    """What can be chosen."""
    return ENGLISH, *sorted(it.name for it in _HERE.iterdir() if (it / ROOMS).is_file())


class Translation:
    """Everything that participants read, in a language other than English.

    Raises AnaError for a language that there is not.
    """

    def __init__(self, language: str) -> None:
        if language not in languages():
            also = "; docs/lab.md tells how to translate a study yourself"
            hint = choose_from(language, languages(), also)
            raise AnaError(f"there is no translation '{language}'", place="--language", hint=hint)
        self._folder = _HERE / language

    @property
    def rooms(self) -> dict[str, str]:
        """The names of the shipped buildings' rooms, by their English names."""
        text = (self._folder / ROOMS).read_text(encoding="utf-8")
        return {english: str(name) for english, name in tomllib.loads(text).items()}

    @property
    def texts(self) -> dict[str, str]:
        """Files of a study folder, by name."""
        names = (it.name for it in self._folder.iterdir() if it.name.endswith(".toml"))
        return {
            name: (self._folder / name).read_text(encoding="utf-8")
            for name in names
            if name not in (ROOMS, SETTINGS)
        }

    def named(self, settings: str) -> str:
        """The text of a study.toml, with the study's name in this language."""
        own = (self._folder / SETTINGS).read_text(encoding="utf-8")
        (line,) = _NAME.findall(own)
        return _NAME.sub(lambda _: str(line), settings, count=1)

    def ready_form(self, name: str) -> str:
        """A ready form, as it is written in forms.toml."""
        return (self._folder / "ready_forms" / f"{name}.toml").read_text(encoding="utf-8")

    def buildings(self, names: Iterable[str]) -> dict[str, str]:
        """The files of shipped buildings, with their rooms renamed."""
        return {f"{name}.txt": self._renamed(load_building(name).text) for name in names}

    def _renamed(self, building: str) -> str:
        rooms = self.rooms
        return _ROOM.sub(lambda found: found[1] + rooms[found[2]], building)
