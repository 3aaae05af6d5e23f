"""The server in this process, with small programs behind it."""

from __future__ import annotations

import asyncio
import json
import os
import re
import time
from contextlib import suppress

import psutil
import pytest
from aiohttp import ClientSession, WSMsgType

from game.web.hosted import MOST_MESSAGE_BYTES, Goodbye, Limits
from tests.web.echo import Echoes, echoes
from tests.web.pages import told_by

WINDOW = b"<120 x 40>"
QUICK = Limits(away_s=0.6, idle_s=60, send_s=0.5)


def alive(pid: int) -> bool:
    if not psutil.pid_exists(pid):
        return False
    return bool(psutil.Process(pid).status() != psutil.STATUS_ZOMBIE)


def pids(server: Echoes) -> list[int]:
    return [hosted.terminal.pid for hosted in server.room]


async def until_empty(server: Echoes, seconds: float = 20) -> None:
    async with asyncio.timeout(seconds):
        while len(server.room):
            await asyncio.sleep(0.02)


# --- pages --------------------------------------------------------------------------------------


async def test_the_page_loads_nothing_from_elsewhere_and_says_so() -> None:
    async with echoes() as server:
        answer = await server.client.get("/?link=P01")
        page = await answer.text()
        assert answer.status == 200
        assert told_by(page)["ticket"] == "P01"
        assert "<title>Echo &lt;&amp;&gt; study</title>" in page
        assert '<html lang="de">' in page
        names = re.findall(r'(?:src|href)="([^"]*)"', page)
        assert names
        for name in names:
            assert (await server.client.get(f"/{name}")).status == 200
        for name in ("textual.js", "font.ttf"):
            assert (await server.client.get(f"/static/{name}")).status == 200
        policy = answer.headers["Content-Security-Policy"]
        assert "default-src 'none'" in policy
        assert "frame-ancestors 'none'" in policy
        assert "script-src 'self';" in policy
        assert answer.headers["Referrer-Policy"] == "no-referrer"
        assert answer.headers["Cache-Control"] == "no-store"


async def test_what_a_page_is_made_of_is_fetched_once() -> None:
    async with echoes() as server:
        first = await server.client.get("/static/textual.js")
        known = {"If-None-Match": first.headers["ETag"]}
        again = await server.client.get("/static/textual.js", headers=known)
        assert (first.status, again.status) == (200, 304)
        assert again.headers["Cache-Control"] == "no-cache"
        changed = await server.client.get("/static/page.js", headers=known)
        assert changed.status == 200


async def test_a_ticket_cannot_break_out_of_the_page() -> None:
    async with echoes() as server:
        evil = "\"><script>alert('$title')</script>"
        page = await (await server.client.get("/", params={"link": evil})).text()
        assert "<script>alert" not in page
        assert told_by(page)["ticket"] == evil


async def test_nobody_without_a_link_gets_more_than_a_notice() -> None:
    async with echoes() as server:
        answer = await server.client.get("/?anything=else")
        page = await answer.text()
        assert answer.status == 403
        assert "This link does not work" in page
        assert not told_by(page)
        assert "Content-Security-Policy" in answer.headers


@pytest.mark.parametrize(
    "path",
    ["/static/", "/static", "/static/page.html", "/static/..%2fserver.py", "/static/../page.html",
     "/etc/passwd", "/static/%2e%2e/%2e%2e/etc/passwd", "/line/", "/%00", "/static/page.js%00"],
)  # fmt: skip
async def test_nothing_else_is_served(path: str) -> None:
    async with (
        echoes() as server,
        ClientSession() as session,
        session.get(f"{server.origin}{path}") as answer,
    ):
        assert answer.status in (403, 404), await answer.text()
        assert answer.headers["X-Content-Type-Options"] == "nosniff"


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "OPTIONS"])
async def test_nothing_can_be_sent_to_a_page(method: str) -> None:
    async with echoes() as server:
        answer = await server.client.request(method, "/?link=P01", data=b"x" * 100_000)
        assert answer.status == 405


@pytest.mark.parametrize("host", ["evil.example", "evil.example:80", "127.0.0.1.evil.example", ""])
@pytest.mark.parametrize("path", ["/?link=P01", "/static/page.js", "/line?ticket=P01&tab=abcdefgh"])
async def test_a_foreign_name_for_this_server_gets_nothing(host: str, path: str) -> None:
    async with echoes() as server:
        answer = await server.client.get(path, headers={"Host": host})
        assert answer.status == 421


