"""Adjusting p-values inside one family of comparisons."""

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import TypeAlias

import numpy as np
from scipy import special, stats

from analysis.sources.absent import Absent
from analysis.sources.frames import Floats
from game.tables.designs import Correction

PValue: TypeAlias = float | Absent


def tukey(t: Floats, means: int, df: int) -> Floats:
    """p of the studentised range over `means` means for these t (Tukey-Kramer).

    With s the error's estimated over its true standard deviation, the distribution is
    E_s[k integral phi(z) (Phi(z) - Phi(z - q s))^(k-1) dz] at q = sqrt(2) |t|; Gauss-Legendre nodes
    take both integrals for all t at once (absolute error below 1e-9).
    """
    error = stats.chi(df, scale=df**-0.5)
    s, s_weights = _nodes(float(error.ppf(1e-15)), float(error.isf(1e-15)))
    z, z_weights = _nodes(-8.0, 8.0)
    span = np.sqrt(2) * np.abs(t)[:, None, None] * s[:, None]
    below = (special.ndtr(z) - special.ndtr(z - span)) ** (means - 1)
    inner = means * below @ (z_weights * np.exp(-(z**2) / 2) / np.sqrt(2 * np.pi))
    beyond: Floats = 1 - inner @ (s_weights * error.pdf(s))
    return np.clip(beyond, 0.0, 1.0)


#: Nodes of each of the two integrals.
NODES = 64


@lru_cache
def _legendre(number: int) -> tuple[Floats, Floats]:
    nodes, weights = np.polynomial.legendre.leggauss(number)
    return nodes, weights


def _nodes(lower: float, upper: float) -> tuple[Floats, Floats]:
    nodes, weights = _legendre(NODES)
    half = (upper - lower) / 2
    return lower + half * (nodes + 1), half * weights


def _holm(p: Floats) -> Floats:
    order = np.argsort(p, kind="stable")
    steps = np.maximum.accumulate(p[order] * np.arange(len(p), 0, -1))
    found = np.empty_like(p)
    found[order] = steps
    return found


METHODS: dict[str, Callable[[Floats], Floats]] = {
    "p_bonf": lambda p: p * len(p),
    "p_sidak": lambda p: -np.expm1(len(p) * np.log1p(-p)),
    "p_holm": _holm,
}
"""Bonferroni, Sidak and Holm (1979) over one family; `multipletests` of statsmodels gives the same,
but takes longer to import than an analysis takes."""


def adjusted(family: Sequence[PValue]) -> list[dict[str, PValue]]:
    """For each member: p_none, p_bonf, p_sidak, p_holm; the family is its p-values that exist."""
    known = np.array([p for p in family if not isinstance(p, Absent)], dtype=float)
    with np.errstate(divide="ignore"):
        by_method = {
            name: iter(np.minimum(correct(known), 1.0).tolist())
            for name, correct in METHODS.items()
        }
    return [
        {"p_none": p, **dict.fromkeys(METHODS, p)}
        if isinstance(p, Absent)
        else {"p_none": p, **{name: next(values) for name, values in by_method.items()}}
        for p in family
    ]


NAMES: dict[Correction, str] = {
    "none": "no correction",
    "bonferroni": "Bonferroni",
    "sidak": "Šidák",
    "holm": "Holm",
}
"""What the corrections of study.toml are called."""
COLUMNS: dict[Correction, str] = {
    "none": "p_none",
    "bonferroni": "p_bonf",
    "sidak": "p_sidak",
    "holm": "p_holm",
}


def corrected_by_name(
    family: Mapping[str, PValue], correction: Correction = "holm"
) -> dict[str, PValue]:
    """Adjusted p by name; an absent p stays absent and does not count."""
    return {
        name: row[COLUMNS[correction]]
        for name, row in zip(family, adjusted(list(family.values())), strict=True)
    }
