"""`ana study serve` and `ana study invite`: taking part in a browser."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import click

from game.errors import AnaError

_HERE = "http://localhost:8080/"
_ONLY_HERE = (
    f"note: these links go to {_HERE}, where `ana study serve` listens if nothing else is said. "
    "Give another address with --url"
)
_BARE = """\
  note: other computers can reach this, and links, keys and answers can be read on the way. For
  anything but a closed network put a proxy with TLS before it (docs/lab.md), and give its --url"""


@contextmanager
def web_extra() -> Iterator[None]:
    """Within, what only the extra `web` brings is imported. Raises AnaError where it is missing."""
    try:
        yield
    except ModuleNotFoundError as error:
        raise AnaError(
            f"this needs the package {error.name}, which is not installed",
            hint="In the folder with the source: pip install --require-hashes "
            "--requirement requirements/web.txt",
        ) from error


def serve_study(folder: Path, host: str, port: int, url: str | None, sessions: int) -> None:
    """Serve the study in `folder`; see `ana study serve --help`."""
    with web_extra():
        from game.web.doors import StudyDoor
        from game.web.hosted import Limits
        from game.web.serving import is_loopback, serve
    from game.study.folder import open_study
    from game.study.links import checked_address

    study = open_study(folder)
    panel = study.settings.web.panel_id
    bare = not is_loopback(host) and not (url or "").startswith("https:")

    def ready(address: str) -> None:
        click.echo(f"{folder}: participants come to {address} (Ctrl+C ends this)")
        click.echo(f"  links: ana study invite {folder} P01 P02 ... --url {address}")
        if bare:
            click.echo(_BARE, err=True)
        if panel:
            click.echo(f"  panel: {address}?{panel}=ID (panel_id in study.toml)")

    serve(
        StudyDoor(study),
        host,
        port,
        url=checked_address(url) if url else "",
        limits=Limits(sessions=sessions),
        ready=ready,
    )


def print_links(
    folder: Path, participants: tuple[str, ...], url: str | None, *, pilot: bool, panel: bool
) -> None:
    """Print a link for each participant; see `ana study invite --help`. Nothing is printed where
    one of them is no ID, or is not on the roster."""
    from game.study.folder import admit_by_roster, identify, open_study
    from game.study.links import LINK, checked_address, panel_pseudonym, study_key, token

    study, address = open_study(folder), checked_address(url or _HERE)
    key = study_key(study.folder)
    hashed = panel and study.settings.web.hash_ids
    names = [panel_pseudonym(key, it) if hashed else it for it in participants]
    for name in names:
        admit_by_roster(study.folder, identify(name, pilot=pilot))
    for name in names:
        click.echo(f"{name}\t{address}?{LINK}={token(key, name, pilot=pilot)}")
    if url is None:
        click.echo(_ONLY_HERE, err=True)
