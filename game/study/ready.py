"""The forms that come with the game, to be copied into a study's forms.toml."""

from __future__ import annotations

import tomllib
from importlib import resources
from typing import Any

from game.errors import AnaError, choose_from
from game.forms.form import Forms
from game.forms.reading import FORMS, forms_in, paper_text
from game.study.languages import ENGLISH, Translation

_FOLDER = "ready_forms"
PAPER = "paper"
"""The name of the forms of a new study."""


def ready_names() -> tuple[str, ...]:
    """The names of all ready forms."""
    found = (resources.files("game.study") / _FOLDER).iterdir()
    return (PAPER, *sorted(it.name.removesuffix(".toml") for it in found))


def ready_text(name: str, language: str = ENGLISH) -> str:
    """A ready form as it is written in forms.toml. Raises AnaError for a name or language that is
    none."""
    if name not in ready_names():
        raise AnaError(f"there is no ready form '{name}'", hint=choose_from(name, ready_names()))
    if language != ENGLISH:
        translation = Translation(language)
        return translation.texts[FORMS] if name == PAPER else translation.ready_form(name)
    if name == PAPER:
        return paper_text()
    return (resources.files("game.study") / _FOLDER / f"{name}.toml").read_text(encoding="utf-8")


def ready_forms(name: str, language: str = ENGLISH) -> Forms:
    """A ready form, read. Raises AnaError for a name or language that is none."""
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
