"""A crew of a Dask cluster, which somebody runs already: ``dask scheduler`` and any number of ``dask worker``.

Dask sends Python objects by pickle, as it does for all of its users: whoever reaches the scheduler may execute code on
its workers and on its clients, so a cluster must be trusted. Dask does a task again elsewhere when its worker dies, and
gives up after ``distributed.scheduler.allowed-failures`` deaths (3 by default; distributed.dask.org, "Resilience").
What all units need is a task too, named by its content: it is sent once, and survives any worker.

A unit takes some 10 ms, and a task costs Dask about 1 ms (docs.dask.org, "Best Practices"): units go in packets.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Future
from contextlib import contextmanager, suppress
from functools import partial
from time import monotonic
from typing import Any

from cellc.compute.versions import versions
from cellc.compute.work import ComputeError, Crew, Hire, Sent, answer

_PACKET = 50
_HANDS_OF_A_WORKER = 3
_CONNECTS_S = 10.0
_LOOK_S = 0.5
_AWAY_S = 3.0
"""How long a scheduler may be out of reach: Dask connects again after a break, and has forgotten what it was asked."""


def cluster(address: str) -> Hire:
    """Return who hires all workers of a scheduler, such as ``tcp://10.0.0.7:8786``."""
    return partial(_crew, address)


@contextmanager
def _crew(address: str, sent: Sent, units: int) -> Iterator[Crew]:
    try:
        from dask import config

        config.set({"logging": dict.fromkeys(("distributed", "distributed.client"), "critical")})  # it is said here
        from distributed import Client, KilledWorker
    except ModuleNotFoundError as missing:
        if missing.name not in ("distributed", "dask"):
            raise
        raise ComputeError("`--cluster` needs Dask; install it with `pip install 'cellc[cluster]'`") from None
    try:
        client = Client(address, timeout=_CONNECTS_S, set_as_default=False)
    except (OSError, ValueError, TimeoutError):
        raise ComputeError(f"no scheduler of Dask answers at `{address}`") from None
    try:
        with _in_words(address, KilledWorker):
            told = client.submit(_same, sent, key=f"cellc-{sent.digest}", pure=True)
            executor = client.get_executor(pure=False)
            hands = _HANDS_OF_A_WORKER * max(1, len(client.nthreads()))

            def ask(packet: Sequence[Any]) -> Future[Any]:
                asked: Future[Any] = executor.submit(_answer, told, versions(), packet)
                return asked

            packet = max(1, min(_PACKET, units // (2 * hands)))
            yield Crew(ask, hands, packet, _LOOK_S, _Watch(client, address).look)
    finally:
        with suppress(Exception):  # a scheduler that is gone cannot be told
            client.close(timeout=1)


class _Watch:
    """Looks whether a scheduler is there, and whether it has workers."""

    def __init__(self, client: Any, address: str) -> None:
        self._client = client
        self._address = address
        self._seen_s = monotonic()

    def look(self) -> None:
        """Raise ComputeError where the scheduler has been away for longer than a break lasts."""
        now_s = monotonic()
        if self._client.status == "running":
            self._seen_s = now_s
        elif now_s - self._seen_s > _AWAY_S:
            raise _lost(self._address)


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
    found = versions()
    for name, wanted in expected.items():
        if found[name] != wanted:
            raise ComputeError(f"a worker has {name} {found[name]}, here is {wanted}; both must be the same")
    return answer(sent, units)
