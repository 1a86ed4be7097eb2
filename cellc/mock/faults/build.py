"""Makes faults from the entries of rehearsals.json."""

from __future__ import annotations

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.errors import MockError
from cellc.mock.faults.cancel import Cancel
from cellc.mock.faults.delay import Delay
from cellc.mock.faults.drop_frame import DropFrame
from cellc.mock.faults.fault import Fault
from cellc.mock.faults.freeze import Freeze
from cellc.mock.faults.protective_stop import ProtectiveStop
from cellc.mock.faults.reject import Reject
from cellc.mock.faults.skip_cycles import SkipCycles
from cellc.mock.faults.stick import Stick
from cellc.mock.faults.unreachable import Unreachable


def build_fault(entry: FaultEntry, contract: Contract) -> Fault:
    """Return the fault of an entry; raise MockError where it names what the contract does not have."""
    target = entry.target
    if entry.kind == "cancel":
        return Cancel(target)
    if entry.kind == "skip_cycles":
        return SkipCycles(entry.cycles or 1)
    if entry.kind == "freeze":
        _require(contract.devices[target].camera is not None if target in contract.devices else False, entry, contract)
        return Freeze(target)
    if entry.kind == "drop_frame":
        _require(target in contract.frames, entry, contract)
        return DropFrame(target)
    if entry.kind == "reject":
        _require(any(target in manager.controllers for manager in contract.managers.values()), entry, contract)
        return Reject(target)
    if entry.kind == "unreachable":
        _require(target in contract.goals, entry, contract)
        return Unreachable(target)
    if entry.kind == "stick":
        return Stick(target)
    return _of_device(entry, contract)


def _of_device(entry: FaultEntry, contract: Contract) -> Fault:
    device = contract.devices.get(entry.target)
    component = None if device is None else device.hardware_component
    if component is None:
        raise _unknown(entry, contract)
    if entry.kind == "protective_stop":
        return ProtectiveStop(component)
    joints = {
        joint
        for manager in contract.managers.values()
        for controller in manager.controllers.values()
        if controller.device == entry.target
        for joint in controller.joints
    }
    return Delay(tuple(sorted(joints)), entry.delay_s or 0.0)


def _require(exists: bool, entry: FaultEntry, contract: Contract) -> None:
    if not exists:
        raise _unknown(entry, contract)


def _unknown(entry: FaultEntry, contract: Contract) -> MockError:
    reason = f"fault `{entry.kind}` names `{entry.target}`, which the contract does not have"
    return MockError(contract.files.rehearsals, reason)
