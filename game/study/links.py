"""Links into a study: a pseudonym signed with the study's key, or a panel's ID made a pseudonym.

DIR/web.key holds the key: 32 bytes, readable by the study's owner alone. Whoever has it can make
links, and can tell which panel ID belongs to which pseudonym.
"""

from __future__ import annotations

import os
import re
from base64 import b32encode, urlsafe_b64encode
from collections.abc import Iterable
from contextlib import suppress
from hashlib import sha256
from hmac import compare_digest, new
from pathlib import Path
from secrets import token_bytes
from tempfile import NamedTemporaryFile

from game.errors import AnaError

KEY = "web.key"
LINK = "link"
"""The name of the token in an address."""
_KEY_BYTES, _SIGNATURE_BYTES, _HASH_BYTES = 32, 16, 10
_PANEL_ID = re.compile(r"[A-Za-z0-9_-]{1,64}")
_ADDRESS = re.compile(r"https?://([A-Za-z0-9.-]+|\[[0-9A-Fa-f:.]+\])(:[0-9]{1,5})?(/[^?#\s]*)?")
_PILOT = "pilot"


class LinkError(AnaError):
    """The study's key cannot be used, or a link is not one of this study's."""


def study_key(folder: Path) -> bytes:
    """The key of the study in `folder`, made when it is first needed.

    Raises LinkError where it cannot be read or made, or others may read it.
    """
    path = folder / KEY
    try:
        if not path.exists():
            _make(path)
        return _read(path)
    except OSError as error:
        raise LinkError(
            f"the key for links cannot be read or made ({error.strerror})",
            place=str(path),
            hint="Let the study's account write there",
        ) from error


def _make(path: Path) -> None:
    """Put a new key there, whole, unless someone else was faster."""
    with NamedTemporaryFile(dir=path.parent, prefix=f".{KEY}-") as file:
        file.write(token_bytes(_KEY_BYTES))
        file.flush()
        os.fsync(file.fileno())
        with suppress(FileExistsError):
            os.link(file.name, path)


def _read(path: Path) -> bytes:
    key = path.read_bytes()
    if path.stat().st_mode & 0o077:
        raise LinkError(
            "other accounts may read the key for links", place=str(path), hint=f"chmod 600 {path}"
        )
    if len(key) != _KEY_BYTES:
        raise LinkError(
            f"the key for links has {len(key)} bytes instead of {_KEY_BYTES}",
            place=str(path),
            hint="Restore it from a backup; a new key would make every link sent so far useless",
        )
    return key


def token(key: bytes, participant: str, *, pilot: bool = False) -> str:
    """What stands in a participant's link: their ID, and a signature."""
    parts = (participant, _PILOT) if pilot else (participant,)
    signature = _mac(key, "link", *parts)[:_SIGNATURE_BYTES]
    return ".".join((*parts, urlsafe_b64encode(signature).rstrip(b"=").decode()))


def of_token(key: bytes, text: str) -> tuple[str, bool]:
    """The participant's ID in a link, and whether it is for a pilot session.

    Raises LinkError for a token that was not made with this key.
    """
    participant, *rest = text.split(".")
    pilot = rest[:1] == [_PILOT]
    genuine = token(key, participant, pilot=pilot)
    if not compare_digest(_bytes(genuine), _bytes(text)):
        raise LinkError("this link was not made for this study")
    return participant, pilot


def panel_pseudonym(key: bytes, panel_id: str) -> str:
    """A pseudonym for a panel's ID, always the same, from which nobody without the key can tell
    the ID. Raises LinkError for what cannot be an ID."""
    if _PANEL_ID.fullmatch(panel_id) is None:
        raise LinkError("this is not a panel's ID")
    return "h" + b32encode(_mac(key, "panel", panel_id)[:_HASH_BYTES]).decode().lower()


def checked_address(address: str) -> str:
    """An address that people reach the server at, ending in a slash. Raises LinkError."""
    if _ADDRESS.fullmatch(address) is None:
        raise LinkError(
            f"'{address}' is not the address of a website",
            place="--url",
            hint="Give one such as https://study.example.org/",
        )
    return address if address.endswith("/") else f"{address}/"


def pseudonyms(folder: Path, panel_ids: Iterable[str]) -> frozenset[str]:
    """The pseudonyms of panel IDs; none where the study never had links."""
    if not (folder / KEY).exists():
        return frozenset()
    key = study_key(folder)
    return frozenset(panel_pseudonym(key, it) for it in panel_ids)


def _mac(key: bytes, *parts: str) -> bytes:
    return new(key, _bytes("\0".join(parts)), sha256).digest()


def _bytes(text: str) -> bytes:
    """UTF-8, also of half a character, as an address can hold it."""
    return text.encode(errors="surrogatepass")