# --- who gets a line ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    "origin",
    ["https://evil.example", "http://localhost", "null", "", "http://127.0.0.1:1",
     "http://evil.example@127.0.0.1:{port}", "http://[::1", "{origin}.evil.example"],
)  # fmt: skip
async def test_a_page_of_another_site_gets_no_line(origin: str) -> None:
    async with echoes() as server:
        port = server.origin.rpartition(":")[2]
        headers = {"Origin": origin.format(port=port, origin=server.origin)}
        assert await server.refused({"ticket": "P01", "tab": "abcdefgh"}, headers) == 403
        assert len(server.room) == 0


async def test_without_an_origin_there_is_no_line() -> None:
    async with echoes() as server:
        assert await server.refused({"ticket": "P01", "tab": "abcdefgh"}, {}) == 403


@pytest.mark.parametrize(
    "query",
    [{"ticket": "../P01", "tab": "abcdefgh"}, {"ticket": "", "tab": "abcdefgh"},
     {"tab": "abcdefgh"}, {"ticket": "P01"}, {"ticket": "P01", "tab": "a;b c$(id)"},
     {"ticket": "P01", "tab": "a" * 41}],
)  # fmt: skip
async def test_nobody_without_ticket_and_window_gets_a_line(query: dict[str, str]) -> None:
    async with echoes() as server:
        assert await server.refused(query, {"Origin": server.origin}) == 403
        assert len(server.room) == 0


# --- a line -------------------------------------------------------------------------------------


async def test_keys_go_in_and_output_comes_out_in_the_size_of_the_study() -> None:
    async with echoes() as server:
        visit = await server.visit()
        await visit.until(WINDOW)
        await visit.press("héllo ↑")
        await visit.until("héllo ↑".encode())
        await visit.socket.send_str("?")
        while "!" not in visit.told:
            await visit._take(20)


async def test_keys_keep_their_order_when_they_come_all_at_once() -> None:
    async with echoes() as server:
        visit = await server.visit()
        await visit.until(WINDOW)
        keys = [f"[{number}]" for number in range(150)]
        await asyncio.gather(*(visit.press(key) for key in keys))
        await visit.until("".join(keys).encode())


async def test_whoever_joins_late_is_told_the_modes_and_painted_on() -> None:
    async with echoes() as server:
        first = await server.visit()
        await first.until(WINDOW)
        second = await server.visit(tab="second12")
        await second.until(WINDOW)
        assert second.output.startswith(b"\x1bc\x1b[?1049h\x1b[?25l")
        assert await first.closed() == Goodbye.ELSEWHERE
        assert len(server.room) == 1
        await second.press("still")
        await second.until(b"still")


async def test_the_window_that_lost_types_nothing_more() -> None:
    async with echoes() as server:
        first = await server.visit()
        await first.until(WINDOW)
        second = await server.visit(tab="second12")
        await first.press("late")
        await first.socket.send_str("c")
        await second.press("mine")
        await second.until(b"mine")
        assert b"late" not in second.output
        assert b"<20 x 4>" not in second.output


async def test_the_page_may_have_it_covered_and_painted_again() -> None:
    async with echoes() as server:
        visit = await server.visit()
        await visit.until(WINDOW)
        await visit.socket.send_str("c")
        await visit.until(b"<20 x 4>")
        visit.output = b""
        await visit.socket.send_str("r")
        await visit.until(WINDOW)


@pytest.mark.parametrize("message", ["", "z", "kind of", "{}", '["stdin", "x"]', "r" * 3000])
async def test_unknown_messages_do_nothing(message: str) -> None:
    async with echoes() as server:
        visit = await server.visit()
        await visit.until(WINDOW)
        await visit.socket.send_str(message)
        await visit.press("on")
        await visit.until(b"on")


# --- the end ------------------------------------------------------------------------------------


async def test_the_page_is_told_how_it_ended() -> None:
    async with echoes() as server:
        visit = await server.visit()
        await visit.until(WINDOW)
        await visit.press("Q")
        assert await visit.closed() == Goodbye.ENDED
        told = {"status": 7, "code": "ABCD", "url": "https://panel.example/?cc=ABCD"}
        assert json.loads(visit.told[-1]) == told
        await until_empty(server)


async def test_a_program_that_is_killed_ends_the_line_at_once() -> None:
    async with echoes() as server:
        visit = await server.visit()
        await visit.until(WINDOW)
        (pid,) = pids(server)
        os.kill(pid, 9)
        assert await visit.closed(5) == Goodbye.ENDED
        assert json.loads(visit.told[-1])["status"] == -9


