"""Devices that stop: by their safety functions, at the emergency stop, with their driver, or over a wrong payload."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

from cellc.contract.contract import Contract
from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.faults.cases import (
    BORNE,
    CellStep,
    Ending,
    FaultCase,
    components,
    device_of,
    ends_in,
    fault_case,
    joints_of_device,
    stoppable,
)
from cellc.mock.faults.endings import Bounds, stopped
from cellc.mock.faults.ports import FaultPorts
from cellc.mock.stops import EMERGENCY_STOP, FAULT, PROTECTIVE_STOP

NOTICED_AFTER = 0.01
"""rad or m that a joint moves before the torques give the load away."""
LOOK_S = 0.01


@dataclass(frozen=True, slots=True)
class _SafetyStop:
    """A device that its safety functions stop; it stays stopped until that is acknowledged.

    Attributes:
        outcome: how a step ends that the stop hits.
        state: what the device tells of itself meanwhile.
    """

    kind: ClassVar[FaultKind]
    outcome: ClassVar[AttemptOutcome]
    state: ClassVar[str]
    component: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> _SafetyStop | None:
        """Return the fault of an entry; None where nothing of its target can stop."""
        component = stoppable(contract).get(entry.target)
        return None if component is None else cls(component)

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every device with hardware or an adapter."""
        for device in stoppable(contract):
            entry = FaultEntry(kind=cls.kind, target=device)
            yield fault_case(entry, contract, stopped(Bounds(contract), cls.outcome), hits_running_step=True)

    def begin(self, ports: FaultPorts) -> None:
        """Stop."""
        ports.hardware.stop(self.component, self.state)

    def end(self, ports: FaultPorts) -> None:
        """Let what stopped it be over."""
        ports.hardware.end_cause(self.component)


class ProtectiveStop(_SafetyStop):
    """A device goes into protective stop: its state stays visible, commands are refused."""

    kind = FaultKind.PROTECTIVE_STOP
    outcome = AttemptOutcome.PROTECTIVE_STOP
    state = PROTECTIVE_STOP


class EmergencyStop(_SafetyStop):
    """Takes the power from the drives of a device; its own controller stays on, and tells where the joints stand."""

    kind = FaultKind.EMERGENCY_STOP
    outcome = AttemptOutcome.EMERGENCY_STOP
    state = EMERGENCY_STOP


@dataclass(frozen=True, slots=True)
class RestartDriver:
    """The driver of a hardware component ends and comes back unconfigured, with an old goal waiting.

    The read of the component fails, its error handler leaves it unconfigured (ros2_control `Component::error`), and
    every controller that uses it is deactivated, with its goals aborted. The robot stops by itself when commands stay
    away. After the reconnect nothing is active until somebody acknowledges, and no goal from before is carried out.
    """

    kind: ClassVar[FaultKind] = FaultKind.RESTART_DRIVER
    component: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> RestartDriver | None:
        """Return the fault of an entry; None where its target has no hardware."""
        component = components(contract).get(entry.target)
        return None if component is None else cls(component)

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every device with hardware."""
        for device in components(contract):
            entry = FaultEntry(kind=cls.kind, target=device)
            yield fault_case(
                entry, contract, stopped(Bounds(contract), AttemptOutcome.HARDWARE_FAULT), hits_running_step=True
            )

    def begin(self, ports: FaultPorts) -> None:
        """End the driver."""
        ports.hardware.lose(self.component, FAULT)

    def end(self, ports: FaultPorts) -> None:
        """Connect again; that alone lets nothing move."""
        ports.hardware.end_cause(self.component)


class WrongPayload:
    """The payload set in the controller of an arm is wrong: the arm stops itself every time it starts to move.

    Its controller computes torques from the payload and measures others; it takes the difference for a collision.
    """

    kind: ClassVar[FaultKind] = FaultKind.WRONG_PAYLOAD

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

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every arm."""
        for device in stoppable(contract):
            if contract.devices[device].kind == "arm":
                entry = FaultEntry(kind=cls.kind, target=device)
                yield fault_case(entry, contract, partial(_overloaded, Bounds(contract), device))

    def begin(self, ports: FaultPorts) -> None:
        """Change the load."""
        self._active = True
        self._stopped_at = ports.hardware.positions(self._component, self._joints)
        self._look(ports)

    def end(self, ports: FaultPorts) -> None:
        """Tell the robot of its load."""
        self._active = False

    def _look(self, ports: FaultPorts) -> None:
        """Stop where a joint has moved; what made the robot stop is over as soon as it is at rest."""
        if not self._active:
            return
        positions = ports.hardware.positions(self._component, self._joints)
        if any(abs(positions[joint] - self._stopped_at[joint]) > NOTICED_AFTER for joint in positions):
            self._stopped_at = positions
            ports.hardware.stop(self._component, PROTECTIVE_STOP)
            ports.hardware.end_cause(self._component)
        ports.schedule.at(ports.schedule.now_ns + round(LOOK_S * 1e9), partial(self._look, ports))


def _overloaded(bounds: Bounds, device: str, step: CellStep) -> Ending:
    """A step that leaves the arm where it is tolerates the fault."""
    if not any(device_of(bounds.contract, name) == device for name in step.controllers):
        return BORNE
    return ends_in(AttemptOutcome.PROTECTIVE_STOP, AttemptOutcome.SUCCEEDED, within_s=bounds.execution_s(step))
