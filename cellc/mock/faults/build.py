"""Makes faults from the entries of rehearsals.json."""

from __future__ import annotations

from collections.abc import Callable, Mapping

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

_BUILDERS: Mapping[str, Callable[[FaultEntry, Contract], Fault | None]] = {
    "cancel": Cancel.of,
    "delay": Delay.of,
    "drop_frame": DropFrame.of,
    "freeze": Freeze.of,
    "protective_stop": ProtectiveStop.of,
    "reject": Reject.of,
    "skip_cycles": SkipCycles.of,
    "stick": Stick.of,
    "unreachable": Unreachable.of,
}


def build_fault(entry: FaultEntry, contract: Contract) -> Fault:
    """Return the fault of an entry; raise MockError where it names what the contract does not have."""
    fault = _BUILDERS[entry.kind](entry, contract)
    if fault is None:
        reason = f"fault `{entry.kind}` names `{entry.target}`, which the contract does not have"
        raise MockError(contract.files.rehearsals, reason)
    return fault