async def test_a_line_that_comes_back_in_time_finds_the_same_program() -> None:
    async with echoes(Limits(away_s=30)) as server:
        first = await server.visit()
        await first.until(WINDOW)
        (pid,) = pids(server)
        first.socket._response.connection.transport.abort()  # type: ignore[union-attr]
        async with asyncio.timeout(5):
            while any(hosted.line for hosted in server.room):
                await asyncio.sleep(0.01)
        second = await server.visit()
        await second.until(WINDOW)
        assert pids(server) == [pid]
        assert alive(pid)


async def test_a_line_that_stays_away_is_hung_up_and_the_next_one_starts_anew() -> None:
    async with echoes(QUICK) as server:
        first = await server.visit()
        await first.until(WINDOW)
        (pid,) = pids(server)
        await first.socket.close()
        await until_empty(server)
        assert not alive(pid)
        second = await server.visit()
        await second.until(WINDOW)
        assert pids(server) != [pid]


async def test_a_program_that_will_not_leave_is_killed() -> None:
    async with echoes(QUICK, "deaf") as server:
        first = await server.visit()
        await first.until(WINDOW)
        (pid,) = pids(server)
        await first.socket.close()
        await until_empty(server)
        assert not alive(pid)


async def test_whoever_comes_back_while_the_old_program_leaves_gets_a_new_one() -> None:
    async with echoes(QUICK, "deaf") as server:
        first = await server.visit()
        await first.until(WINDOW)
        (pid,) = pids(server)
        (hosted,) = server.room
        await first.socket.close()
        async with asyncio.timeout(10):
            while not hosted.leaving:
                await asyncio.sleep(0.01)
        assert alive(pid)
        second = await server.visit()
        await second.until(WINDOW)
        assert not alive(pid)


async def test_whoever_presses_nothing_for_long_is_let_go() -> None:
    async with echoes(Limits(idle_s=0.5, away_s=1)) as server:
        visit = await server.visit()
        assert await visit.closed() == Goodbye.IDLE
        await until_empty(server)


async def test_a_full_server_says_so_and_lets_the_same_visitor_back_in() -> None:
    async with echoes(Limits(sessions=2)) as server:
        for name in ("P01", "P02"):
            await (await server.visit(name)).until(WINDOW)
        assert await (await server.visit("P03")).closed() == Goodbye.FULL
        again = await server.visit("P01", tab="second12")
        await again.until(WINDOW)
        await again.press("Q")
        await again.closed()
        async with asyncio.timeout(10):
            while len(server.room) > 1:
                await asyncio.sleep(0.01)
        await (await server.visit("P03")).until(WINDOW)


async def test_closing_the_server_reaps_everything() -> None:
    async with echoes() as server:
        visits = [await server.visit(f"P{number}") for number in range(6)]
        for visit in visits:
            await visit.until(WINDOW)
        left = pids(server)
        assert len(left) == 6
        began = time.monotonic()
        closing = asyncio.create_task(server.room.close())
        assert [await visit.closed() for visit in visits] == [Goodbye.STOPPING] * 6
        await closing
        assert time.monotonic() - began < 10
        assert not any(alive(pid) for pid in left)
        assert await (await server.visit("P09")).closed() == Goodbye.FULL


# --- too much -----------------------------------------------------------------------------------


async def test_a_big_message_closes_the_line_and_nothing_else() -> None:
    async with echoes() as server:
        other, visit = await server.visit("P02"), await server.visit()
        await visit.until(WINDOW)
        await visit.press("x" * (MOST_MESSAGE_BYTES + 10))
        assert await visit.closed() == 1009
        await other.press("well")
        await other.until(b"well")
        assert len(server.room) == 2


async def test_a_message_in_many_pieces_is_no_longer_than_a_whole_one() -> None:
    async with echoes() as server:
        visit = await server.visit()
        await visit.until(WINDOW)
        reader, writer = await asyncio.open_connection("127.0.0.1", server.client.port)
        writer.write(
            f"GET /line?ticket=P02&tab=abcdefgh HTTP/1.1\r\nHost: {server.origin[7:]}\r\n"
            f"Origin: {server.origin}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
            "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
            .encode()
        )  # fmt: skip
        assert b" 101 " in await reader.readuntil(b"\r\n\r\n")
        piece = b"\x7e" + (1000).to_bytes(2, "big")
        for number in range(10):
            opcode = 1 if number == 0 else 0
            writer.write(bytes([opcode, piece[0] | 0x80]) + piece[1:] + bytes(4) + b"x" * 1000)
        with suppress(ConnectionError):
            await writer.drain()
        async with asyncio.timeout(10):
            while b"\x03\xf1" not in await reader.read(65536):  # 1009: too big
                assert not reader.at_eof()
        writer.close()
        await visit.press("well")
        await visit.until(b"well")


