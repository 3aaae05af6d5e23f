"""The planned analysis of a study is written from its settings alone."""

import io
import zipfile
from pathlib import Path

import pytest
from click.testing import CliRunner

from analysis.command import command
from analysis.pages.preregistration import planned
from analysis.sources.absent import SourceError
from game.study.folder import new_study
from game.tables.exclusions import read_rules


@pytest.fixture
def study(tmp_path: Path) -> Path:
    new_study(tmp_path / "study", 7, 3)
    return tmp_path / "study"


def test_the_plan_says_what_the_settings_say(study: Path) -> None:
    parts = planned(study / "study.toml", read_rules(), 0.01)
    text = "\n".join(line for part in parts for line in part.paragraphs)
    assert "72 participants" in text and "seed 7" in text and "1 min or 3 min" in text
    assert "engagement and victims" in text and "adjusted by Holm" in text
    assert "*α* = .01" in text and "99%" in text and "98%" in text
    assert read_rules().main().words in text
    assert [part.heading for part in parts][-1] == "Power"


@pytest.mark.parametrize("name", ["plan.md", "plan.docx"])
def test_it_is_written_without_data(
    study: Path, tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    out = tmp_path / name
    for source in (study, study / "study.toml"):
        run = CliRunner().invoke(command, [str(source), "--prereg", str(out)])
        assert run.exit_code == 0, run.output
        content = out.read_bytes()
        if name.endswith(".md"):
            text = content.decode()
        else:
            with zipfile.ZipFile(io.BytesIO(content)) as parts:
                text = parts.read("word/document.xml").decode()
        assert "Planned analysis" in text and "2023-11-14" in text and "SHA-256" in text


def test_other_files_and_settings_are_refused_by_name(study: Path, tmp_path: Path) -> None:
    run = CliRunner().invoke(command, [str(study), "--prereg", str(tmp_path / "plan.pdf")])
    assert isinstance(run.exception, SourceError) and ".md or .docx" in str(run.exception)
    run = CliRunner().invoke(command, [str(tmp_path), "--prereg", str(tmp_path / "plan.md")])
    assert isinstance(run.exception, SourceError) and "no study.toml" in str(run.exception)
    settings = study / "study.toml"
    settings.write_text(settings.read_text(encoding="utf-8").replace("blocks", "block_count"))
    with pytest.raises(SourceError, match="blocks"):
        planned(settings, read_rules(), 0.05)
