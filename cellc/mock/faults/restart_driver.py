"""The driver of a device ends and comes back unconfigured, with an old goal waiting.

The read of the component fails, its error handler leaves it unconfigured (ros2_control `Component::error`), and every
controller that uses it is deactivated, with its goals aborted. The robot stops by itself when commands stay away. After
the reconnect nothing is active until somebody acknowledges, and no goal from before is carried out.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.case import FaultCase
from cellc.mock.faults.contents import components
from cellc.mock.faults.stopping import stopping_case
from cellc.mock.plant import Plant
from cellc.mock.stops import FAULT
from cellc.vocabulary import FaultKind


@dataclass(frozen=True, slots=True)
class RestartDriver:
    """Ends the driver of a hardware component, and starts it again."""

    component: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> RestartDriver | None:
        """Return the fault of an entry; None where its target has no hardware."""
        component = components(contract).get(entry.target)
        return None if component is None else cls(component)

    def begin(self, plant: Plant) -> None:
        """End the driver."""
        plant.stops.enter(self.component, FAULT)
        for manager in plant.control.managers_of_component(self.component):
            manager.disturbances.lose(self.component)

    def end(self, plant: Plant) -> None:
        """Connect again; that alone lets nothing move."""
        plant.stops.end_cause(self.component)


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every device with hardware."""
    for device in components(contract):
        yield stopping_case(FaultKind.RESTART_DRIVER, device, "hardware_fault", contract)
