"""The results section as one page of HTML, with its tables and figures as files beside it."""

import base64
import json
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path

from analysis.pages.apa_table import html_of, unmarked, write_tables
from analysis.pages.manuscript import Section, figures_in, tables_of
from analysis.pages.notebook import Shown, show
from analysis.pages.other_programs import write_for_other_programs
from analysis.pages.style import SIMULATED, VERMILION, Captioned, save_figures
from analysis.sources.absent import Absent, plain
from analysis.sources.frames import StudyData
from analysis.sources.provenance import Provenance

STYLE = """
body { font-family: Georgia, serif; max-width: 52em; margin: 3em auto; padding: 0 1em;
       line-height: 1.5; color: #222 }
h1, h2 { font-family: sans-serif } h2 { margin-top: 2.5em }
table.apa { border-collapse: collapse; border-top: 1.5px solid; border-bottom: 1.5px solid;
            font-size: 85% }
p.title { margin-bottom: .4em }
table.apa th { border-bottom: 1px solid; font-weight: normal; text-align: left }
table.apa td, table.apa th { padding: .15em .7em .15em 0; vertical-align: top }
div { overflow-x: auto; margin: 1.5em 0 } .note, figcaption { font-size: 85% }
figure { margin: 1.5em 0 } img { max-width: 100% }
.simulated { color: VERMILION; font-weight: bold; font-family: sans-serif }
@media print {
  body { max-width: none; margin: 0; padding: 0; font-size: 10pt }
  @page { size: A4; margin: 18mm 16mm }
  div { overflow: visible; break-inside: avoid }
  table.apa { font-size: 7.5pt } thead { display: table-header-group }
  tr, figure { break-inside: avoid } h2, p.title { break-after: avoid }
}
dt { font-weight: bold } dd { margin: 0 0 .4em 1.5em; overflow-wrap: anywhere }
"""


def write_report(
    sections: Sequence[Section],
    study: StudyData,
    notes: Sequence[str],
    made: Provenance,
    folder: Path,
) -> Path:
    """Write `results.html`, `tables/`, `figures/`, `data/` and `provenance.json` into a folder;
    `study` is the analysed sample.

    Raises OSError where they cannot be written.
    """
    for part in ("tables", "figures", "data"):
        (folder / part).mkdir(parents=True, exist_ok=True)
    write_tables(list(tables_of(sections)), folder / "tables")
    save_figures(list(figures_in(sections)), folder / "figures", made.line())
    write_for_other_programs(study, folder / "data")
    values, _ = plain(made.row())
    text = json.dumps(values, indent=1, ensure_ascii=False) + "\n"
    (folder / "provenance.json").write_text(text, encoding="utf-8")
    page = folder / "results.html"
    images = {
        figure.name: (folder / "figures" / f"{figure.name}.svg").read_bytes()
        for figure in figures_in(sections)
    }
    text = html_page(sections, images, study.label, notes, made, simulated=study.simulated)
    page.write_text(text, encoding="utf-8")
    return page


def html_page(
    sections: Sequence[Section],
    images: Mapping[str, bytes],
    label: str,
    notes: Sequence[str],
    made: Provenance,
    *,
    simulated: bool,
) -> str:
    """The page with its figures inside it; `images` are they as SVG, by name."""
    warning = (
        f'<p class="simulated">{SIMULATED}: evidence about the software and the design’s power, '
        "never about people.</p>"
        if simulated
        else ""
    )
    told = "".join(f"<li>{escape(note)}</li>" for note in notes)
    listed = f"<h2>Notes</h2><ul>{told}</ul>" if told else ""
    body = "".join(section_html(section, images) for section in sections)
    style = STYLE.replace("VERMILION", VERMILION)
    return (
        '<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n'
        f'<meta name="generator" content="{escape(made.line())}">\n'
        f"<title>Results: {escape(label)}</title>\n<style>{style}</style>\n"
        f"<h1>Results: {escape(label)}</h1>\n{warning}\n"
        "<p>In the order of the paper’s sections 5.3 to 5.5; “paper” marks its printed numbers. "
        "The tables are also in <code>tables/</code>, the figures in <code>figures/</code>; "
        "<code>data/</code> has the sample for JASP, jamovi and R, and an R script of the main "
        "tests.</p>\n"
        f"{body}{listed}{_provenance_html(made)}</html>\n"
    )


def section_html(section: Section, images: Mapping[str, bytes]) -> str:
    """One section as HTML."""
    sentences = "".join(f"<p>{html_of(sentence)}</p>\n" for sentence in section.sentences)
    figures = "".join(figure_html(figure, images[figure.name]) for figure in section.figures)
    tables = "".join(table.html() for table in section.tables)
    return f"<h2>{escape(section.title)}</h2>\n{sentences}{figures}{tables}\n"


def figure_html(figure: Captioned, svg: bytes) -> str:
    """A figure with its caption below it."""
    data = base64.b64encode(svg).decode()
    caption = escape(figure.caption)
    return (
        f'<figure id="{figure.name}"><img alt="{caption}" src="data:image/svg+xml;base64,{data}">'
        f"<figcaption>{caption}</figcaption></figure>\n"
    )


def _provenance_html(made: Provenance) -> str:
    settings = ", ".join(f"{name} = {value}" for name, value in made.settings.items())
    seeds = ", ".join(f"{name} = {seed}" for name, seed in made.seeds.items())
    libraries = ", ".join(f"{name} {version}" for name, version in made.libraries.items())
    rows = {
        "Program": f"ana {made.version}, "
        + (made.commit.reason if isinstance(made.commit, Absent) else f"commit {made.commit}"),
        "Date": made.date,
        "Inputs": f"{len(made.inputs)} files (listed in provenance.json), SHA-256 {made.sha256}",
        "Settings": settings,
        "Seeds": seeds,
        "Libraries": libraries,
    }
    items = "".join(f"<dt>{name}</dt><dd>{escape(text)}</dd>" for name, text in rows.items())
    return f"<h2>Where this comes from</h2><dl>{items}</dl>\n"


def show_section(section: Section) -> Shown:
    """One section in a notebook."""
    sentences = "".join(f"<p>{html_of(sentence)}</p>" for sentence in section.sentences)
    figures = "".join(show(figure).html for figure in section.figures)
    tables = "".join(table.html() for table in section.tables)
    told = "\n".join(map(unmarked, section.sentences))
    html = f"<h2>{escape(section.title)}</h2>{sentences}{figures}{tables}"
    return Shown(html, f"{section.title}\n{told}")


def show_table(sections: Sequence[Section], name: str) -> Shown:
    """The table of this name in a notebook, or that it could not be computed. Raises KeyError
    where there is none."""
    for section in sections:
        for table in section.left_out:
            if table.name == name:
                told = f"{table.title}: not computed from these people."
                return Shown(f"<p>{escape(told)}</p>", told)
    found = next((one for one in tables_of(sections) if one.table.name == name), None)
    if found is None:
        raise KeyError(name)
    return Shown(found.html(), found.csv())
