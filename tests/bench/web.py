"""What a key costs when many take part at once in browsers, and on bare terminals beside that."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Sequence
from contextlib import ExitStack, closing
from pathlib import Path

import websocket

from game.study.folder import Identity, Study
from game.study.lab.sshd import ID_VARIABLE
from tests.bench.screen import COLUMNS, ROWS
from tests.bench.together import (
    NAMES,
    SharedCosts,
    in_missions,
    long_study,
    up_to_the_mission,
    watch_for,
)
from tests.study.server import ANA
from tests.terminal import KEYS, Chunk, Terminal, Watched
from tests.web.served import Served


class _Line(Watched):
    """A websocket in a browser's place."""

    def __init__(self, server: Served, name: str) -> None:
        super().__init__(COLUMNS, ROWS)
        self._socket = websocket.create_connection(
            f"ws://127.0.0.1:{server.port}/line?tab=abcdefgh&ticket={server.ticket(name)}",
            origin=f"http://127.0.0.1:{server.port}",
        )

    def fileno(self) -> int:
        assert self._socket.sock is not None
        return self._socket.sock.fileno()

    def close(self) -> None:
        self._socket.close()

    def press(self, *keys: str) -> None:
        for key in keys:
            self._socket.send(f"k{KEYS.get(key, key)}")

    def take(self) -> bool:
        kind, data = self._socket.recv_data()
        if kind == websocket.ABNF.OPCODE_BINARY:
            self.chunks.append(Chunk(time.perf_counter(), data))
            if said := self.answer(data):
                self.press(said.decode())
        return bool(kind != websocket.ABNF.OPCODE_CLOSE)

    def read_for(self, seconds: float) -> bool:
        watch_for([self], seconds)
        return True


def in_browsers(
    keys: Sequence[str], *, ignored_rows: Sequence[int] = ()
) -> tuple[SharedCosts, SharedCosts]:
    """Let everybody press keys at the same time, each in a mission of a study: on bare terminals,
    and then over a server's websockets."""
    return _bare(keys, ignored_rows), _served(keys, ignored_rows)


def _bare(keys: Sequence[str], ignored_rows: Sequence[int]) -> SharedCosts:
    with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
        study = _up_to_the_missions(Path(folder) / "study")
        login = (ANA, "study", "login", study.folder)
        terminals = []
        for name in NAMES:
            env = {ID_VARIABLE: name, "COLORTERM": "truecolor"}
            terminal = Terminal(login, columns=COLUMNS, rows=ROWS, env=env)
            terminals.append(stack.enter_context(terminal))
        return in_missions(study, terminals, keys, ignored_rows=ignored_rows)


def _served(keys: Sequence[str], ignored_rows: Sequence[int]) -> SharedCosts:
    with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
        study = _up_to_the_missions(Path(folder) / "study")
        server = stack.enter_context(Served(study))
        lines = []
        for name in NAMES:
            line = _Line(server, name)
            lines.append(stack.enter_context(closing(line)))
        return in_missions(study, lines, keys, ignored_rows=ignored_rows)


def _up_to_the_missions(folder: Path) -> Study:
    study = long_study(folder)
    for name in NAMES:
        up_to_the_mission(study, Identity("live", name))
    return study
