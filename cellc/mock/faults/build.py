"""Makes faults from the entries of rehearsals.json."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.errors import MockError
from cellc.mock.faults.cancel import Cancel
from cellc.mock.faults.cut_network import CutNetwork
from cellc.mock.faults.delay import Delay
from cellc.mock.faults.displace import Displace
from cellc.mock.faults.double_frame import DoubleFrame
from cellc.mock.faults.drop_frame import DropFrame
from cellc.mock.faults.emergency_stop import EmergencyStop
from cellc.mock.faults.fault import Fault
from cellc.mock.faults.freeze import Freeze
from cellc.mock.faults.jump_clock import JumpClock
from cellc.mock.faults.mismatch_qos import MismatchQos
from cellc.mock.faults.protective_stop import ProtectiveStop
from cellc.mock.faults.reject import Reject
from cellc.mock.faults.restart_driver import RestartDriver
from cellc.mock.faults.scale_speed import ScaleSpeed
from cellc.mock.faults.second_commander import SecondCommander
from cellc.mock.faults.skip_cycles import SkipCycles
from cellc.mock.faults.slow import Slow
from cellc.mock.faults.stick import Stick
from cellc.mock.faults.switch import Switch
from cellc.mock.faults.unreachable import Unreachable
from cellc.mock.faults.unresponsive import Unresponsive
from cellc.mock.faults.wrong_payload import WrongPayload

_BUILDERS: Mapping[str, Callable[[FaultEntry, Contract], Fault | None]] = {
    "delay": Delay.of,
    "freeze": Freeze.of,
    "drop_frame": DropFrame.of,
    "double_frame": DoubleFrame.of,
    "jump_clock": JumpClock.of,
    "mismatch_qos": MismatchQos.of,
    "unresponsive": Unresponsive.of,
    "unreachable": Unreachable.of,
    "reject": Reject.of,
    "cancel": Cancel.of,
    "second_commander": SecondCommander.of,
    "switch": Switch.of,
    "stick": Stick.of,
    "slow": Slow.of,
    "displace": Displace.of,
    "scale_speed": ScaleSpeed.of,
    "skip_cycles": SkipCycles.of,
    "wrong_payload": WrongPayload.of,
    "protective_stop": ProtectiveStop.of,
    "emergency_stop": EmergencyStop.of,
    "restart_driver": RestartDriver.of,
    "cut_network": CutNetwork.of,
}


def build_fault(entry: FaultEntry, contract: Contract) -> Fault:
    """Return the fault of an entry; raise MockError where it has no moment or names what it cannot hit."""
    if (entry.at_s is None) == (entry.event is None):
        reason = f"fault `{entry.kind}` needs either a time or an event that begins it"
        raise MockError(contract.files.rehearsals, reason)
    fault = _BUILDERS[entry.kind](entry, contract)
    if fault is None:
        reason = f"fault `{entry.kind}` names `{entry.target}`, which it cannot hit in this cell"
        raise MockError(contract.files.rehearsals, reason)
    return fault
