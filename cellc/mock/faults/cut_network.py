"""Nothing passes between a device and its host.

A camera falls silent. A robot stops by itself when commands stay away, and its driver gives up when states do: the last
states are published with new stamps until then.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import FaultCase, fault_case
from cellc.mock.faults.contents import components
from cellc.mock.faults.observed import cameras, ending_unobserved
from cellc.mock.faults.stopping import stopping_case
from cellc.mock.plant import Plant
from cellc.mock.stops import FAULT
from cellc.vocabulary import FaultKind

KEEP_ALIVE_S = 0.02
"""Silence after which a robot and its driver give each other up: ten cycles at 500 Hz."""


class CutNetwork:
    """Cuts a device off; a cut that is over before the driver gives up is borne."""

    def __init__(self, device: str, component: str | None) -> None:
        """Bind the fault to a device; ``component`` is None for one without hardware of ros2_control."""
        self.device = device
        self.component = component
        self._cut = False
        self._given_up = False

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> CutNetwork | None:
        """Return the fault of an entry; None where its target is neither a camera nor has hardware."""
        component = components(contract).get(entry.target)
        known = component is not None or entry.target in cameras(contract)
        return cls(entry.target, component) if known else None

    def begin(self, plant: Plant) -> None:
        """Cut."""
        if self.component is None:
            plant.network.cut({plant.cameras[self.device].device})
            return
        self._cut = True
        for manager in plant.control.managers_of_component(self.component):
            manager.disturbances.ignore_commands(self.component)
        plant.simulation.at(plant.now_ns + round(KEEP_ALIVE_S * 1e9), partial(self._give_up, plant, self.component))

    def end(self, plant: Plant) -> None:
        """Connect again; a driver that gave up lets nothing move before somebody acknowledges."""
        self._cut = False
        if self.component is None:
            plant.network.mend()
        elif self._given_up:
            plant.stops.end_cause(self.component)
        else:
            for manager in plant.control.managers_of_component(self.component):
                manager.disturbances.heed_commands(self.component)

    def _give_up(self, plant: Plant, component: str) -> None:
        if not self._cut:
            return
        self._given_up = True
        plant.stops.enter(component, FAULT)
        for manager in plant.control.managers_of_component(component):
            manager.disturbances.lose(component)


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every device that is connected to a host."""
    for device in components(contract):
        yield stopping_case(FaultKind.CUT_NETWORK, device, "hardware_fault", contract, after_s=KEEP_ALIVE_S)
    for device, frames in cameras(contract).items():
        entry = FaultEntry(kind="cut_network", target=device)
        yield fault_case(entry, contract, ending_unobserved(Bounds(contract), frames))
