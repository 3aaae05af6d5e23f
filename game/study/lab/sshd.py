"""Letting participants in over SSH: the OpenSSH configuration, and who has logged in.

One account serves all participants. Whatever a client asks for, the server runs only
`ana study login DIR`. The participant's ID comes from the key used to log in
(`environment="ANA_PARTICIPANT=P01"` in authorized_keys); if the key has none, it is asked for.
"""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from game.study.folder import StudyError, identify

ID_VARIABLE = "ANA_PARTICIPANT"
"""Set by the server from authorized_keys; a client cannot send it."""

ATTEMPTS = 3

HOST_KEY, AUTHORIZED_KEYS, PID_FILE = "host_key", "authorized_keys", "sshd.pid"


@dataclass(frozen=True)
class LoopbackServer:
    """A test server on this machine's loopback, which needs no special rights.

    `keys` is a folder with `host_key` and `authorized_keys`.
    """

    port: int
    keys: Path


def program() -> Path:
    """The full path of the running `ana`. Raises StudyError if it is not installed."""
    path = Path(sys.executable).with_name("ana")
    if not path.exists():
        raise StudyError(
            "the program ana is not installed here", place=str(path), hint="Install it with pip"
        )
    return path


def configuration(
    study: Path, account: str, ana: Path, loopback: LoopbackServer | None = None
) -> str:
    """The commented configuration: a file for /etc/ssh/sshd_config.d, or a complete test server."""
    folder = study.resolve()
    head = _SYSTEM.format(account=account, file=f"ana-{account}.conf", variable=ID_VARIABLE)
    if loopback is not None:
        keys = loopback.keys.resolve()
        head = _LOOPBACK.format(
            port=loopback.port,
            keys=keys,
            host_key=_quoted(keys / HOST_KEY),
            authorized_keys=_quoted(keys / AUTHORIZED_KEYS),
            pid_file=_quoted(keys / PID_FILE),
            variable=ID_VARIABLE,
        )
    command = f"exec {shlex.quote(str(ana))} study login {shlex.quote(str(folder))}"
    return head + _MATCH.format(account=account, command=command, variable=ID_VARIABLE)


def who_logs_in(env: Mapping[str, str], ask: Callable[[str], str]) -> str:
    """The ID of the person who logged in: the key's, or else the one they type.

    `ask` gets the previous, invalid answer. Raises StudyError if the key's ID is not a pseudonym,
    or if no ID was given in `ATTEMPTS` attempts.
    """
    named = env.get(ID_VARIABLE)
    if named is not None:
        return identify(named).participant
    answer = ""
    for _ in range(ATTEMPTS):
        answer = ask(answer).strip()
        with suppress(StudyError):
            return identify(answer).participant
    raise StudyError("no participant ID was given", hint="Log in again")


def _quoted(path: Path) -> str:
    """A path as one argument of sshd_config."""
    return f'"{path}"'


_SYSTEM = """\
# Participants log in as '{account}' and get the study, and nothing else.
#
#   ana study sshd DIR | sudo tee /etc/ssh/sshd_config.d/{file}
#   sudo sshd -t && sudo systemctl reload ssh
#
# Keys go into ~{account}/.ssh/authorized_keys, one per line. A key for one participant:
#   restrict,pty,environment="{variable}=P01" ssh-ed25519 AAAA... P01
# A key for a shared machine, where participants type their ID:
#   restrict,pty ssh-ed25519 AAAA... laboratory

# Lets a line of authorized_keys set this one variable. The setting covers all accounts, but does
# nothing for those that do not use it.
PermitUserEnvironment {variable}

# For a class that logs in all at once: by default sshd refuses some logins beyond the tenth.
MaxStartups 60:30:120

"""

_LOOPBACK = """\
# A test server on this machine's loopback, for trying the study. First make its keys:
#
#   mkdir -m 700 {keys}
#   ssh-keygen -q -t ed25519 -N '' -f {keys}/host_key
#   ssh-keygen -q -t ed25519 -N '' -f {keys}/participant
#   (printf 'restrict,pty,environment="{variable}=P01" '; cat {keys}/participant.pub) \\
#     > {keys}/authorized_keys
#
# Save this as {keys}/sshd_config. Then run, in two terminals:
#
#   /usr/sbin/sshd -D -e -f {keys}/sshd_config
#   ssh -p {port} -i {keys}/participant -o SendEnv=COLORTERM localhost
ListenAddress 127.0.0.1
Port {port}
HostKey {host_key}
AuthorizedKeysFile {authorized_keys}
PidFile {pid_file}
UsePAM no
StrictModes no

# Lets a line of authorized_keys set this one variable.
PermitUserEnvironment {variable}

"""

_MATCH = """\
Match User {account}
    # The only program that runs for this account: a client's commands, scp, sftp and rsync are
    # ignored. 'exec' leaves no shell behind the program.
    ForceCommand {command}

    # A key, not a password. To use a password instead, replace this line with
    # 'AuthenticationMethods password' and 'PasswordAuthentication yes'.
    AuthenticationMethods publickey

    # A terminal and nothing else: no port, socket, X11 or agent forwarding, no tunnels, no
    # ~/.ssh/rc, no second session over the same connection.
    PermitTTY yes
    DisableForwarding yes
    PermitTunnel no
    PermitUserRC no
    MaxSessions 1

    # Bad connections: a client that does not answer for 3 x 15 s is disconnected. Its session is
    # saved and continues at the next login.
    ClientAliveInterval 15
    ClientAliveCountMax 3

    # Accept the terminal's colours and language from the client, and no other variables. (TERM is
    # always accepted.)
    AcceptEnv COLORTERM LANG LC_*
"""
