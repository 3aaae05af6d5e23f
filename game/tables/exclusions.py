"""The exclusion rules, which are data: `analysis/exclusions.toml`."""

from __future__ import annotations

import tomllib
from pathlib import Path

import msgspec

from game.errors import AnaError

RULES_FILE = Path(__file__).parents[2] / "analysis" / "exclusions.toml"


class ExclusionRule(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Excludes participants with more than `more_than` in `column` of the participants table."""

    name: str
    words: str
    source: str
    column: str
    more_than: int

    def excludes(self, count: float | None) -> bool:
        """Whether a participant with this count is excluded; a missing count excludes nobody."""
        return count is not None and count > self.more_than


class ExclusionRules(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """All rules, and which of them makes the analysed sample."""

    primary: str
    rule: tuple[ExclusionRule, ...]

    def __post_init__(self) -> None:
        names = [rule.name for rule in self.rule]
        if self.primary not in names:
            raise ValueError(
                f"primary is {self.primary!r}; it must name one of the rules: {', '.join(names)}"
            )

    def main(self) -> ExclusionRule:
        """The rule of the main results."""
        return next(rule for rule in self.rule if rule.name == self.primary)


def read_rules(path: Path = RULES_FILE) -> ExclusionRules:
    """The rules in `path`. Raises AnaError, naming the file and what is wrong in it."""
    try:
        return msgspec.convert(tomllib.loads(path.read_text(encoding="utf-8")), ExclusionRules)
    except OSError as error:
        raise AnaError(
            f"the exclusion rules cannot be read ({error.strerror})", place=str(path)
        ) from error
    except (tomllib.TOMLDecodeError, msgspec.ValidationError) as error:
        raise AnaError(str(error), place=str(path)) from error
