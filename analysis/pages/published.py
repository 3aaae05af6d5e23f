"""The paper's printed numbers (analysis/paper), recomputed from its printed F.

With one within factor of two levels Wilks' lambda is 1/(1 + F df1/df2), so lambda, p and partial
eta squared follow from F and its degrees of freedom, and the printed ones can be checked.
"""

from pathlib import Path

import pandas as pd
from scipy import stats

from analysis.sources.absent import SourceError

#: The folder of the printed numbers; data/paper in the repository is a link to it.
PUBLISHED = Path(__file__).resolve().parents[1] / "paper"
ANOVA_FILE = "anova.csv"
POSTHOC_FILE = "posthoc.csv"
STUDY_FILE = "study.csv"


#: Printed numbers stay text, because their last digit says how they were rounded.
AS_PRINTED = {"value": str, "F": str, "lambda_read": str, "p_printed": str, "eta_printed": str}


def printed(folder: Path, name: str) -> pd.DataFrame:
    """One table of printed numbers. Raises SourceError where the file is not there."""
    path = folder / name
    if not path.is_file():
        raise SourceError(f"{path}: there is no such table of printed numbers")
    return pd.read_csv(path, dtype=AS_PRINTED)


def recomputed_anova(folder: Path) -> pd.DataFrame:
    """The printed ANOVA lines with lambda, p and partial eta squared recomputed from F.

    `agrees` says whether every printed number can be the rounded value of what some F that rounds
    to the printed F gives. `lambda_read` is the printed lambda with its lost point restored.
    """
    table = printed(folder, ANOVA_FILE)
    rows = [
        _recompute(
            line["F"],
            line["df1"],
            line["df2"],
            (line["lambda_read"], line["p_printed"], line["eta_printed"]),
        )
        for line in table.to_dict("records")
    ]
    return table.join(pd.DataFrame(rows, index=table.index)).assign(F=table["F"].astype(float))


def from_f(f: float, df1: int, df2: int) -> tuple[float, float, float]:
    """Wilks' lambda, p and partial eta squared of one within effect."""
    ratio = f * df1 / df2
    return 1 / (1 + ratio), float(stats.f.sf(f, df1, df2)), ratio / (1 + ratio)


def _recompute(
    f_text: str, df1: int, df2: int, read: tuple[object, ...]
) -> dict[str, float | bool]:
    f, slack = float(f_text), half_unit(f_text)
    ends = [from_f(max(0.0, f + step), df1, df2) for step in (-slack, slack)]
    agrees = all(
        min(bounds) - half_unit(text) <= float(text) <= max(bounds) + half_unit(text)
        for text, *bounds in zip(read, *ends, strict=True)
        if isinstance(text, str)
    )
    lambda_, p, eta = from_f(f, df1, df2)
    return {
        "lambda_recomputed": lambda_,
        "p_recomputed": p,
        "eta_recomputed": eta,
        "agrees": agrees,
    }


def half_unit(text: str) -> float:
    """Half a unit of the last printed digit: 0.0005 for "0.164"."""
    return 0.5 * 10.0 ** -len(text.partition(".")[2])
