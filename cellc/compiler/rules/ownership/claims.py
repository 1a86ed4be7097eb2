"""Rules on which controller claims what."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import combinations

from cellc.compiler.cell.control import Controller
from cellc.compiler.graph.claims import ControlState, adapter_of_group, can_switch
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, did_you_mean, found, rule


@rule(Severity.ERROR, assumes=("shared-prefix",))
def double_claim(graph: CellGraph) -> Findings:
    """Yield the second claimant of an interface in the first state of a manager."""
    for conflict in graph.claims.conflicts():
        if not conflict.state.switches:
            first, second = conflict.first, conflict.second
            message = f"`{second.name}` and `{first.name}` both claim `{conflict.interface}` from the start"
            related = (Related("first claimed here", first.span),)
            yield found(graph, second.path, message, related=related)


@rule(Severity.ERROR)
def double_claim_after_switch(graph: CellGraph) -> Findings:
    """Yield the switch that leads into a state with two claimants, with the way to that state."""
    for conflict in graph.claims.conflicts():
        if not conflict.state.switches:
            continue
        first, second = conflict.first, conflict.second
        way = " → ".join(f"`{name}`" for name in ("start", *conflict.state.switches))
        message = f"after {way} both `{first.name}` and `{second.name}` claim `{conflict.interface}`"
        manager = next(m for m in graph.cell.managers if m.name == conflict.state.manager)
        path = (*manager.path, "switches", conflict.state.switches[-1])
        related = (Related("first claimed here", first.span), Related("claimed again here", second.span))
        yield found(graph, path, message, f"deactivate `{first.name}` in the same switch", related)


@rule(Severity.ERROR, assumes=("wrong-joint-count",))
def group_joints_without_controller(graph: CellGraph) -> Findings:
    """Yield groups with joints that are in none of their controllers."""
    for group in graph.cell.groups:
        controllers = graph.cell.controllers_for(group)
        moved = {joint for controller in controllers for joint in controller.joints}
        missing = [joint for joint in group.joints if joint not in moved]
        if controllers and missing:
            names = ", ".join(f"`{joint}`" for joint in missing)
            message = f"group `{group.name}` plans for {names}, which `{controllers[0].name}` does not move"
            related = (Related("the group is here", group.span),)
            path = (*controllers[0].path, "joints")
            yield found(graph, path, message, related=related)


@rule(Severity.ERROR, assumes=("wrong-joint-count",))
def group_without_controller(graph: CellGraph) -> Findings:
    """Yield groups whose joints neither a controller nor an adapter with an action moves."""
    for group in graph.cell.groups:
        if group.joints and not group.controllers and adapter_of_group(graph.cell, group) is None:
            message = f"no controller takes trajectories for the joints of group `{group.name}`"
            yield found(graph, group.path, message)


@rule(Severity.WARNING, assumes=("double-claim", "double-claim-after-switch", "impossible-switch"))
def idle_controller(graph: CellGraph) -> Findings:
    """Yield controllers that are active in no reachable state."""
    for manager in graph.cell.managers:
        active = graph.claims.ever_active(manager.name)
        for controller in manager.controllers:
            if controller.name not in active:
                message = f"controller `{controller.name}` starts inactive and no switch activates it"
                related = (Related("it starts inactive", graph.cell.locate(*controller.path, "active")),)
                yield found(graph, controller.path, message, related=related)


@rule(Severity.ERROR, assumes=("double-claim", "two-interfaces-of-one-joint"))
def impossible_switch(graph: CellGraph) -> Findings:
    """Yield switches that no reachable state allows."""
    for manager in graph.cell.managers:
        states = graph.claims.states_of.get(manager.name, ())
        active = [frozenset(controller.name for controller in state.active) for state in states]
        for switch in manager.switches:
            if not any(can_switch(names, switch) for names in active):
                message = f"switch `{switch.name}` cannot be carried out in any state that the cell reaches"
                yield found(graph, switch.path, message)


@rule(Severity.ERROR, assumes=("own-motion-at-start", "double-claim-after-switch", "two-interfaces-of-one-joint"))
def refused_command_modes(graph: CellGraph) -> Findings:
    """Yield the switch that leads to two controllers whose command modes exclude each other, once for a pair."""
    seen: set[tuple[str, str, str]] = set()
    for state in graph.claims.states:
        for first, second, device, modes in _refused_modes(graph, state):
            pair = (state.manager, first.name, second.name)
            if pair in seen:
                continue
            seen.add(pair)
            manager = next(manager for manager in graph.cell.managers if manager.name == state.manager)
            path = (*manager.path, "switches", state.switches[-1]) if state.switches else second.path
            way = " → ".join(f"`{name}`" for name in ("start", *state.switches))
            message = f"after {way} both `{first.name}` and `{second.name}` are active, but `{device}` takes {modes}"
            related = (Related("one is here", first.span), Related("the other is here", second.span))
            yield found(graph, path, message, f"deactivate `{first.name}` in the same switch", related)


def _owners(graph: CellGraph) -> Mapping[str, tuple[int, ...]]:
    """Return which devices of the cell, by their place in it, have a joint or a mode of a name."""
    owners: dict[str, list[int]] = {}
    for at, device in enumerate(graph.cell.devices):
        modes = None if device.control.hardware is None else device.control.hardware.modes
        for name in {*(joint.name for joint in device.joints), *modes.names} if modes is not None else ():
            owners.setdefault(name, []).append(at)
    return {name: tuple(places) for name, places in owners.items()}


def _refused_modes(graph: CellGraph, state: ControlState) -> Iterator[tuple[Controller, Controller, str, str]]:
    """Yield pairs of active controllers that no driver runs together, with the device and its two modes."""
    claiming: dict[str, dict[str, Controller]] = {}
    for controller in state.active:
        for claim in controller.claims("real") if "real" in controller.targets else ():
            claiming.setdefault(claim.rpartition("/")[0], {})[controller.label] = controller
    order = {controller.label: number for number, controller in enumerate(state.active)}
    owners = graph.once(_owners)
    for device in (graph.cell.devices[at] for at in sorted({at for name in claiming for at in owners.get(name, ())})):
        modes = None if device.control.hardware is None else device.control.hardware.modes
        if modes is None:
            continue
        joints = {joint.name for joint in device.joints}
        ours = {label for owner in (*joints, *modes.names) for label in claiming.get(owner, ())}
        active = [state.active[number] for number in sorted(order[label] for label in ours)]
        taken = [(controller, modes.of(controller.claims("real"), joints)) for controller in active]
        for (first, first_modes), (second, others) in combinations(taken, 2):
            refused = ((a, b) for a in sorted(first_modes) for b in sorted(others) if not modes.allow(a, b))
            if (pair := next(refused, None)) is not None:
                yield first, second, device.name, f"`{pair[0]}` or `{pair[1]}`"


@rule(Severity.ERROR, assumes=("double-claim", "shared-prefix"))
def two_interfaces_of_one_joint(graph: CellGraph) -> Findings:
    """Yield each second controller of a joint in a state that the cell reaches, once for a pair."""
    joints = graph.cell.joints_by_name
    seen: set[tuple[str, str, str]] = set()
    for state in graph.claims.states:
        owners: dict[str, tuple[str, Controller]] = {}
        for controller in state.active:
            for interface in controller.command_interfaces:
                joint, _, kind = interface.rpartition("/")
                other_kind, owner = owners.setdefault(joint, (kind, controller))
                pair = (state.manager, owner.name, controller.name)
                if joint not in joints or owner is controller or pair in seen or other_kind == kind:
                    continue
                seen.add(pair)
                when = f" after `{'`, `'.join(state.switches)}`" if state.switches else " from the start"
                message = f"`{controller.name}` commands the {kind} of `{joint}` while `{owner.name}` commands its"
                related = (Related("commanded here too", owner.span),)
                yield found(graph, controller.path, f"{message} {other_kind},{when}", related=related)


@rule(Severity.ERROR)
def unprovided_command_interface(graph: CellGraph) -> Findings:
    """Yield controllers with claims that no joint, sensor or gpio of the cell provides, one finding a controller."""
    provided = {
        f"{joint.name}/{name}"
        for device in graph.cell.devices
        for joint in device.joints
        for name in joint.command_interfaces
    }
    for device in graph.cell.devices:
        for gpio in device.control.hardware.gpios if device.control.hardware is not None else ():
            provided |= {f"{gpio.name}/{name}" for name in gpio.command_interfaces}
    for controller in graph.cell.controllers:
        missing = [claim for claim in controller.all_claims if claim not in provided]
        if missing:
            more = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
            message = f"`{controller.name}` claims `{missing[0]}`{more}, which no hardware provides"
            joint = missing[0].rpartition("/")[0]
            path = (*controller.path, "command_interfaces")
            yield found(graph, path, message, _provided(graph, path, missing[0], joint, provided))


def _provided(graph: CellGraph, path: YamlPath, claim: str, joint: str, provided: Iterable[str]) -> str:
    """Write what there is for a joint: in the place of what is written, or for a choice of another controller."""
    kinds = sorted(name.rpartition("/")[2] for name in provided if name.startswith(f"{joint}/"))
    if graph.cell.states(*path) or not kinds:
        return did_you_mean(claim.rpartition("/")[2], kinds, f"command interfaces of `{joint}`")
    return f"use a controller that claims {' or '.join(f'`{joint}/{kind}`' for kind in kinds)}"
