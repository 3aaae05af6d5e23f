"""The pages of a study as pictures for whoever must approve of it: SVG, PNG, and one HTML page."""

from __future__ import annotations

import re
from collections.abc import Sequence
from html import escape, unescape
from pathlib import Path

from rich.cells import cell_len

from game.screens.study.rehearsal import Rehearsed
from game.study.folder import StudyError

_FONT_RULES = re.compile(r"\s*@font-face \{[^}]*\}")
"""Where a picture would fetch its font from; nothing is fetched."""
_LENGTHS = re.compile(r'textLength="([\d.]+)"([^>]*)>([^<]*)<')
"""How wide a text is drawn: it comes counted in letters, some of which take two columns."""
_FONT = "DejaVu Sans Mono"
_LETTER = '<svg xmlns="http://www.w3.org/2000/svg" width="20" height="20">{}</svg>'

_HTML = """<!doctype html>
<html lang="en"><meta charset="utf-8"><title>{title}</title>
<style>
body {{ font-family: sans-serif; max-width: 70em; margin: 2em auto }}
img {{ width: 100% }}
</style>
<h1>{title}</h1>
<p>Every page as participants see it, in the order of a session; at the end those that most of them
never see.</p>
{body}
</html>
"""


def write_pictures(pages: Sequence[Rehearsed], study: str, out: Path) -> Path:
    """Write every page as SVG and PNG to the folder `out`, and one HTML page with all of them,
    whose path is returned. Raises StudyError where that cannot be done."""
    _need_a_font()
    body = []
    try:
        out.mkdir(parents=True, exist_ok=True)
        for number, page in enumerate(pages, start=1):
            body.append(f"<h2>{escape(page.name)}</h2>")
            for part, picture in enumerate(page.pictures, start=1):
                path = out / f"{number:02}-{part}.svg"
                drawn = _LENGTHS.sub(_as_wide_as_drawn, _FONT_RULES.sub("", picture))
                path.write_text(drawn, encoding="utf-8")
                path.with_suffix(".png").write_bytes(_png(drawn))
                body.append(f'<img src="{path.name}" alt="{escape(page.name)}">')
        index = out / "index.html"
        index.write_text(_HTML.format(title=escape(study), body="\n".join(body)), "utf-8")
    except OSError as error:
        raise StudyError(
            f"the pictures cannot be written ({error.strerror})",
            place=str(out),
            hint="Choose a folder that you can write to",
        ) from error
    return index


def _as_wide_as_drawn(found: re.Match[str]) -> str:
    text = unescape(found[3])
    length = float(found[1]) * cell_len(text) / max(1, len(text))
    return f'textLength="{length:g}"{found[2]}>{found[3]}<'


def _png(svg: str) -> bytes:
    from resvg_py import svg_to_bytes

    return bytes(svg_to_bytes(svg_string=svg, monospace_family=_FONT))


def _need_a_font() -> None:
    letter = '<text y="15" font-family="monospace">M</text>'
    if _png(_LETTER.format("")) == _png(_LETTER.format(letter)):
        raise StudyError(
            f"the pictures would have no letters: the font {_FONT} is not on this machine",
            hint="Install it; Debian has it in the package fonts-dejavu-core",
        )
