"""Every fault that a cell can meet, with what each of its steps may make of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cellc.contract.contract import Contract
from cellc.mock.faults import (
    cancel,
    cut_network,
    delay,
    displace,
    double_frame,
    drop_frame,
    emergency_stop,
    freeze,
    jump_clock,
    mismatch_qos,
    protective_stop,
    reject,
    restart_driver,
    scale_speed,
    second_commander,
    skip_cycles,
    slow,
    stick,
    switch,
    unreachable,
    unresponsive,
    wrong_payload,
)
from cellc.mock.faults.case import FaultCase

_KINDS: tuple[Callable[[Contract], Iterator[FaultCase]], ...] = (
    delay.cases,
    freeze.cases,
    drop_frame.cases,
    double_frame.cases,
    jump_clock.cases,
    mismatch_qos.cases,
    unresponsive.cases,
    unreachable.cases,
    reject.cases,
    cancel.cases,
    second_commander.cases,
    switch.cases,
    stick.cases,
    slow.cases,
    displace.cases,
    scale_speed.cases,
    skip_cycles.cases,
    wrong_payload.cases,
    protective_stop.cases,
    emergency_stop.cases,
    restart_driver.cases,
    cut_network.cases,
)


def possible_faults(contract: Contract) -> tuple[FaultCase, ...]:
    """Return the cases of every kind of fault, in the order of the packet from observation to drive."""
    return tuple(case for cases in _KINDS for case in cases(contract))
