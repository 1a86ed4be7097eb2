"""Every fault that a cell can meet, with what each of its steps may make of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cellc.contract.contract import Contract
from cellc.mock.faults import (
    cancel,
    delay,
    drop_frame,
    freeze,
    protective_stop,
    reject,
    skip_cycles,
    stick,
    unreachable,
)
from cellc.mock.faults.case import FaultCase

_KINDS: tuple[Callable[[Contract], Iterator[FaultCase]], ...] = (
    delay.cases,
    freeze.cases,
    drop_frame.cases,
    unreachable.cases,
    reject.cases,
    cancel.cases,
    stick.cases,
    skip_cycles.cases,
    protective_stop.cases,
)


def possible_faults(contract: Contract) -> tuple[FaultCase, ...]:
    """Return the cases of every kind of fault, in the order of the packet from observation to drive."""
    return tuple(case for cases in _KINDS for case in cases(contract))
