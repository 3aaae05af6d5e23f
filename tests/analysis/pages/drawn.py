"""What the tests ask of every figure: all inside its axes and on the page, at a print width."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import Collection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.transforms import Bbox

from analysis.pages.style import ONE_COLUMN, TWO_COLUMNS, Captioned

#: Pixels that a line's width may reach beyond its point.
SLACK = 2.0


def faults(drawn: Captioned) -> list[str]:
    """Everything that is wrong with a figure, in words."""
    figure = drawn.figure
    renderer: Any = FigureCanvasAgg(figure).get_renderer()  # type: ignore[no-untyped-call]
    figure.draw_without_rendering()
    found = []
    if min(abs(figure.get_figwidth() - width) for width in (ONE_COLUMN, TWO_COLUMNS)) > 1e-9:
        found.append(f"width {figure.get_figwidth():.2f} in")
    for axes in figure.axes:
        if axes.get_visible():
            found += _outside(axes, renderer)
    found += _covered(figure, renderer)
    page = figure.get_tightbbox(renderer)
    size = figure.get_size_inches()
    if page.x0 < -0.02 or page.y0 < -0.02 or page.x1 > size[0] + 0.02 or page.y1 > size[1] + 0.02:
        found.append(f"something is off the page: {page} of {size}")
    return [f"{drawn.name}: {fault}" for fault in found]


def _covered(figure: Figure, renderer: Any) -> list[str]:
    """The panels that a legend of the figure lies over, and the words that one of a panel does."""
    pairs: list[tuple[Any, Any, str]] = [
        (box, axes, axes.get_title(loc="left"))
        for box in figure.legends
        for axes in figure.axes
        if axes.get_visible()
    ]
    pairs += [
        (box, text, text.get_text())
        for axes in figure.axes
        if (box := axes.get_legend())
        for text in axes.texts
    ]
    return [
        f"a legend covers {words!r}"
        for box, artist, words in pairs
        if box.get_window_extent(renderer).overlaps(artist.get_window_extent(renderer))
    ]


def _outside(axes: Axes, renderer: Any) -> list[str]:
    inside = axes.get_window_extent(renderer).padded(SLACK)
    return [
        f"{axes.get_title(loc='left')!r}: {artist} at {box}"
        for artist in (*axes.lines, *axes.collections, *axes.texts, *axes.patches, *axes.images)
        for box in _boxes(artist, renderer)
        if not _holds(inside, box)
    ]


def _boxes(artist: Any, renderer: Any) -> list[Bbox]:
    if isinstance(artist, Line2D):
        points = artist.get_transform().transform(artist.get_xydata())
        return [Bbox([point, point]) for point in points]
    if isinstance(artist, Collection) and not np.size(artist.get_offsets()):
        paths = [np.asarray(path.vertices, dtype=float) for path in artist.get_paths()]
        shown = [artist.get_transform().transform(path) for path in paths if path.size]
        return [Bbox([ends.min(axis=0), ends.max(axis=0)]) for ends in shown]
    box = artist.get_window_extent(renderer)
    return [box] if box.width or box.height else []


def _holds(outer: Bbox, inner: Bbox) -> bool:
    return bool(
        inner.x0 >= outer.x0
        and inner.x1 <= outer.x1
        and inner.y0 >= outer.y0
        and inner.y1 <= outer.y1
    )


def legend_labels(figure: Figure) -> set[str]:
    """The words of all legends of a figure."""
    boxes = [*figure.legends, *(axes.get_legend() for axes in figure.axes if axes.get_legend())]
    return {text.get_text() for box in boxes if box is not None for text in box.get_texts()}
