"""The sample that each exclusion rule leaves."""

from dataclasses import dataclass

from analysis.sources.frames import StudyData
from game.tables.exclusions import ExclusionRule


@dataclass(frozen=True)
class Sample:
    """The participants left by one rule, and those excluded."""

    study: StudyData
    excluded: tuple[str, ...]
    rule: ExclusionRule | None


def left_by(study: StudyData, rule: ExclusionRule | None) -> Sample:
    """The sample that a rule leaves; without a rule, all randomised.

    Where the rule's column is missing, it excludes nobody.
    """
    if rule is None or not study.has(rule.column):
        return Sample(study, (), rule)
    counts = study.participants[rule.column].dropna()
    excluded = tuple(str(who) for who, count in counts.items() if rule.excludes(count))
    return Sample(study.without(excluded), excluded, rule)
