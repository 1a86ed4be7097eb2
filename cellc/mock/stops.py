"""Stops of devices: entered by what happens to one, known to the cell by what it shows, left by an acknowledgment."""

from __future__ import annotations

from cellc.contract.frozen import dataclass
from cellc.mock.engine.control_stack import ControlStack

NORMAL = "normal"
PROTECTIVE_STOP = "protective_stop"
EMERGENCY_STOP = "emergency_stop"
FAULT = "fault"
_RANK = (EMERGENCY_STOP, FAULT, PROTECTIVE_STOP)
"""Of several stops the first of these names the state of the cell."""
_BY_NAME = {EMERGENCY_STOP: EMERGENCY_STOP, FAULT: FAULT, "violation": FAULT}


def recovery_state(name: str) -> str:
    """Return the recovery state of the spec that a vendor's state of a stop is."""
    return _BY_NAME.get(name, PROTECTIVE_STOP)


@dataclass(frozen=True, slots=True)
class Stop:
    """A device that is stopped, as far as the cell knows.

    Attributes:
        component: its hardware component, or the device behind an adapter.
        state: protective_stop, emergency_stop or fault: the recovery states of the spec.
        shown: how the cell knows: the state of the component, or that the device reports it.
    """

    component: str
    state: str
    shown: str

    def __str__(self) -> str:
        return f"hardware component {self.component} {self.shown}"


@dataclass(frozen=True, slots=True)
class StopChange:
    """A stop that a device reported while its component stayed active, or the end of one."""

    stamp_ns: int
    component: str
    state: str


class Stops:
    """Which components are stopped, why, whether what stopped them is over, and which of that the cell knows.

    A component whose lifecycle alone tells that it stopped is in protective stop where it is inactive, at fault else.

    Attributes:
        changes: what devices reported, and when.
    """

    def __init__(self, control: ControlStack) -> None:
        """Bind the stops to the managers that have the components."""
        self.changes: list[StopChange] = []
        self._control = control
        self._states: dict[str, str] = {}
        self._reported: set[str] = set()
        self._causes: dict[str, int] = {}

    def enter(self, component: str, state: str) -> None:
        """Name the state that a component stops in, the gravest where it stops twice; it lasts until ``end_cause``."""
        self._states[component] = min(state, self._states.get(component, state), key=_RANK.index)
        self._causes[component] = self._causes.get(component, 0) + 1

    def report(self, component: str, now_ns: int) -> None:
        """Let the cell hear of the stop of a component that stays active; of none there is nothing to hear."""
        if component in self._states and component not in self._reported:
            self._reported.add(component)
            self.changes.append(StopChange(now_ns, component, self._states[component]))

    def end_cause(self, component: str) -> None:
        """Let what stopped a component be over: it can be acknowledged from now on, and stays stopped until then."""
        self._causes[component] -= 1

    def present(self) -> tuple[Stop, ...]:
        """Return the stops that the cell knows of, the gravest first."""
        shown = {component: f"reports {self._states[component]}" for component in self._reported}
        shown |= {component: f"is {state}" for component, state in self._control.unready_hardware.items()}
        found = [Stop(component, self._state(component), how) for component, how in shown.items()]
        return tuple(sorted(found, key=lambda stop: (_RANK.index(stop.state), stop.component)))

    def _state(self, component: str) -> str:
        alone = PROTECTIVE_STOP if self._control.unready_hardware.get(component) == "inactive" else FAULT
        return self._states.get(component, alone)

    def state(self) -> str:
        """Return the safety state of the cell."""
        present = self.present()
        return present[0].state if present else NORMAL

    def lasting(self) -> tuple[Stop, ...]:
        """Return the stops that cannot be acknowledged, because their cause persists."""
        return tuple(stop for stop in self.present() if self._causes.get(stop.component, 0) > 0)

    def recover(self, now_ns: int) -> None:
        """Let every stopped component be active again; each begins from where its joints stand."""
        for stop in self.present():
            if stop.component in self._control.unready_hardware:
                for server in self._control.servers_of_component(stop.component):
                    server.disturbances.recover(stop.component)
            if stop.component in self._reported:
                self._reported.discard(stop.component)
                self.changes.append(StopChange(now_ns, stop.component, NORMAL))
            self._states.pop(stop.component, None)
