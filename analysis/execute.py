"""Runs notebooks from top to bottom, all in one kernel that forgets in between.

`make notebooks` runs the shipped ones and stores them with what they show. The libraries of
notebooks take two seconds to import; they are imported where they are used.
"""

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeAlias

from analysis.pages.notebook import VARIABLE

NOTEBOOKS = Path(__file__).resolve().parents[1] / "notebooks"
TIMEOUT_S = 300
FORGET = "%reset -f"

Notebook: TypeAlias = Any
"""An `nbformat.NotebookNode`; its library has no types."""


def notebooks() -> list[Path]:
    """The shipped notebooks, in the order a reader asks."""
    return sorted(NOTEBOOKS.glob("[0-9][0-9]_*.ipynb"))


def executed(paths: Iterable[Path], source: Path | None = None) -> Iterator[tuple[Path, Notebook]]:
    """Each notebook with its outputs, run on `source`, or on its own parameter.

    Raises nbclient.exceptions.CellExecutionError, which shows the cell, where one fails.
    """
    from jupyter_client.manager import KernelManager
    from nbclient import NotebookClient

    manager = KernelManager()
    runner = NotebookClient(_forgetting(), km=manager, timeout=TIMEOUT_S, record_timing=False)
    try:
        with _source(source):
            runner.execute(cwd=str(NOTEBOOKS))
        for path in paths:
            notebook = read(path)
            for part in (_forgetting(), notebook):
                runner.nb = part
                runner.execute()
            yield path, notebook
    finally:
        if runner.kc is not None:
            runner.kc.stop_channels()
        if manager.has_kernel:
            manager.shutdown_kernel(now=True)


def read(path: Path) -> Notebook:
    """The notebook in a file."""
    return _nbformat().read(path, as_version=4)


def write(notebook: Notebook, path: Path) -> None:
    """Write a notebook with what it holds."""
    path.parent.mkdir(parents=True, exist_ok=True)
    _nbformat().write(notebook, path)


def title(notebook: Notebook) -> str:
    """Its first heading, the question it answers."""
    return str(notebook.cells[0].source).splitlines()[0].lstrip("# ")


def html(notebook: Notebook) -> str:
    """An executed notebook as one page of HTML, without the code."""
    from nbconvert import HTMLExporter

    notebook.metadata["title"] = title(notebook)
    untyped: Any = HTMLExporter
    exporter = untyped(
        exclude_input=True, exclude_output_prompt=True, mathjax_url="", require_js_url=""
    )
    page, _ = exporter.from_notebook_node(notebook)
    return str(page)


def main() -> None:
    """Run every shipped notebook on its own parameter and store its outputs in place."""
    for path, notebook in executed(notebooks()):
        for at, cell in enumerate(one for one in notebook.cells if one.cell_type == "code"):
            cell.execution_count = at + 1
            for output in cell.outputs:
                if "execution_count" in output:
                    output.execution_count = at + 1
        notebook.metadata.language_info = {"name": "python"}
        write(notebook, path)


def _nbformat() -> Any:
    import nbformat

    return nbformat


def _forgetting() -> Notebook:
    made = _nbformat().v4
    return made.new_notebook(cells=[made.new_code_cell(FORGET)])


@contextmanager
def _source(source: Path | None) -> Iterator[None]:
    """The environment that a kernel starts with."""
    before = os.environ.get(VARIABLE)
    if source is not None:
        os.environ[VARIABLE] = str(source.resolve())
    try:
        yield
    finally:
        os.environ.pop(VARIABLE, None)
        if before is not None:
            os.environ[VARIABLE] = before


if __name__ == "__main__":
    main()
