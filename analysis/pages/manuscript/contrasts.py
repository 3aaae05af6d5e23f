"""Comparisons of two means as cells of a table."""

from analysis.pages.manuscript.part import Numbers
from analysis.pages.sentences import interval
from analysis.stats.apa import decimal, p_value


def turned(row: Numbers) -> Numbers:
    """The same comparison the other way round."""

    def minus(value: float | None) -> float | None:
        return None if value is None else -value

    return {
        **row,
        "estimate": minus(row["estimate"]),
        "t.ratio": minus(row["t.ratio"]),
        "lower.CL": minus(row["upper.CL"]),
        "upper.CL": minus(row["lower.CL"]),
        "d": minus(row["d"]),
        "d.lower": minus(row["d.upper"]),
        "d.upper": minus(row["d.lower"]),
    }


def contrast_cells(row: Numbers) -> tuple[str, ...]:
    """Difference, interval, t, df, p, p by Holm, d and its interval."""
    return (
        decimal(row["estimate"]),
        interval(row["lower.CL"], row["upper.CL"]),
        decimal(row["t.ratio"]),
        str(row["df"]),
        p_value(row["p_none"]),
        p_value(row["p_holm"]),
        decimal(row["d"]),
        interval(row["d.lower"], row["d.upper"]),
    )
