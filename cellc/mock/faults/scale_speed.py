"""A device scales its speed: a slider, a safety function, or a program that was stopped on its pendant.

With a factor of 0 a controller that follows the scaling neither progresses nor aborts; the client bounds the goal.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.control import ControllerManager
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import BORNE, SUCCEEDED, Ending, FaultCase, ends_in, fault_case
from cellc.mock.faults.cell_steps import CellStep
from cellc.mock.faults.contents import controllers
from cellc.mock.plant import Plant
from cellc.vocabulary import Behaviour


@dataclass(frozen=True, slots=True)
class ScaleSpeed:
    """Sets the speed scaling that the hardware of a device reports, 0 to 1."""

    interface: str
    component: str
    factor: float

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> ScaleSpeed | None:
        """Return the fault of an entry; None where its target does not scale its speed."""
        device = contract.devices.get(entry.target)
        if device is None or device.speed_scaling_interface is None or device.hardware_component is None:
            return None
        return cls(device.speed_scaling_interface, device.hardware_component, entry.factor or 0.0)

    def begin(self, plant: Plant) -> None:
        """Scale."""
        for manager in self._managers(plant):
            manager.write_state(self.interface, self.factor)

    def end(self, plant: Plant) -> None:
        """Go on at full speed."""
        for manager in self._managers(plant):
            manager.write_state(self.interface, 1.0)

    def _managers(self, plant: Plant) -> Iterator[ControllerManager]:
        return plant.control.managers_of_component(self.component)


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every device that scales its speed, at a standstill."""
    for name, device in contract.devices.items():
        if device.speed_scaling_interface is not None:
            entry = FaultEntry(kind="scale_speed", target=name, factor=0.0)
            yield fault_case(entry, contract, partial(_ending, Bounds(contract), name))


def _ending(bounds: Bounds, device: str, step: CellStep) -> Ending:
    used = [facts for name, facts in controllers(bounds.contract).items() if name in step.controllers]
    if not any(facts.device == device and facts.behaviour is Behaviour.SCALED_JOINT_TRAJECTORY for facts in used):
        return BORNE
    return ends_in("timeout", SUCCEEDED, within_s=bounds.execution_s(step))  # borne where the arm stands there already
