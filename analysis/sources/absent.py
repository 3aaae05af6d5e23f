"""Numbers that are not there, and why: every null of the written results carries a reason."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import ParamSpec, TypeAlias, TypeVar

from game.errors import AnaError


@dataclass(frozen=True, slots=True)
class Absent:
    """A value that cannot be given, with the reason in words."""

    reason: str


class Refusal(ValueError):
    """Raised where the data cannot support a statistic; the message names the cause."""


class SourceError(AnaError):
    """Raised where a source cannot be read; the message names the place and a hint."""


Leaf: TypeAlias = str | int | float | bool | Absent
Tree: TypeAlias = "Leaf | Mapping[str, Tree] | Sequence[Tree]"
Row: TypeAlias = dict[str, Tree]
Plain: TypeAlias = "str | int | float | bool | None | dict[str, Plain] | list[Plain]"

P = ParamSpec("P")
T = TypeVar("T")


def attempt(make: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T | Absent:
    """The value of `make` for these arguments, or an `Absent` with the reason of its `Refusal`."""
    try:
        return make(*args, **kwargs)
    except Refusal as refusal:
        return Absent(str(refusal))


def plain(tree: Tree, path: str = "") -> tuple[Plain, dict[str, str]]:
    """A JSON value of `tree`, and the reason of each null by its dotted path.

    Raises ValueError, naming the path, for a number that is not finite: a NaN must have been
    turned into an `Absent` where its cause was known.
    """
    reasons: dict[str, str] = {}

    def visit(node: Tree, at: str) -> Plain:
        if isinstance(node, Absent):
            reasons[at] = node.reason
            return None
        if isinstance(node, str | bool | int):
            return node
        if isinstance(node, float):
            if not math.isfinite(node):
                raise ValueError(f"{at}: {node} has no reason beside it")
            return float(node)
        if isinstance(node, Mapping):
            return {key: visit(value, f"{at}.{key}" if at else key) for key, value in node.items()}
        return [visit(value, f"{at}[{index}]") for index, value in enumerate(node)]

    return visit(tree, path), reasons
