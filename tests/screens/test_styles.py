"""What the stylesheets name is there: a class that is renamed would lose its looks silently."""

import ast
import re
from pathlib import Path

import pytest

SCREENS = Path(__file__).resolve().parents[2] / "game" / "screens"
OF_TEXTUAL = {"App", "ModalScreen", "Screen", "Static", "TextArea", "VerticalScroll"}
SHEETS = sorted(SCREENS.rglob("*.tcss"))


def classes() -> set[str]:
    trees = (ast.parse(path.read_text(encoding="utf-8")) for path in SCREENS.rglob("*.py"))
    return {
        node.name for tree in trees for node in ast.walk(tree) if isinstance(node, ast.ClassDef)
    }


@pytest.mark.parametrize("sheet", SHEETS, ids=lambda path: path.stem)
def test_every_type_in_a_stylesheet_is_a_class(sheet: Path) -> None:
    rules = re.sub(r"/\*.*?\*/|\{.*?\}", "\n", sheet.read_text(encoding="utf-8"), flags=re.DOTALL)
    named = set(re.findall(r"(?<![\w.#$-])[A-Z]\w+", rules))
    assert named
    assert named - OF_TEXTUAL <= classes()
