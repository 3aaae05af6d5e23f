"""Computing simulated sessions: in this process, on local cores, or on a cluster.

Every way takes the same work and yields the journals in the order of the work, so that the result
does not depend on where it was computed.
"""

from __future__ import annotations

import os
import signal
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import contextmanager
from itertools import islice
from typing import Any

from game.errors import AnaError
from game.rescuers.person import Population
from game.simulation.simulated_session import play_session
from game.study.folder import Study
from game.study.ledger import SlotTaken

Journals = Iterator[tuple[SlotTaken, bytes]]
AHEAD = 4
"""How many sessions are handed out per core before waiting for the first of them."""


class SchedulerError(AnaError):
    """The cluster cannot be used."""


def here(study: Study, work: Sequence[SlotTaken], population: Population) -> Journals:
    """Compute the sessions in this process, one after the other."""
    for taken in work:
        yield taken, play_session(study, taken, population)


def on_cores(
    study: Study, work: Sequence[SlotTaken], population: Population, jobs: int
) -> Journals:
    """Compute the sessions on `jobs` local cores. An interrupt leaves no process behind."""
    pool = ProcessPoolExecutor(jobs, initializer=_get_ready, initargs=(study, population))
    try:
        yield from _in_order(work, lambda taken: pool.submit(_play, taken), jobs * AHEAD)
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def on_cluster(
    study: Study,
    work: Sequence[SlotTaken],
    population: Population,
    address: str,
    timeout_s: float = 10,
) -> Journals:
    """Compute the sessions on the workers of the dask scheduler at `address`. They need the same
    version of `ana`, but no shared folder. Raises SchedulerError if it cannot be reached."""
    with cluster(address, timeout_s) as client:
        shared = client.scatter(study, broadcast=True)

        def submit(taken: SlotTaken) -> Any:
            return client.submit(play_session, shared, taken, population, pure=False)

        cores = sum(client.ncores().values()) or 1
        yield from _in_order(work, submit, cores * AHEAD)


@contextmanager
def cluster(address: str, timeout_s: float = 10) -> Iterator[Any]:
    """A client of the dask scheduler at `address`. Raises SchedulerError where none answers."""
    try:
        from distributed import Client
    except ImportError as error:
        raise SchedulerError(
            "dask.distributed is not installed",
            place="--scheduler",
            hint="Install the extra: pip install 'ana[cluster]'",
        ) from error
    try:
        client = Client(address, timeout=timeout_s)
    except (OSError, ValueError) as error:
        raise SchedulerError(
            f"no scheduler answers at {address}",
            place="--scheduler",
            hint="Start one with `dask scheduler`, and give its address, tcp://HOST:PORT",
        ) from error
    with client:
        yield client


def cores() -> int:
    """The number of cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _in_order(
    work: Sequence[SlotTaken], submit: Callable[[SlotTaken], Future[bytes]], ahead: int
) -> Journals:
    """The journals in the order of the work, with at most `ahead` in progress at a time."""
    waiting = iter(work)
    under_way = deque((taken, submit(taken)) for taken in islice(waiting, ahead))
    while under_way:
        taken, future = under_way.popleft()
        journal = future.result()
        under_way.extend((following, submit(following)) for following in islice(waiting, 1))
        yield taken, journal


_common: tuple[Study, Population] | None = None


def _get_ready(study: Study, population: Population) -> None:
    """Set what all sessions of a process share. The parent process handles interrupts."""
    global _common  # noqa: PLW0603 - a pool hands its workers their common data in no other way
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _common = study, population


def _play(taken: SlotTaken) -> bytes:
    assert _common is not None
    study, population = _common
    return play_session(study, taken, population)
