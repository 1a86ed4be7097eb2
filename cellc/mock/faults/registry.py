"""Every fault that the mock can inject, named once, in the order of the packet from observation to drive."""

from __future__ import annotations

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.errors import MockError
from cellc.mock.faults.case import FaultCase
from cellc.mock.faults.fault import Fault, FaultType
from cellc.mock.faults.frames import DoubleFrame, DropFrame, JumpClock
from cellc.mock.faults.goals import Cancel, Reject, SecondCommander, Switch, Unreachable
from cellc.mock.faults.joints import Displace, ScaleSpeed, SkipCycles, Slow, Stick
from cellc.mock.faults.network import CutNetwork, MismatchQos, Unresponsive
from cellc.mock.faults.samples import Delay, Freeze
from cellc.mock.faults.stops import EmergencyStop, ProtectiveStop, RestartDriver, WrongPayload

FAULTS: tuple[FaultType, ...] = (
    Delay,
    Freeze,
    DropFrame,
    DoubleFrame,
    JumpClock,
    MismatchQos,
    Unresponsive,
    Unreachable,
    Reject,
    Cancel,
    SecondCommander,
    Switch,
    Stick,
    Slow,
    Displace,
    ScaleSpeed,
    SkipCycles,
    WrongPayload,
    ProtectiveStop,
    EmergencyStop,
    RestartDriver,
    CutNetwork,
)
_BY_KIND = {fault.kind: fault for fault in FAULTS}


def build_fault(entry: FaultEntry, contract: Contract) -> Fault:
    """Return the fault of an entry; raise MockError where it has no moment or names what it cannot hit."""
    if (entry.at_s is None) == (entry.event is None):
        reason = f"fault `{entry.kind}` needs either a time or an event that begins it"
        raise MockError(contract.files.rehearsals, reason)
    fault = _BY_KIND[entry.kind].of(entry, contract)
    if fault is None:
        reason = f"fault `{entry.kind}` names `{entry.target}`, which it cannot hit in this cell"
        raise MockError(contract.files.rehearsals, reason)
    return fault


def possible_faults(contract: Contract) -> tuple[FaultCase, ...]:
    """Return every fault that a cell can meet, with what each of its steps may make of it."""
    return tuple(case for fault in FAULTS for case in fault.cases(contract))
