"""Letting participants in over SSH: the configuration of OpenSSH, and who has logged in.

One account serves all participants. Whatever a client asks for, the server runs
`ana study login DIR` and nothing else. The participant's ID comes from the key that was used
(`environment="ANA_PARTICIPANT=P01"` in authorized_keys) or, where the key names none, is asked.
"""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from game.study.folder import StudyError, identify

VARIABLE = "ANA_PARTICIPANT"
"""Set by the server from authorized_keys; no client can send it."""

ATTEMPTS = 3

HOST_KEY, AUTHORIZED_KEYS, PID_FILE = "host_key", "authorized_keys", "sshd.pid"


@dataclass(frozen=True)
class LoopbackServer:
    """A server of one's own on the loopback, to try a study with: no rights are needed.

    `keys` is a folder with `host_key` and `authorized_keys`.
    """

    port: int
    keys: Path


def program() -> Path:
    """The `ana` that runs now, by its whole path. Raises StudyError where it is not installed."""
    path = Path(sys.executable).with_name("ana")
    if not path.exists():
        raise StudyError(
            "ana is not installed as a program", place=str(path), mend="Install it with pip"
        )
    return path


def configuration(
    study: Path, account: str, ana: Path, loopback: LoopbackServer | None = None
) -> str:
    """The commented configuration: a file for /etc/ssh/sshd_config.d, or a whole test server's."""
    folder = study.resolve()
    head = _SYSTEM.format(account=account, file=f"ana-{account}.conf", variable=VARIABLE)
    if loopback is not None:
        keys = loopback.keys.resolve()
        head = _LOOPBACK.format(
            port=loopback.port,
            keys=keys,
            host_key=_quoted(keys / HOST_KEY),
            authorized_keys=_quoted(keys / AUTHORIZED_KEYS),
            pid_file=_quoted(keys / PID_FILE),
            variable=VARIABLE,
        )
    command = f"exec {shlex.quote(str(ana))} study login {shlex.quote(str(folder))}"
    return head + _MATCH.format(account=account, command=command, variable=VARIABLE)


def who_logs_in(env: Mapping[str, str], ask: Callable[[str], str]) -> str:
    """The ID of who has logged in: that of the key, else the one asked for.

    `ask` gets the answer before, which could not be an ID. Raises StudyError when the key's ID is
    no pseudonym, or none was given in `ATTEMPTS` attempts.
    """
    named = env.get(VARIABLE)
    if named is not None:
        return identify(named).participant
    answer = ""
    for _ in range(ATTEMPTS):
        answer = ask(answer).strip()
        with suppress(StudyError):
            return identify(answer).participant
    raise StudyError("no participant ID was given", mend="Log in again")


def _quoted(path: Path) -> str:
    """A path as one argument of sshd_config."""
    return f'"{path}"'


_SYSTEM = """\
# Participants of a study log in as '{account}' and find themselves in the study, and nowhere else.
#
#   ana study sshd DIR | sudo tee /etc/ssh/sshd_config.d/{file}
#   sudo sshd -t && sudo systemctl reload ssh
#
# Keys stand in ~{account}/.ssh/authorized_keys, one line a key. A key for one participant:
#   restrict,pty,environment="{variable}=P01" ssh-ed25519 AAAA... P01
# A key for a shared machine, where each participant types the ID:
#   restrict,pty ssh-ed25519 AAAA... laboratory

# Lets a line of authorized_keys set this one variable. It holds for all accounts, and does nothing
# for those that do not use it.
PermitUserEnvironment {variable}

# A class that logs in all at once: sshd otherwise turns some away from the tenth on.
MaxStartups 60:30:120

"""

_LOOPBACK = """\
# A server of your own on this machine's loopback, to try the study with. Make its keys first:
#
#   mkdir -m 700 {keys}
#   ssh-keygen -q -t ed25519 -N '' -f {keys}/host_key
#   ssh-keygen -q -t ed25519 -N '' -f {keys}/participant
#   (printf 'restrict,pty,environment="{variable}=P01" '; cat {keys}/participant.pub) \\
#     > {keys}/authorized_keys
#
# Save this as {keys}/sshd_config, then, in two terminals:
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
    # The only thing that ever runs here. Commands, scp, sftp and rsync a client asks for are not
    # carried out. 'exec' leaves no shell behind the program.
    ForceCommand {command}

    # A key, not a password. For a password typed at each login, take this line out and put
    # 'AuthenticationMethods password' and 'PasswordAuthentication yes' in its place.
    AuthenticationMethods publickey

    # A terminal, and nothing else: no forwarding of ports, sockets, X11 or agents, no tunnels, no
    # ~/.ssh/rc, no second session through the same connection.
    PermitTTY yes
    DisableForwarding yes
    PermitTunnel no
    PermitUserRC no
    MaxSessions 1

    # Bad links: a client that does not answer for 3 x 15 s is gone. Its session is saved, and goes
    # on at the next login.
    ClientAliveInterval 15
    ClientAliveCountMax 3

    # How many colours the participant's terminal has, and the language. Nothing else of the
    # client's environment comes in. (TERM always does.)
    AcceptEnv COLORTERM LANG LC_*
"""
