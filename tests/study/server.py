"""A real OpenSSH server on the loopback, with the configuration that `ana study sshd` prints."""

from __future__ import annotations

import getpass
import os
import shutil
import socket
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Self

from tests.terminal import Terminal

ANA = Path(sys.executable).with_name("ana")
SSHD = shutil.which("sshd", path=f"{os.environ.get('PATH', '')}:/usr/sbin:/usr/local/sbin")
SSH = shutil.which("ssh")
BY_KEY = 'restrict,pty,environment="ANA_PARTICIPANT={}"'
"""The options in authorized_keys for one participant's key."""


class Server:
    """Use as a context manager. `keys` are names of key pairs; `options` go in front of a key in
    authorized_keys."""

    def __init__(self, study: Path, folder: Path, options: dict[str, str]) -> None:
        self.folder = folder
        self.port = _free_port()
        folder.mkdir(mode=0o700)
        for name in ("host_key", *options):
            key = ("-q", "-t", "ed25519", "-N", "", "-f", str(folder / name))
            subprocess.run(["ssh-keygen", *key], check=True)
        lines = [f"{said} {(folder / f'{name}.pub').read_text()}" for name, said in options.items()]
        (folder / "authorized_keys").write_text("".join(lines))
        asked = (str(study), "--port", str(self.port), "--keys", str(folder), "--no-check")
        printed = subprocess.run(
            [ANA, "study", "sshd", *asked], check=True, capture_output=True, text=True
        )
        self.configuration = folder / "sshd_config"
        self.configuration.write_text(printed.stdout)

    def __enter__(self) -> Self:
        assert SSHD is not None
        if os.geteuid() == 0:
            Path("/run/sshd").mkdir(exist_ok=True)
        arguments = ("-D", "-e", "-f", str(self.configuration))
        self.log = (self.folder / "log").open("wb")
        self.process = subprocess.Popen([SSHD, *arguments], stderr=self.log)
        until = time.monotonic() + 10
        while True:
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", self.port)) == 0:
                    return self
            if self.process.poll() is not None or time.monotonic() > until:
                raise RuntimeError((self.folder / "log").read_text())
            time.sleep(0.02)

    def __exit__(self, *_: object) -> None:
        self.process.terminate()
        self.process.wait(10)
        self.log.close()

    def ssh(self, key: str, *arguments: str, options: Sequence[str] = ()) -> list[str]:
        """The command line of a client that logs in with `key`."""
        assert SSH is not None
        settings = (
            "IdentitiesOnly=yes",
            "StrictHostKeyChecking=no",
            f"UserKnownHostsFile={self.folder / 'known_hosts'}",
            "LogLevel=ERROR",
            "SendEnv=COLORTERM",
            *options,
        )
        told = [part for setting in settings for part in ("-o", setting)]
        where = ("-F", "none", "-p", str(self.port), "-i", str(self.folder / key))
        return [SSH, *where, *told, f"{getpass.getuser()}@127.0.0.1", *arguments]

    def effective(self) -> dict[str, str]:
        """The settings that apply to a participant, as reported by the server."""
        assert SSHD is not None
        who = f"user={getpass.getuser()},host=localhost,addr=127.0.0.1"
        arguments = ("-T", "-f", str(self.configuration), "-C", who)
        told = subprocess.run([SSHD, *arguments], check=True, capture_output=True, text=True)
        settings: dict[str, str] = {}
        for line in told.stdout.splitlines():
            name, _, value = line.partition(" ")
            settings[name] = f"{settings[name]} {value}" if name in settings else value
        return settings


def login(server: Server, key: str, *arguments: str, **env: str) -> Terminal:
    """A client that logs in with `key`, in a window of the study's size."""
    return Terminal(server.ssh(key, *arguments), columns=120, rows=40, env=env)


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port
