"""Executor of a running Dask cluster: ``dask scheduler`` and any number of ``dask worker``.

Dask sends Python objects by pickle, as it does for all of its users: any host that reaches the scheduler may execute
code on its workers and on its clients, so trust is required. Dask repeats a task when its worker dies. It gives
up after ``distributed.scheduler.allowed-failures`` deaths (3 by default; distributed.dask.org, "Resilience").
What all units need is a task too, named by its content: it is sent once, and survives any worker.

A unit takes some 10 ms, and a task costs Dask about 1 ms (docs.dask.org, "Best Practices"): units go in packets.
"""

from __future__ import annotations

import asyncio
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Future
from contextlib import contextmanager, suppress
from functools import partial
from time import monotonic
from typing import Any

from cellc.contract.compute.versions import versions
from cellc.contract.compute.work import ComputeError, Executor, ExecutorFactory, Sent, answer
from cellc.contract.extras import CLUSTER, gate

_PACKET = 50
_HANDS_OF_A_WORKER = 3
_CONNECTS_S = 10.0
_CHECK_PERIOD_S = 0.5
_ASK_S = 2.0
_IDLE_S = 60.0
"""How long a scheduler may be without a worker: who starts them by hand, or a batch system, takes a while."""
_ADDRESS = re.compile(r"(?:(?:tcp|tls|wss?|ucx)://)?(?:\[[0-9a-fA-F:.%]+\]|[^\s/:\[\]]+):[0-9]{1,5}/?")
_AWAY_S = 3.0
"""How long a scheduler may be out of reach: Dask connects again after a break, and has forgotten what it was asked."""


def cluster(address: str, tell: Callable[[str], None] = lambda _: None) -> ExecutorFactory:
    """Return a factory that uses all workers of a scheduler, such as ``tcp://10.0.0.7:8786``.

    Args:
        tell: called with what a person should know while nothing is done.
    """
    return partial(_executor, address, tell)


@contextmanager
def _executor(address: str, tell: Callable[[str], None], sent: Sent, units: int) -> Iterator[Executor]:
    if not _ADDRESS.fullmatch(address):
        raise ComputeError(f"`{address}` is not the address of a scheduler; write one such as `tcp://10.0.0.7:8786`")
    with gate(CLUSTER):
        from dask import config

        config.set({"logging": dict.fromkeys(("distributed", "distributed.client"), "critical")})  # it is said here
        from distributed import Client, KilledWorker
    _find_scheduler(address)
    try:
        client = Client(address, timeout=_CONNECTS_S, set_as_default=False)
    except (OSError, ValueError, TimeoutError):
        raise _unanswered(address) from None
    try:
        with _in_words(address, KilledWorker):
            future = client.submit(_same, sent, key=f"cellc-{sent.digest}", pure=True)
            executor = client.get_executor(pure=False)
            max_in_flight = _HANDS_OF_A_WORKER * max(1, len(client.nthreads()))

            def submit(packet: Sequence[Any]) -> Future[Any]:
                asked: Future[Any] = executor.submit(_answer, future, versions(), packet)
                return asked

            packet = max(1, min(_PACKET, units // (2 * max_in_flight)))
            yield Executor(submit, max_in_flight, packet, _CHECK_PERIOD_S, _Watch(client, address, tell).check_health)
    finally:
        with suppress(Exception):  # a scheduler that is gone needs no message
            client.close(timeout=1)


def _find_scheduler(address: str) -> None:
    """Raise ComputeError where no scheduler answers: a client of Dask that finds none ends in tracebacks, or never."""
    with gate(CLUSTER):
        from distributed.core import rpc

    async def kind() -> object:
        async with rpc(address, timeout=_CONNECTS_S) as remote:
            return (await remote.identity()).get("type")

    async def in_time() -> object:
        return await asyncio.wait_for(kind(), _CONNECTS_S)

    try:
        scheduler = asyncio.run(in_time())
    except Exception as problem:  # whatever else listens there may answer anything
        if isinstance(problem, TypeError) and "ssl_context" in str(problem):
            raise ComputeError(f"`{address}` needs TLS, of which the configuration of Dask says nothing") from None
        raise _unanswered(address) from None
    if scheduler != "Scheduler":
        raise _unanswered(address)


def _unanswered(address: str) -> ComputeError:
    return ComputeError(f"no scheduler of Dask answers at `{address}`")


class _Watch:
    """Looks whether a scheduler is there, and whether it has workers."""

    def __init__(self, client: Any, address: str, tell: Callable[[str], None]) -> None:
        self._client = client
        self._address = address
        self._tell = tell
        self._seen_s = self._asked_s = self._manned_s = monotonic()
        self._told = False

    def check_health(self) -> None:
        """Raise ComputeError where the scheduler has been away, or without a worker, for longer than a break lasts."""
        now_s = monotonic()
        if self._client.status == "running":
            self._seen_s = now_s
            if now_s - self._asked_s > _ASK_S:
                self._look_for_workers(now_s)
        elif now_s - self._seen_s > _AWAY_S:
            raise _lost(self._address)

    def _look_for_workers(self, now_s: float) -> None:
        self._asked_s = now_s
        try:
            manned = bool(self._client.nthreads(callback_timeout=_AWAY_S))
        except (OSError, TimeoutError):  # the scheduler is away, which is seen by its status
            return
        if manned:
            self._manned_s, self._told = now_s, False
        elif now_s - self._manned_s > _IDLE_S:
            raise ComputeError(f"the scheduler at `{self._address}` has had no worker for {_IDLE_S:g} s")
        elif not self._told:
            self._told = True
            self._tell(
                f"the scheduler at `{self._address}` has no worker; one is waited for, at most {_IDLE_S:g} s. "
                f"Start it with `dask worker {self._address}`"
            )


@contextmanager
def _in_words(address: str, killed: type[Exception]) -> Iterator[None]:
    """Say in one line what Dask says in many."""
    try:
        yield
    except killed:
        raise ComputeError(f"a unit ended every worker of `{address}` that it was given to") from None
    except (CancelledError, BrokenExecutor, OSError, TimeoutError):
        raise _lost(address) from None
    except ModuleNotFoundError as missing:
        raise ComputeError(f"a worker of `{address}` has no `{missing.name}`") from None


def _lost(address: str) -> ComputeError:
    return ComputeError(f"the scheduler at `{address}` has gone")


def _same(sent: Sent) -> Sent:
    return sent


def _answer(sent: Sent, expected: Mapping[str, str], units: Sequence[Any]) -> list[Any]:
    """Answer some units in a worker that computes as the caller would.

    Raises:
        ComputeError: it has another version of what computes.
    """
    installed = versions()
    for name, wanted in expected.items():
        if installed[name] != wanted:
            raise ComputeError(f"a worker has {name} {installed[name]}, here is {wanted}; both must be the same")
    return answer(sent, units)
