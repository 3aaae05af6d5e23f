"""What is wrong with a value in a TOML file, in words for whoever wrote it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import msgspec

NOT_UTF8 = "the file is not UTF-8 text"
SAVE_AS_UTF8 = "Save it again as UTF-8"
_KINDS = {
    "array": "a list in brackets",
    "object": "a table",
    "str": "text in quotes",
    "int": "a whole number",
    "float": "a number",
    "bool": "true or false",
    "null": "nothing",
}
_WRONG_KIND = re.compile(r"Expected `([\w |]+)`, got `(\w+)`")
_WRONG_LENGTH = re.compile(r"Expected `array` of (at least |at most |)length (\d+)(?:, got (\d+))?")
_MISSING = re.compile(r"Object missing required field `(\w+)`")
_UNKNOWN = re.compile(r"Object contains unknown field `(\w+)`")
_NONE_OF = re.compile(r"Invalid (?:enum )?value '?(.*?)'?$")
_STEP = re.compile(r"\.(\w+)|\[(\d+)\]")


def parted(error: str) -> tuple[str, str]:
    """A message of msgspec's without its path, and the path as msgspec writes it, as
    `$.mission.duration_ms`; the path is empty where it names none."""
    message, _, path = error.partition(" - at `")
    return message, path.rstrip("`")


def in_plain_words(message: str, what: str = "key") -> str:
    """A message of msgspec's as a person would put it; `what` is how a key is called there."""
    if (found := _WRONG_KIND.match(message)) is not None:
        wanted, given = found.groups()
        kinds = [_KINDS.get(kind.strip(), kind.strip()) for kind in wanted.split("|")]
        kinds = [kind for kind in kinds if kind != "nothing"]
        return f"this must be {' or '.join(kinds)}, not {_KINDS.get(given, given)}"
    if (found := _WRONG_LENGTH.match(message)) is not None:
        least, length, given = found.groups()
        there = f", not {given}" if given else ""
        return f"this must be a list of {least}{length}{there}"
    if (found := _MISSING.match(message)) is not None:
        return f"the {what} `{found[1]}` is missing"
    if (found := _UNKNOWN.match(message)) is not None:
        return f"there is no {what} `{found[1]}`"
    if (found := _NONE_OF.match(message)) is not None:
        return f"'{found[1]}' is none of the values that are allowed"
    return message


def refused(message: str) -> str:
    """The value that a message of msgspec's says is none of those allowed; else empty."""
    found = _NONE_OF.match(message)
    return found[1] if found is not None else ""


def allowed(kind: type, path: str) -> tuple[str, ...]:
    """What can stand at `path`, as msgspec writes it, in a file that is read as `kind`; empty where
    that is no choice of a few words."""
    here: msgspec.inspect.Type = msgspec.inspect.type_info(kind)
    for key, _ in _STEP.findall(path):
        if key and isinstance(here, msgspec.inspect.StructType | msgspec.inspect.DataclassType):
            here = next(field.type for field in here.fields if field.encode_name == key)
        elif isinstance(here, msgspec.inspect.VarTupleType):
            here = here.item_type
    values = here.values if isinstance(here, msgspec.inspect.LiteralType) else ()
    return tuple(map(str, values))


def listed(message: str, path: str, tree: Mapping[str, Any]) -> str:
    """The hint for one value where a list belongs: how it is written; empty for anything else."""
    if not message.startswith("Expected `array`, got"):
        return ""
    value: Any = tree
    for key, index in _STEP.findall(path):
        value = value[key] if key else value[int(index)]
    if isinstance(value, dict):
        return ""
    written = f'"{value}"' if isinstance(value, str) else str(value).lower()
    return f"Write [{written}]"
