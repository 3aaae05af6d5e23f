"""The forms that come with the game, to be copied into a study's forms.toml."""

from __future__ import annotations

import tomllib
from importlib import resources
from importlib.resources.abc import Traversable
from typing import Any

from game.errors import AnaError, choose_from
from game.forms.form import Forms
from game.forms.reading import FORMS, forms_in, paper_text
from game.study.languages import ENGLISH, Translation, languages

_ENDING = ".toml"
PAPER = "paper"
"""The name of the forms of a new study."""


def ready_names() -> tuple[str, ...]:
    """The names of all ready forms."""
    found = (it.name for it in _folder(ENGLISH).iterdir() if it.name.endswith(_ENDING))
    return (PAPER, *sorted(name.removesuffix(_ENDING) for name in found))


def ready_text(name: str, language: str = ENGLISH) -> str:
    """A ready form as it is written in forms.toml. Raises AnaError for a name or a language that
    there is not."""
    if name not in ready_names():
        raise AnaError(f"there is no ready form '{name}'", hint=choose_from(name, ready_names()))
    if language not in languages():
        hint = choose_from(language, languages())
        raise AnaError(f"there is no translation '{language}'", place="--language", hint=hint)
    if name == PAPER and language == ENGLISH:
        return paper_text()
    if name == PAPER:
        return Translation(language).texts[FORMS]
    return (_folder(language) / f"{name}{_ENDING}").read_text(encoding="utf-8")


def _folder(language: str) -> Traversable:
    here = resources.files("game.study")
    return (here if language == ENGLISH else here / "languages" / language) / "ready_forms"


def ready_forms(name: str, language: str = ENGLISH) -> Forms:
    """A ready form, read. Raises AnaError as `ready_text` does."""
    tree: dict[str, Any] = {"version": "1"} | tomllib.loads(ready_text(name, language))
    return forms_in(tree, name)


def summary(name: str) -> str:
    """The first sentence of the comment that a ready form begins with."""
    lines = []
    for line in ready_text(name).splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.lstrip("# "))
    return f"{' '.join(lines).partition('. ')[0].rstrip('.')}."
