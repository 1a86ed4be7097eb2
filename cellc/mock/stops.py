"""Stops of the hardware: entered by what happens to a device, left by an acknowledgment alone."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.mock.engine.control_stack import ControlStack

NORMAL = "normal"
PROTECTIVE_STOP = "protective_stop"
EMERGENCY_STOP = "emergency_stop"
FAULT = "fault"
_RANK = (EMERGENCY_STOP, FAULT, PROTECTIVE_STOP)
"""Of several stops the first of these names the state of the cell."""


@dataclass(frozen=True, slots=True)
class Stop:
    """A hardware component that refuses commands.

    Attributes:
        state: protective_stop, emergency_stop or fault: the recovery states of the spec.
        lifecycle: state of the component for the controller manager.
    """

    component: str
    state: str
    lifecycle: str


class Stops:
    """Which components stand still, why, and whether what stopped them is over.

    A component whose lifecycle alone tells that it stopped is in protective stop where it is inactive, at fault else.
    """

    def __init__(self, control: ControlStack) -> None:
        """Bind the stops to the managers that have the components."""
        self._control = control
        self._states: dict[str, str] = {}
        self._causes: dict[str, int] = {}

    def enter(self, component: str, state: str) -> None:
        """Name the state that a component stops in, the gravest where it stops twice; it lasts until ``end_cause``."""
        self._states[component] = min(state, self._states.get(component, state), key=_RANK.index)
        self._causes[component] = self._causes.get(component, 0) + 1

    def end_cause(self, component: str) -> None:
        """Let what stopped a component be over: it can be acknowledged from now on, and stays stopped until then."""
        self._causes[component] -= 1

    def present(self) -> tuple[Stop, ...]:
        """Return the components that are stopped, the gravest first."""
        stops = [
            Stop(
                component, self._states.get(component, PROTECTIVE_STOP if lifecycle == "inactive" else FAULT), lifecycle
            )
            for component, lifecycle in self._control.unready_hardware.items()
        ]
        return tuple(sorted(stops, key=lambda stop: (_RANK.index(stop.state), stop.component)))

    def state(self) -> str:
        """Return the safety state of the cell."""
        present = self.present()
        return present[0].state if present else NORMAL

    def lasting(self) -> tuple[Stop, ...]:
        """Return the stops that cannot be acknowledged, because their cause persists."""
        return tuple(stop for stop in self.present() if self._causes.get(stop.component, 0) > 0)

    def recover(self) -> None:
        """Let every stopped component be active again; each begins from where its joints stand."""
        for stop in self.present():
            for server in self._control.servers_of_component(stop.component):
                server.disturbances.recover(stop.component)
            self._states.pop(stop.component, None)
