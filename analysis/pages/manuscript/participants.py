"""Who took part and who was left out: section 5.4, paragraph 1."""

import pandas as pd

from analysis.pages.apa_table import ApaTable
from analysis.pages.manuscript.part import Found, Part
from analysis.sources.factors import COMPLEXITY
from analysis.stats.apa import DASH
from game.tables.exclusions import read_rules


def participants(found: Found) -> Part:
    """Who took part and who was left out (section 5.4, paragraph 1)."""
    everybody, kept = found.randomised.participants, found.study.participants

    def count(table: pd.DataFrame, column: str, value: str) -> str:
        if column not in table.columns or not table[column].notna().any():
            return DASH
        return str(int((table[column] == value).sum()))

    left = len(everybody) - len(kept)
    with_group = found.numbers["source"]["n_grouped"]
    rows = [
        ("Participants randomised", str(len(everybody)), found.printed("participants recruited")),
        ("Adaptive instructor first, randomised", count(everybody, "order", "adaptive_first"),
         found.printed("adaptive first")),
        ("Static instructor first, randomised", count(everybody, "order", "static_first"),
         found.printed("static first")),
        *((f"Static level {level}, randomised", count(everybody, "complexity", level),
           found.printed("participants per static level")) for level in COMPLEXITY),
        ("Left out", str(left), "8"),
        ("Adaptive instructor first, analysed", count(kept, "order", "adaptive_first"),
         found.printed("adaptive first analysed")),
        ("Static instructor first, analysed", count(kept, "order", "static_first"),
         found.printed("static first analysed")),
        ("Participants analysed", str(len(kept)), "100"),
        ("With a knowledge group", DASH if with_group is None else str(with_group), DASH),
    ]  # fmt: skip
    rules = read_rules().known_to(list(everybody.columns))
    people = "participant" if len(everybody) == 1 else "participants"
    grouped = (
        "" if with_group in (None, len(kept)) else f", {with_group} of them with a knowledge group"
    )
    sentences = [
        f"Data were collected from {len(everybody)} {people}, of whom {left or 'none'} "
        f"{'were' if left > 1 else 'was'} left out ({rules.main().words.rstrip('.')}; the "
        f"paper: 8, who disobeyed more than five times), which left {len(kept)} (paper: 100)"
        f"{grouped}."
    ]
    table = ApaTable(
        "participants",
        "Participants, here and in the paper",
        ("Quantity", "Here", "Paper"),
        tuple(rows),
        "The paper's 100 analysed and 8 left out follow from its 48 and 52. Everybody randomised "
        "is analysed too, in the last section.",
    )
    return Part("Participants (section 5.4, paragraph 1)", sentences, [table], [])