async def test_requests_that_never_end_hold_up_nobody() -> None:
    async with echoes() as server:
        halves = [
            await asyncio.open_connection("127.0.0.1", server.client.port) for _ in range(100)
        ]
        for _, writer in halves:
            writer.write(b"GET /?link=P01 HTTP/1.1\r\nHost: ")
        visit = await server.visit()
        await visit.press("well")
        await visit.until(b"well", 2)
        assert len(server.room) == 1
        for _, writer in halves:
            writer.close()


async def test_a_flood_of_windows_of_one_visitor_is_one_program() -> None:
    async with echoes() as server:
        visits = await asyncio.gather(*(server.visit(tab=f"window{n:02}") for n in range(30)))
        closings = [asyncio.create_task(visit.closed()) for visit in visits]
        async with asyncio.timeout(10):
            while sum(closing.done() for closing in closings) < len(visits) - 1:
                await asyncio.sleep(0.01)
        codes = {closing.result() for closing in closings if closing.done()}
        assert codes == {Goodbye.ELSEWHERE}
        assert len(server.room) == 1
        for closing in closings:
            closing.cancel()


async def test_a_header_without_end_is_refused() -> None:
    async with echoes() as server:
        reader, writer = await asyncio.open_connection("127.0.0.1", server.client.port)
        writer.write(b"GET / HTTP/1.1\r\nX: " + b"x" * 100_000)
        with suppress(ConnectionError):
            await writer.drain()
            assert b" 400 " in await asyncio.wait_for(reader.readline(), 5)
        writer.close()
        assert (await server.client.get("/?link=P01")).status == 200


async def test_binary_messages_close_the_line() -> None:
    async with echoes() as server:
        visit = await server.visit()
        await visit.socket.send_bytes(b"kx")
        assert await visit.closed() == 1000


async def test_keys_beyond_what_anyone_types_are_dropped() -> None:
    limits = Limits(keys_a_second=10, burst_s=2)
    async with echoes(limits) as server:
        visit = await server.visit()
        await visit.until(WINDOW)
        began = time.monotonic()
        for _ in range(1000):
            await visit.press("k")
        await asyncio.sleep(0.5)
        most = limits.keys_a_second * (limits.burst_s + time.monotonic() - began)
        while True:
            await visit.press("e")
            try:
                await visit.until(b"e", 0.5)
                break
            except TimeoutError:
                continue
        assert 20 <= visit.output.count(b"k") <= most


async def test_only_so_much_is_painted_anew() -> None:
    async with echoes(Limits(keys_a_second=20, burst_s=5)) as server:
        visit = await server.visit()
        await visit.until(WINDOW)
        began = time.monotonic()
        for _ in range(200):
            await visit.socket.send_str("r")
        await asyncio.sleep(0.5)
        most = 1 + 5 + (time.monotonic() - began)
        while b"end" not in visit.output:
            await visit.press("end")
            with suppress(TimeoutError):
                await visit.until(b"end", 0.5)
        assert visit.output.count(WINDOW) <= most + 1


async def test_a_reader_who_never_reads_holds_up_nobody_and_loses_the_line() -> None:
    async with echoes(QUICK) as server:
        other, slow = await server.visit("P02"), await server.visit("P01")
        await other.until(WINDOW)
        await slow.until(WINDOW)
        (stuck,) = (hosted for hosted in server.room if hosted.visitor.name == "P01")
        assert stuck.line is not None
        await slow.press("F")
        began = time.monotonic()
        for number in range(10):
            await other.press(f"<{number}>")
            await other.until(f"<{number}>".encode(), 5)
        async with asyncio.timeout(15):
            while "P01" in {hosted.visitor.name for hosted in server.room}:
                await asyncio.sleep(0.05)
        assert time.monotonic() - began < 15
        await other.press("well")
        await other.until(b"well")


async def test_output_waits_for_the_reader_and_none_is_lost() -> None:
    async with echoes(Limits(send_s=30)) as server:
        visit = await server.visit()
        await visit.until(WINDOW)
        await visit.press("F")
        size = 0
        while size < 400 * 65536:
            message = await visit.socket.receive(20)
            assert message.type is WSMsgType.BINARY
            size += message.data.count(b"x")
        assert size == 400 * 65536
