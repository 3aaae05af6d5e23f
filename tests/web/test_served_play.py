"""`ana serve`: free play in a browser on this computer."""

from __future__ import annotations

import socket
import subprocess
from collections.abc import Iterator

import psutil
import pytest

from tests.study.server import ANA
from tests.web.client import WebTerminal, get
from tests.web.pages import told_by
from tests.web.served import Running


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    home = str(tmp_path_factory.mktemp("home"))
    with Running(ANA, "serve", "--port", "0", "--no-browser", HOME=home) as server:
        yield server


def enter(server: Running, tab: str) -> WebTerminal:
    status, page, _ = get(server.address)
    assert status == 200
    return WebTerminal(server.address, told_by(page)["ticket"], tab=tab)


def test_each_window_plays_by_itself_until_it_is_left(served: Running) -> None:
    with enter(served, "abcdefgh") as first, enter(served, "other123") as second:
        first.wait_for("Enter")
        second.wait_for("Enter")
        first.press("enter")
        first.wait_for("The clock has not started")
        assert "The clock has not started" not in second.text()
        second.press("q")
        assert second.wait(20) == 0


def test_only_this_computer_can_reach_it(served: Running) -> None:
    assert served.address.startswith("http://localhost:")
    assert "Ctrl+C ends this" in "".join(served.said)
    listening = psutil.Process(served.process.pid).net_connections("inet")
    assert {it.laddr.ip for it in listening} == {"127.0.0.1"}


def test_a_port_in_use_is_named(served: Running) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        refused = subprocess.run([ANA, "serve", "--port", port], capture_output=True, text=True)
    assert refused.returncode == 2
    assert f"127.0.0.1, port {port}" in refused.stderr
