"""The optional Bayesian mixed models: beside REML, and refused by name without their packages."""

import importlib.util
from pathlib import Path
from typing import Any

import pytest

from analysis.battery import analyse_source
from analysis.sources.frames import StudyData
from analysis.stats import bayes
from analysis.stats.bayes import MissingExtraError, bayes_model, need_bayes
from analysis.stats.mixed import mixed_model

HERE = importlib.util.find_spec("bambi") is not None


def test_without_the_extra_it_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(bayes, "find_spec", lambda name: None)
    with pytest.raises(MissingExtraError, match=r"pip install 'ana\[bayes\]'"):
        analyse_source(tmp_path / "not even read", bayes=True)


@pytest.mark.skipif(not HERE, reason="the extra `bayes` is not installed")
def test_weak_priors_give_what_reml_gives(
    study: StudyData, monkeypatch: pytest.MonkeyPatch
) -> None:
    need_bayes()
    monkeypatch.setattr(bayes, "CHAINS", 2)
    monkeypatch.setattr(bayes, "DRAWS", 500)
    ours: Any = bayes_model(study, "engagement", alpha=0.2)
    theirs: Any = mixed_model(study, "engagement")
    assert ours["draws"] == 1000 and ours["n_rows"] == theirs["n_rows"]
    for one, other in zip(ours["fixef"], theirs["fixef"], strict=True):
        assert one["term"] == other["term"]
        assert one["mean"] == pytest.approx(other["est"], abs=0.35 * other["se"])
        assert one["lower"] < one["mean"] < one["upper"]
    assert ours["sd_resid"]["mean"] ** 2 == pytest.approx(theirs["var_resid"], rel=0.25)
