"""Exclusion rules as data (`exclusions.toml`), and the sample that each of them leaves."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

import msgspec

from analysis.sources.absent import SourceError
from analysis.sources.frames import Study

RULES_FILE = Path(__file__).parents[1] / "exclusions.toml"


class Rule(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Leaves out who has more than `more_than` in `column` of the participants table."""

    name: str
    words: str
    source: str
    column: str
    more_than: int

    def excluded(self, study: Study) -> tuple[str, ...]:
        """The participants whom the rule leaves out; a missing count leaves nobody out."""
        if not study.has(self.column):
            return ()
        counts = study.participants[self.column]
        return tuple(str(who) for who in counts.index[counts > self.more_than])


class Rules(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """All rules, and which of them makes the analysed sample."""

    primary: str
    rule: tuple[Rule, ...]

    def main(self) -> Rule:
        """The rule of the main results."""
        return next(rule for rule in self.rule if rule.name == self.primary)


@dataclass(frozen=True)
class Sample:
    """The participants left by one rule, and those left out."""

    study: Study
    excluded: tuple[str, ...]
    rule: Rule | None


def load_rules(path: Path = RULES_FILE) -> Rules:
    """Read exclusion rules. Raises SourceError naming the file and what is wrong in it."""
    try:
        rules = msgspec.convert(tomllib.loads(path.read_text(encoding="utf-8")), Rules)
    except FileNotFoundError as error:
        raise SourceError(f"{path}: there is no such file of exclusion rules") from error
    except (tomllib.TOMLDecodeError, msgspec.ValidationError) as error:
        raise SourceError(f"{path.name}: {error}") from error
    names = [rule.name for rule in rules.rule]
    if rules.primary not in names:
        raise SourceError(
            f"{path.name}: primary is {rules.primary!r}; it must name one of the rules: "
            f"{', '.join(names)}"
        )
    return rules


def left_by(study: Study, rule: Rule | None) -> Sample:
    """The sample that a rule leaves; without a rule, all randomised."""
    if rule is None:
        return Sample(study, (), None)
    excluded = rule.excluded(study)
    return Sample(study.without(excluded), excluded, rule)
