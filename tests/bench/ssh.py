"""What a key costs when many take part at once over a real OpenSSH server on the loopback."""

from __future__ import annotations

import re
import shlex
import tempfile
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

from game.study.folder import Identity
from tests.bench.screen import COLUMNS, ROWS
from tests.bench.together import (
    BEFORE,
    NAMES,
    SharedCosts,
    in_missions,
    keys_at_once,
    long_study,
    up_to_the_mission,
    watch_for,
)
from tests.study.server import BY_KEY, Server
from tests.terminal import Terminal


def at_once(
    command: Sequence[str] | None, keys: Sequence[str], *, ignored_rows: Sequence[int] = ()
) -> SharedCosts:
    """Let everybody press keys at the same time, each in a mission of a study, or in `command` of a
    shell instead; `ignored_rows` hold a clock."""
    with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
        study = long_study(Path(folder) / "study")
        keyring = {name: BY_KEY.format(name) for name in NAMES}
        server = Server(study.folder, Path(folder) / "keys", keyring)
        if command is not None:
            _serve_instead(server.configuration, command)
        stack.enter_context(server)
        terminals: list[Terminal] = []
        for name in NAMES:
            if command is None:
                up_to_the_mission(study, Identity("live", name))
            login = Terminal(server.ssh(name), columns=COLUMNS, rows=ROWS)
            terminals.append(stack.enter_context(login))
            if command is None:
                login.wait_for(BEFORE)
            else:
                watch_for(terminals, 0.5)
        if command is not None:
            return keys_at_once(terminals, keys)
        return in_missions(study, terminals, keys, ignored_rows=ignored_rows)


def _serve_instead(configuration: Path, command: Sequence[str]) -> None:
    words = " ".join(word if word == "&&" else shlex.quote(word) for word in command)
    text = re.sub(
        r"^( *ForceCommand) .*$",
        lambda found: f"{found[1]} {words}",
        configuration.read_text(),
        flags=re.MULTILINE,
    )
    configuration.write_text(text)
