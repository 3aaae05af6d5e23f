"""Every notebook runs to its end, says that people are simulated, and is stored with outputs."""

from pathlib import Path

import pytest

from analysis.execute import executed, html, notebooks, read, title
from analysis.pages.style import SIMULATED
from tests.analysis.simulated import SHIPPED

PARAMETER = 'SOURCE = "../data/simulated"'


def test_all_questions_are_there_in_order() -> None:
    assert [path.name[:2] for path in notebooks()] == [f"{number:02}" for number in range(14)]


@pytest.mark.parametrize("path", notebooks(), ids=lambda path: path.stem)
def test_stored_with_what_it_shows_and_with_one_parameter(path: Path) -> None:
    cells = read(path).cells
    code = [cell for cell in cells if cell.cell_type == "code"]
    assert title(read(path)).endswith("?") or path.stem[:2] in ("00", "01", "11")
    assert code[0].source.startswith(PARAMETER)
    assert code[0].metadata.tags == ["parameters"]
    assert not any("SOURCE =" in cell.source for cell in code[1:])
    assert [cell.execution_count for cell in code] == list(range(1, len(code) + 1))
    outputs = [output for cell in code for output in cell.outputs]
    assert outputs and all(output.output_type == "execute_result" for output in outputs)
    assert SIMULATED in html(read(path))
    assert path.stat().st_size < 1_500_000


#: What these show is drawn in the tests of their pages as well.
LONG = ("00", "08", "09", "12", "13")


@pytest.mark.long
@pytest.mark.parametrize("every", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_the_notebooks_run_on_the_shipped_study(every: bool) -> None:
    paths = [path for path in notebooks() if every or path.name[:2] not in LONG]
    for path, notebook in executed(paths):
        page = html(notebook)
        assert SIMULATED in page, path
        assert "Not there" not in page, path
        assert "No figure" not in page, path
        outputs = [out for cell in notebook.cells for out in cell.get("outputs", ())]
        assert all(out.output_type == "execute_result" for out in outputs), path


def test_the_shipped_study_is_small() -> None:
    assert sum(path.stat().st_size for path in SHIPPED.iterdir()) < 3_000_000
