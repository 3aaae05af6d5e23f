"""The exclusion rules, which are data: `analysis/exclusions.toml`."""

from __future__ import annotations

import tomllib
from collections.abc import Collection
from pathlib import Path

import msgspec

from game.errors import AnaError
from game.tables.asked import FAILED

RULES_FILE = Path(__file__).parents[2] / "analysis" / "exclusions.toml"


class ExclusionRule(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Excludes participants with more than `more_than` in `column` of the participants table, and
    whoever one of `others` excludes."""

    name: str
    words: str
    source: str
    column: str
    more_than: int
    others: tuple[ExclusionRule, ...] = ()

    def excludes(self, count: float | None) -> bool:
        """Whether a participant with this count is excluded; a missing count excludes nobody."""
        return count is not None and count > self.more_than


class ExclusionRules(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """All rules, and which of them, or which several together, make the analysed sample."""

    primary: str | tuple[str, ...]
    rule: tuple[ExclusionRule, ...]

    def __post_init__(self) -> None:
        names = [rule.name for rule in self.rule]
        for name in self._primary or ("",):
            if name not in names:
                raise ValueError(
                    f"primary is {name!r}; it must name one of the rules: {', '.join(names)}"
                )

    @property
    def _primary(self) -> tuple[str, ...]:
        return (self.primary,) if isinstance(self.primary, str) else self.primary

    def main(self) -> ExclusionRule:
        """The rule of the main results."""
        first, *others = (rule for rule in self.rule if rule.name in self._primary)
        if not others:
            return first
        return msgspec.structs.replace(
            first,
            name=" or ".join(rule.name for rule in (first, *others)),
            words=" ".join(rule.words for rule in (first, *others)),
            others=tuple(others),
        )

    def known_to(self, columns: Collection[str]) -> ExclusionRules:
        """Without the rules about attention checks where there are none to fail."""
        kept = tuple(it for it in self.rule if it.column != FAILED or it.column in columns)
        names = [rule.name for rule in kept]
        primary = tuple(name for name in self._primary if name in names) or tuple(names[:1])
        return ExclusionRules(primary[0] if len(primary) == 1 else primary, kept)


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
