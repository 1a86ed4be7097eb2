"""The hardware components of the manager and their life cycles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellc.mock.control.controllers.plugins import HARDWARE_BEHAVIORS
from cellc.mock.control.errors import DescriptionError
from cellc.mock.control.hardware import Disturbances, GenericSystem
from cellc.mock.control.hardware.forces import Forces
from cellc.mock.control.interfaces import Array, InterfaceTable, Times
from cellc.mock.control.log import Log
from cellc.mock.control.messages import ControlEvent, HardwareChanged, HardwareStateResponse
from cellc.mock.control.robot_description import JointLimits, RobotDescription, joint_limits

_STATES = ("unconfigured", "inactive", "active", "finalized")
_LOGGER = "resource_manager"
# The line about disabled commands is written in every cycle in reality; once is enough to be seen.
_THROTTLE_NS = 1_000_000_000_000_000


@dataclass(slots=True)
class Component:
    """One component with its lifecycle state and the time of its last read."""

    system: GenericSystem
    state: str
    last_read_ns: int | None = None

    @property
    def name(self) -> str:
        """Name of the component."""
        return self.system.info.name

    @property
    def available(self) -> bool:
        """Whether its interfaces can be used."""
        return self.state in ("inactive", "active")


class HardwareSet:
    """All components.

    Args:
        description: the robot description.
        table: where interfaces are exported to.
        disturbances: faults.
        log: the log.
        events: receives changes.
        forces: what moves the joints; None where they are where they are led to.

    Raises:
        DescriptionError: a component cannot be loaded or initialized.
    """

    def __init__(
        self,
        description: RobotDescription,
        table: InterfaceTable,
        disturbances: Disturbances,
        log: Log,
        events: list[ControlEvent],
        forces: Forces | None = None,
    ) -> None:
        self._forces = forces
        self._log = log
        self._events = events
        self._disturbances = disturbances
        self._table = table
        self.components: dict[str, Component] = {}
        self._owners: dict[str, Component] = {}
        for info in description.components:
            if info.name in self.components:
                raise DescriptionError(
                    f"Hardware name {info.name} is duplicated. Please provide a unique 'name' in the URDF."
                )
            _check_plugin(info.type, info.plugin)
            self.components[info.name] = Component(self._initialize(info.name, description), "active")
        for component in self.components.values():
            for name in (*component.system.command_names, *component.system.state_names):
                self._owners.setdefault(name, component)

    def _initialize(self, name: str, description: RobotDescription) -> GenericSystem:
        info = next(info for info in description.components if info.name == name)
        try:
            return GenericSystem(info, description.joints, self._table, self._disturbances, self._forces)
        except ValueError as error:
            self._log.error(
                _LOGGER,
                f"Exception of type : St16invalid_argument occurred while initializing hardware '{name}': {error}",
            )
            raise DescriptionError(
                f"System hardware component '{name}' from plugin '{info.plugin}' failed to initialize."
            ) from None

    def set_initial(self, unconfigured: tuple[str, ...], inactive: tuple[str, ...]) -> None:
        """Bring components into the states that the parameters ask for."""
        for state, names in (("unconfigured", unconfigured), ("inactive", inactive)):
            for name in names:
                if name in self.components:
                    self._enter(self.components[name], state)
                else:
                    self._log.warn(
                        "controller_manager",
                        f"Hardware component '{name}' is unknown, therefore not set in '{state}' state.",
                    )

    def _enter(self, component: Component, state: str) -> None:
        """Bring a component into a state: it exports its interfaces from its configuration on."""
        component.state = state
        exported = {name for name in component.system.state_names if self._owners[name] is component}
        self._table.absent = self._table.absent - exported if component.available else self._table.absent | exported

    def owner(self, interface: str) -> Component | None:
        """The component that exports an interface."""
        return self._owners.get(interface)

    def is_available(self, interface: str) -> bool:
        """Whether an interface can be used now."""
        owner = self._owners.get(interface)
        return owner is not None and owner.available

    def set_state(self, name: str, state: str) -> HardwareStateResponse:
        """Answer set_hardware_component_state."""
        component = self.components.get(name)
        if component is None:
            self._log.error(_LOGGER, f"hardware component with name '{name}' does not exist")
            return HardwareStateResponse(False)
        if component.state == "finalized" and state != "finalized":
            self._log.warn(_LOGGER, f"hardware '{name}' is in finalized state and can be only destroyed.")
            return HardwareStateResponse(False, component.state)
        if state not in _STATES:
            return HardwareStateResponse(False, component.state)
        if component.state != state:
            if not component.available:
                component.last_read_ns = None
            self._enter(component, state)
            self._events.append(HardwareChanged(self._log.now_ns, name, state))
        return HardwareStateResponse(True, state)

    def fail(self, component: Component, reason: str) -> None:
        """A read or write returned an error: one that is handled leaves the component unconfigured, else finalized."""
        self._enter(component, "unconfigured" if self._disturbances.is_lost(component.name) else "finalized")
        component.last_read_ns = None
        self._log.error(_LOGGER, reason)
        self._events.append(HardwareChanged(self._log.now_ns, component.name, component.state, reason))

    def stand(self, name: str) -> None:
        """Let the position commands of a component be where its joints stand."""
        component = self.components.get(name)
        if component is None:
            return
        for interface in component.system.command_names:
            if interface.endswith("/position") and self._table.has_state(interface):
                position = self._table.state[self._table.state_column(interface)]
                self._table.command[self._table.command_column(interface)] = position

    def place(self, joint: str, position: float) -> None:
        """Move a joint from outside; its velocity is zero, as that of a joint which nothing commands."""
        component = self.owner(f"{joint}/position")
        if component is not None:
            component.system.place(joint, position)

    def rest(self, name: str) -> None:
        """Let the joints of a component stand still where they are."""
        if name in self.components:
            self.components[name].system.rest()

    def refusal(self, component: Component) -> str:
        """Why a component refuses the claim that is asked for now; empty where it does not."""
        return self._disturbances.take_refusal(component.name)

    # -- cycles ------------------------------------------------------------------------------------------------------

    def read(self, time_ns: int, period_ns: int, rate: int) -> list[Component]:
        """Read all components once; returns those whose read failed."""
        failed: list[Component] = []
        led: list[tuple[Component, int]] = []
        for component in self.components.values():
            if not component.available or not _reads_in_cycle(component, time_ns, rate):
                continue
            if self._disturbances.take_read_failure(component.name):
                failed.append(component)
                continue
            since = period_ns if component.last_read_ns is None else time_ns - component.last_read_ns
            component.last_read_ns = time_ns
            if component.system.commands_disabled and self._log.throttle(f"disabled {component.name}", _THROTTLE_NS):
                self._log.warn(component.name, "Command propagation is disabled - no values will be returned!")
            component.system.lead(self._table.command[None, :], since)
            led.append((component, since))
        if self._forces is not None:
            self._forces.advance(np.array([time_ns], dtype=np.int64))
        for component, since in led:
            state = self._table.state[None, :].copy()
            component.system.show(self._table.command[None, :], state, since)
            component.system.commit(1)
            self._table.state[:] = state[0]
        if self._forces is not None:
            self._forces.commit(1)
        return failed

    def read_ahead(self, command: Array, state: Array, times_ns: Times, period_ns: int) -> int:
        """Compute the states of successive cycles; return how many could be computed: all, or none.

        Args:
            command: all command interfaces before the read of each cycle, shape (cycles, commands).
            state: all state interfaces, shape (cycles, states), filled with the present ones; written in place.
            times_ns: of the cycles.
            period_ns: time between two cycles.
        """
        systems = [component.system for component in self.components.values() if component.available]
        led = [system.lead(command, period_ns) for system in systems]
        if not all(led):
            return 0
        if self._forces is not None:
            self._forces.advance(times_ns)
        for system in systems:
            system.show(command, state, period_ns)
        return len(command)

    def commit(self, cycles: int, time_ns: int) -> None:
        """Adopt the first of the cycles that were computed ahead, of which the last is at a time."""
        for component in self.components.values():
            if component.available:
                component.system.commit(cycles)
                component.last_read_ns = time_ns
        if self._forces is not None:
            self._forces.commit(cycles)

    def write(self) -> list[Component]:
        """Write all components once; returns those whose write failed: an infinite command does that."""
        failed = []
        for component in self.components.values():
            if not component.available:
                continue
            names = component.system.command_names
            infinite = bool(names) and bool(np.isinf(self._table.command[self._table.command_columns(names)]).any())
            if self._disturbances.take_write_failure(component.name) or infinite:
                failed.append(component)
        return failed

    def single_cycles_only(self, rate: int) -> bool:
        """Whether a component reads more rarely than the manager cycles, or joints have other owners too."""
        if self._forces is not None and self._forces.shared:
            return True
        return any(0 < component.system.info.rw_rate < rate for component in self.components.values())


def _reads_in_cycle(component: Component, time_ns: int, rate: int) -> bool:
    rw_rate = component.system.info.rw_rate
    if rw_rate == 0 or rw_rate >= rate or component.last_read_ns is None:
        return True
    # The factor is the one that the manager uses for its controllers.
    return (time_ns - component.last_read_ns) / 1e9 * rw_rate >= 0.99


def _check_plugin(kind: str, plugin: str) -> None:
    if kind not in ("system", "actuator", "sensor"):
        raise DescriptionError("Discrepancy between robot description file (urdf) and actually exported HW interfaces.")
    if kind != "system" or plugin not in HARDWARE_BEHAVIORS:
        known = ", ".join(HARDWARE_BEHAVIORS)
        raise DescriptionError(
            "Caught exception of type : N9pluginlib20LibraryLoadExceptionE while loading hardware: According to the "
            f"loaded plugin descriptions the class {plugin} with base class type "
            f"hardware_interface::{kind.capitalize()}Interface does not exist. (cellc executes {known} alone.)"
        )


def all_limits(description: RobotDescription) -> dict[str, JointLimits]:
    """Limits of the joints that stand in a component."""
    return {
        part.name: joint_limits(description.joints[part.name], part)
        for info in description.components
        for part in info.joints
    }
