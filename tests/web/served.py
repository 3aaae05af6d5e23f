"""Real servers, as processes of their own, and what they run."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Self

import click
import msgspec
import psutil

from game.commands.ana_study_web import web_extra
from game.study.folder import Study
from game.study.lab.sshd import ID_VARIABLE
from game.study.links import LINK, study_key, token
from game.web.hosted import Limits
from tests.study.server import ANA

PATIENCE_S = 30.0


class Running:
    """A command that serves, until the `with` block ends."""

    def __init__(self, *command: str | Path, **env: str) -> None:
        self._command = command
        self._env = {**os.environ, "PYTHONUNBUFFERED": "1", **env}
        self.said: list[str] = []

    def __enter__(self) -> Self:
        self.process = subprocess.Popen(
            self._command,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            env=self._env,
            text=True,
            start_new_session=True,
        )
        threading.Thread(target=self._listen, daemon=True).start()
        until(lambda: self.address != "" or self.process.poll() is not None)
        if not self.address:
            raise RuntimeError("".join(self.said))
        return self

    def __exit__(self, *_: object) -> None:
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        self.process.wait(PATIENCE_S)

    def _listen(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.said.append(line)

    @property
    def address(self) -> str:
        """Where it is to be reached, ending in a slash."""
        found = re.search(r"https?://\S+/(?= )", "".join(self.said))
        return "" if found is None else found[0]

    @property
    def port(self) -> int:
        return int(self.address.rpartition(":")[2].rstrip("/"))


class Served(Running):
    """`ana study serve` for a study, on a free port; with `limits`, the same with others than the
    command's."""

    def __init__(self, study: Study, *options: str, limits: Limits | None = None) -> None:
        self.study = study
        command: Sequence[str | Path] = (ANA, "study", "serve", study.folder, "--port", "0")
        if limits is not None:
            told = msgspec.json.encode(limits).decode()
            command = (sys.executable, "-m", "tests.web.served", study.folder, told)
        super().__init__(*command, *options, SECRET_OF_THE_SERVER="hunter2")

    def ticket(self, participant: str, *, pilot: bool = False) -> str:
        """What a participant's link carries."""
        return token(study_key(self.study.folder), participant, pilot=pilot)

    def link(self, participant: str) -> str:
        return f"{self.address}?{LINK}={self.ticket(participant)}"

    def programs(self, participant: str = "") -> list[int]:
        """The processes that play a session of the study, or those of one participant."""
        folder = str(self.study.folder.resolve())
        return [
            process.pid
            for process in psutil.process_iter(["cmdline", "environ"])
            if {"login", folder} <= set(process.info["cmdline"] or ())
            and participant in ("", (process.info["environ"] or {}).get(ID_VARIABLE))
        ]


def until(ready: Callable[[], bool], seconds: float = PATIENCE_S) -> None:
    """Wait for something. Raises TimeoutError."""
    end = time.monotonic() + seconds
    while not ready():
        if time.monotonic() > end:
            raise TimeoutError
        time.sleep(0.02)


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.argument("limits")
def serve_within(folder: Path, limits: str) -> None:
    """Serve a study within limits given as JSON."""
    with web_extra():
        from game.web.doors import StudyDoor
        from game.web.serving import serve
    from game.study.folder import open_study

    within = msgspec.json.decode(limits, type=Limits)
    serve(
        StudyDoor(open_study(folder)),
        "127.0.0.1",
        0,
        limits=within,
        ready=lambda address: click.echo(f"participants come to {address} "),
    )


if __name__ == "__main__":
    serve_within()
