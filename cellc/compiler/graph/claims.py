"""Who commands what: claims of controllers at start and after every switch, and devices behind adapters.

Parameters that the user wrote for a controller stand here too, apart from those that follow from its kind.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Container, Iterator, Mapping
from functools import cached_property

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import AdaptedDevice, Controller, ControllerManager, ControllerSwitch
from cellc.compiler.cell.interface import ParameterValue
from cellc.compiler.cell.motion import PlanningGroup
from cellc.contract.diagnostics import YamlPath
from cellc.contract.frozen import dataclass

_MAX_STATES = 4096  # twelve independent switches; a cell has two or three


@dataclass(frozen=True, slots=True)
class ControlState:
    """Controllers that are active together.

    Args:
        manager: key of their manager.
        switches: names of the switches that lead here from the start, in order; empty at the start.
        active: controllers in the order of the spec.
    """

    manager: str
    switches: tuple[str, ...]
    active: tuple[Controller, ...]

    def claims(self) -> Mapping[str, tuple[Controller, ...]]:
        """Return the controllers that claim each command interface in this state."""
        claims: dict[str, list[Controller]] = {}
        for controller in self.active:
            for interface in controller.all_claims:
                claims.setdefault(interface, []).append(controller)
        return {interface: tuple(owners) for interface, owners in claims.items()}


@dataclass(frozen=True, slots=True)
class ClaimConflict:
    """Two controllers that would own one command interface in a state that can be reached."""

    state: ControlState
    interface: str
    first: Controller
    second: Controller


# Without slots, so that the states are sorted by manager when they are first asked for.
@dataclass(frozen=True)
class ClaimGraph:
    """Every state of every controller manager that its declared switches can reach."""

    states: tuple[ControlState, ...]

    @cached_property
    def states_of(self) -> Mapping[str, tuple[ControlState, ...]]:
        """States of each manager, by its key."""
        by_manager: dict[str, list[ControlState]] = {}
        for state in self.states:
            by_manager.setdefault(state.manager, []).append(state)
        return {manager: tuple(states) for manager, states in by_manager.items()}

    def at_start(self) -> tuple[ControlState, ...]:
        """Return the first state of each manager."""
        return tuple(state for state in self.states if not state.switches)

    def conflicts(self) -> Iterator[ClaimConflict]:
        """Yield each pair of controllers once, in the first state and at the first interface where they collide."""
        seen: set[tuple[str, str, str]] = set()
        for state in self.states:
            for interface, owners in state.claims().items():
                for second in owners[1:]:
                    pair = (state.manager, owners[0].name, second.name)
                    if pair not in seen:
                        seen.add(pair)
                        yield ClaimConflict(state, interface, owners[0], second)

    def ever_active(self, manager: str) -> frozenset[str]:
        """Name the controllers of a manager that are active in some state."""
        return frozenset(c.name for state in self.states_of.get(manager, ()) for c in state.active)


def build_claims(cell: Cell) -> ClaimGraph:
    """Explore the states of each manager, nearest to the start first."""
    return ClaimGraph(tuple(state for manager in cell.managers for state in explore(manager)))


def claimed_by_device(cell: Cell, controller: Controller) -> Mapping[str, tuple[str, ...]]:
    """Return what a controller claims on any target, by device; what no description lists is of its own device."""
    claims: dict[str, list[str]] = {}
    for interface in controller.all_claims:
        holder = cell.holders.get(interface.rpartition("/")[0], controller.device)
        if holder is not None:
            claims.setdefault(holder, []).append(interface)
    return {holder: tuple(interfaces) for holder, interfaces in claims.items()}


def can_switch(active: frozenset[str], switch: ControllerSwitch) -> bool:
    """Tell whether a strict switch is carried out: what it stops is active, what it starts is not.

    A controller in both lists is restarted. Source: controller_manager, switch_controller with STRICT strictness.
    """
    starts = set(switch.activate) - set(switch.deactivate)
    return active.issuperset(switch.deactivate) and active.isdisjoint(starts)


def explore(manager: ControllerManager) -> Iterator[ControlState]:
    """Yield the states that the declared switches of a manager reach, by fewest switches first."""
    start = frozenset(controller.name for controller in manager.controllers if controller.active)
    queue: deque[tuple[frozenset[str], tuple[str, ...]]] = deque([(start, ())])
    seen = {start}
    while queue:
        active, switches = queue.popleft()
        state = ControlState(manager.name, switches, tuple(c for c in manager.controllers if c.name in active))
        yield state
        if any(len(owners) > 1 for owners in state.claims().values()):
            continue  # the controller manager refuses this state, nothing is reached through it
        for switch in manager.switches:
            after = (active - set(switch.deactivate)) | set(switch.activate)
            if can_switch(active, switch) and after not in seen and len(seen) < _MAX_STATES:
                seen.add(after)
                queue.append((after, (*switches, switch.name)))


@dataclass(frozen=True, slots=True)
class WrittenParameter:
    """One parameter with the controller that it goes to and the place where it is written."""

    controller: Controller
    name: str
    value: ParameterValue
    path: YamlPath

    def items(self) -> Iterator[tuple[YamlPath, ParameterValue]]:
        """Yield each item of a list with its place, or the value itself."""
        if isinstance(self.value, tuple):
            yield from (((*self.path, index), item) for index, item in enumerate(self.value))
        else:
            yield self.path, self.value


def written_parameters(cell: Cell) -> Iterator[WrittenParameter]:
    """Yield every parameter under ``parameters:`` of a controller."""
    for controller in cell.controllers:
        for name, value in controller.written_parameters.items():
            yield WrittenParameter(controller, name, value, (*controller.path, "parameters", name))


def adapter_of_group(cell: Cell, group: PlanningGroup) -> AdaptedDevice | None:
    """Return the adapted device that moves every joint of a group, or None."""
    if not group.joints:
        return None
    return next((adapted for adapted in cell.adapters if set(group.joints) <= set(adapted.joints)), None)


def crosses_an_adapter(cell: Cell, parent: str, child: str) -> bool:
    """Tell whether a joint of a device behind an adapter lies between two frames, the child below the parent."""
    return crosses_a_joint(cell, parent, child, {adapted.device for adapted in cell.adapters})


def crosses_a_joint(cell: Cell, parent: str, child: str, devices: Container[str]) -> bool:
    """Tell whether a joint of some devices lies between two frames, the child below the parent."""
    frames, frame = cell.frames_by_name, child
    while frame != parent and frame in frames:
        device = frames[frame].device
        if frames[frame].moving and device is not None and device in devices:
            return True
        frame = frames[frame].parent
    return False
