"""Devices that stop: by their safety functions, at the emergency stop, with their driver, or over a wrong payload."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import ClassVar

from cellc.contract.contract import Contract
from cellc.contract.faults import FaultKind
from cellc.contract.frozen import dataclass
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
    stop_of,
    stoppable,
)
from cellc.mock.faults.endings import Bounds, stopped, stopped_in
from cellc.mock.faults.ports import FaultPorts

NOTICED_AFTER = 0.01
"""rad or m that a joint moves before the torques give the load away."""
LOOK_S = 0.01


@dataclass(frozen=True, slots=True)
class _SafetyStop:
    """A device that its safety functions stop; it stays stopped until that is acknowledged.

    Where its own program only pauses meanwhile, the end of the stop is that it goes on: a person has acknowledged at
    the device, or none had to.

    Attributes:
        state: the state of the device.
    """

    kind: ClassVar[FaultKind]
    device: str
    state: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> _SafetyStop | None:
        """Return the fault of an entry; None where nothing of its target stops so."""
        state = stop_of(contract, entry.target, cls.kind) if entry.target in contract.devices else None
        return None if state is None else cls(entry.target, state)

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every device with hardware or an adapter that stops so."""
        for device in stoppable(contract):
            state = stop_of(contract, device, cls.kind)
            if state is not None:
                entry = FaultEntry(kind=cls.kind, target=device)
                yield fault_case(entry, contract, stopped_in(Bounds(contract), device, state), hits_running_step=True)

    def begin(self, ports: FaultPorts) -> None:
        """Stop."""
        ports.effects.stop(self.device, self.state)

    def end(self, ports: FaultPorts) -> None:
        """Let what stopped it be over."""
        ports.effects.end_stop(self.device, self.state)


class ProtectiveStop(_SafetyStop):
    """A device goes into protective stop, or into fault where it has no such stop: its state stays visible."""

    kind = FaultKind.PROTECTIVE_STOP


class SafeguardStop(_SafetyStop):
    """A door or a light curtain stops a device; it goes on as its vendor has it, once that is over."""

    kind = FaultKind.SAFEGUARD_STOP


class EmergencyStop(_SafetyStop):
    """Takes the power from the drives of a device; its own controller stays on, and tells where the joints stand."""

    kind = FaultKind.EMERGENCY_STOP


@dataclass(frozen=True, slots=True)
class RestartDriver:
    """The driver of a hardware component ends and comes back unconfigured, with an old goal waiting.

    The read of the component fails, its error handler leaves it unconfigured (ros2_control `Component::error`), and
    every controller that uses it is deactivated, with its goals aborted. The robot stops by itself when commands stay
    away. After the reconnect nothing is active until somebody acknowledges, and no goal from before is carried out.
    """

    kind: ClassVar[FaultKind] = FaultKind.RESTART_DRIVER
    device: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> RestartDriver | None:
        """Return the fault of an entry; None where its target has no hardware."""
        return cls(entry.target) if entry.target in components(contract) else None

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
        ports.effects.lose_driver(self.device)

    def end(self, ports: FaultPorts) -> None:
        """Connect again; that alone lets nothing move."""
        ports.effects.end_cause(self.device)


class WrongPayload:
    """The payload set in the controller of an arm is wrong: the arm stops itself every time it starts to move.

    Its controller computes torques from the payload and measures others; it takes the difference for a collision.
    """

    kind: ClassVar[FaultKind] = FaultKind.WRONG_PAYLOAD

    def __init__(self, device: str, state: str, joints: tuple[str, ...]) -> None:
        """Bind the fault to an arm, and to the state in which it stops."""
        self._device = device
        self._state = state
        self._joints = joints
        self._active = False
        self._stopped_at: dict[str, float] = {}

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> WrongPayload | None:
        """Return the fault of an entry; None where its target is no arm that can stop."""
        if entry.target not in stoppable(contract) or contract.devices[entry.target].kind != "arm":
            return None
        state = stop_of(contract, entry.target, FaultKind.PROTECTIVE_STOP)
        return None if state is None else cls(entry.target, state, joints_of_device(contract, entry.target))

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every arm."""
        for device in stoppable(contract):
            entry = FaultEntry(kind=cls.kind, target=device)
            state = stop_of(contract, device, FaultKind.PROTECTIVE_STOP)
            if contract.devices[device].kind == "arm" and state is not None:
                yield fault_case(entry, contract, partial(_overloaded, Bounds(contract), device, state))

    def begin(self, ports: FaultPorts) -> None:
        """Change the load."""
        self._active = True
        self._stopped_at = ports.hardware.positions(self._joints)
        self._look(ports)

    def end(self, ports: FaultPorts) -> None:
        """Tell the robot of its load."""
        self._active = False

    def _look(self, ports: FaultPorts) -> None:
        """Stop where a joint has moved; what made the robot stop is over as soon as it is at rest."""
        if not self._active:
            return
        positions = ports.hardware.positions(self._joints)
        if any(abs(positions[joint] - self._stopped_at[joint]) > NOTICED_AFTER for joint in positions):
            self._stopped_at = positions
            ports.effects.stop(self._device, self._state)
            ports.effects.end_stop(self._device, self._state, resumed=False)
        ports.schedule.at(ports.schedule.now_ns + round(LOOK_S * 1e9), partial(self._look, ports))


def _overloaded(bounds: Bounds, device: str, state: str, step: CellStep) -> Ending:
    """A step that leaves the arm where it is tolerates the fault."""
    if not any(device_of(bounds.contract, name) == device for name in step.controllers):
        return BORNE
    outcomes = stopped_in(bounds, device, state)(step).outcomes
    return ends_in(*outcomes, AttemptOutcome.SUCCEEDED, within_s=bounds.execution_s(step))
