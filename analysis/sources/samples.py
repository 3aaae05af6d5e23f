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
    gone: set[str] = set()
    for one in () if rule is None else (rule, *rule.others):
        if study.has(one.column):
            counts = study.participants[one.column].dropna()
            gone |= {str(who) for who, count in counts.items() if one.excludes(count)}
    excluded = tuple(str(who) for who in study.participants.index if str(who) in gone)
    return Sample(study.without(excluded) if excluded else study, excluded, rule)
