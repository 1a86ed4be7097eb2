"""An arm carries another load than it was told: it stops itself as soon as it moves, and every time it moves.

The torques that the robot's controller computes from the payload differ from those that it measures; it takes the
difference for a collision (chapter 4, troubleshooting: repeated protective stop, look for the payload first).
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import BORNE, SUCCEEDED, Ending, FaultCase, ends_in, fault_case
from cellc.mock.faults.cell_steps import CellStep
from cellc.mock.faults.contents import device_of, joints_of_device, stoppable
from cellc.mock.plant import Plant
from cellc.mock.stops import PROTECTIVE_STOP

NOTICED_AFTER = 0.01
"""rad or m that a joint moves before the torques give the load away."""
LOOK_S = 0.01


class WrongPayload:
    """Stops the component of an arm whenever one of its joints has moved."""

    def __init__(self, component: str, joints: tuple[str, ...]) -> None:
        """Bind the fault to an arm."""
        self._component = component
        self._joints = joints
        self._active = False
        self._stopped_at: dict[str, float] = {}

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> WrongPayload | None:
        """Return the fault of an entry; None where its target is no arm that can stop."""
        component = stoppable(contract).get(entry.target)
        if component is None or contract.devices[entry.target].kind != "arm":
            return None
        return cls(component, joints_of_device(contract, entry.target))

    def begin(self, plant: Plant) -> None:
        """Change the load."""
        self._active = True
        self._stopped_at = self._positions(plant)
        self._look(plant)

    def end(self, plant: Plant) -> None:
        """Tell the robot of its load."""
        self._active = False

    def _look(self, plant: Plant) -> None:
        if not self._active:
            return
        positions = self._positions(plant)
        if any(abs(positions[joint] - self._stopped_at[joint]) > NOTICED_AFTER for joint in positions):
            self._stopped_at = positions
            self._stop(plant)
        plant.simulation.at(plant.now_ns + round(LOOK_S * 1e9), partial(self._look, plant))

    def _stop(self, plant: Plant) -> None:
        """Stop at once; what made the robot stop is over as soon as it stands."""
        plant.stops.enter(self._component, PROTECTIVE_STOP)
        plant.stops.end_cause(self._component)
        for server in plant.control.servers_of_component(self._component):
            server.disturbances.protective_stop(self._component)

    def _positions(self, plant: Plant) -> dict[str, float]:
        servers = plant.control.servers_of_component(self._component)
        return {joint: server.joint_positions()[joint] for server in servers for joint in self._joints}


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every arm."""
    for device in stoppable(contract):
        if contract.devices[device].kind == "arm":
            entry = FaultEntry(kind="wrong_payload", target=device)
            yield fault_case(entry, contract, partial(_ending, Bounds(contract), device))


def _ending(bounds: Bounds, device: str, step: CellStep) -> Ending:
    """A step that leaves the arm where it stands bears the fault."""
    if not any(device_of(bounds.contract, name) == device for name in step.controllers):
        return BORNE
    return ends_in("protective_stop", SUCCEEDED, within_s=bounds.execution_s(step))
