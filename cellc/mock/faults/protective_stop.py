"""A device goes into protective stop: its state stays visible, commands are refused."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.case import FaultCase
from cellc.mock.faults.contents import stoppable
from cellc.mock.faults.stopping import stopping_case
from cellc.mock.plant import Plant
from cellc.mock.stops import PROTECTIVE_STOP
from cellc.vocabulary import FaultKind


@dataclass(frozen=True, slots=True)
class ProtectiveStop:
    """Stops the hardware component of a device."""

    component: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> ProtectiveStop | None:
        """Return the fault of an entry; None where nothing of its target can stop."""
        component = stoppable(contract).get(entry.target)
        return None if component is None else cls(component)

    def begin(self, plant: Plant) -> None:
        """Stop."""
        plant.stops.enter(self.component, PROTECTIVE_STOP)
        for server in plant.control.servers_of_component(self.component):
            server.disturbances.protective_stop(self.component)

    def end(self, plant: Plant) -> None:
        """Let what stopped it be over; it stays stopped until that is acknowledged."""
        plant.stops.end_cause(self.component)


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every device with hardware or an adapter."""
    for device in stoppable(contract):
        yield stopping_case(FaultKind.PROTECTIVE_STOP, device, "protective_stop", contract)
