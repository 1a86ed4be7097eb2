"""Bring-up by readiness: what each step does, and the state, interface or transform that must show before it.

Stages: discover, configure, observe, claim; enable and move are taken by people. Starting the
processes is discovery; what follows here waits for proof, whatever order the processes came up in.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.cell.cell import Cell
from cellc.cell.control import Controller, ControllerManager
from cellc.cell.frame import WORLD, FrameKind
from cellc.cell.interface import TARGETS, InterfaceKind, Node
from cellc.deploy.processes import asks_for_motion, description_nodes, motion_clients
from cellc.link.derived import JOINT_STATE_TYPE

MOVE = "move"
"""Begins the name of the steps that wait for everything and then become the program behind them, one a target."""


@dataclass(frozen=True, slots=True)
class Step:
    """One step of the launch file.

    Args:
        stage: ``configure``, ``observe`` or ``claim``.
        name: name of the step, a word of a shell.
        waits_for: conditions, each a kind and its arguments: ``topic /joint_states``.
        command: what is done then.
        only: the one target on which it is taken; None for every target.
    """

    stage: str
    name: str
    host: str
    waits_for: tuple[str, ...]
    command: str
    only: str | None = None


def steps(cell: Cell) -> tuple[Step, ...]:
    """Return the steps in the order of their stages; each waits for its conditions, none for the one before it."""
    managed = [node for node in cell.nodes if node.lifecycle]
    spawned = [(manager, one) for manager in cell.managers for one in spawnings(manager)]
    return (
        *(_configure(cell, node) for node in managed),
        *(_observe(cell, manager, one) for manager, one in spawned if one.observing),
        *(_activate(cell, node) for node in managed if not asks_for_motion(cell, node)),
        *(_claim(cell, manager, one) for manager, one in spawned if one.claiming),
    )


def ready_to_move(cell: Cell, target: str) -> tuple[str, ...]:
    """Return what must show before a node that asks for motion is started: claims, actions, states.

    For the mock that no manager runs anything but the mock: a target is a word, and the description is what moves.
    """
    asking = {node.name for node in motion_clients(cell)}
    claimed = (
        f"controller {_node(manager)} {name} active"
        for manager in cell.managers
        for one in spawnings(manager)
        for name in (one.claiming if one.on(target) else ())
    )
    actions = (
        f"action {one.name}"
        for one in cell.interfaces
        if one.kind is InterfaceKind.ACTION and target in one.targets and any(end.node in asking for end in one.sinks)
    )
    mocked = (f"mocked {node}" for node in description_nodes(cell)) if target == "mock" else ()
    return (*mocked, *claimed, *actions, *_states(cell))


def activation(node: Node) -> str:
    """Return the command with which a person activates a managed node that asks for motion."""
    return f"ros2 lifecycle set {node.full_name} activate"


def _configure(cell: Cell, node: Node) -> Step:
    command = _transition(node, "configure")
    return Step("configure", f"configure_{node.name}", node.host, (f"node {node.full_name}",), command)


def _activate(cell: Cell, node: Node) -> Step:
    parents = dict.fromkeys(
        frame.parent for frame in cell.frames if frame.kind is FrameKind.DYNAMIC and frame.authority == node.name
    )
    waits_for = (f"lifecycle {node.full_name} inactive", *(f"transform {WORLD} {parent}" for parent in parents))
    return Step("observe", f"activate_{node.name}", node.host, waits_for, _transition(node, "activate"))


def _transition(node: Node, transition: str) -> str:
    # A daemon may not know of the node yet, and without one there must be time to find it.
    return f"ros2 lifecycle set --no-daemon --spin-time 2 {node.full_name} {transition}"


def _observe(cell: Cell, manager: ControllerManager, spawned: Spawning) -> Step:
    waits_for = tuple(f"controller {_node(manager)} {name} inactive" for name in spawned.controllers)
    name = f"observe_{manager.name}" + ("" if spawned.only is None else f"_{spawned.only}")
    return _switch(cell, manager, "observe", name, waits_for, spawned.observing, spawned.only)


def _claim(cell: Cell, manager: ControllerManager, spawned: Spawning) -> Step:
    waits_for = (
        *(f"controller {_node(manager)} {name} inactive" for name in spawned.claiming),
        *(f"topic {name}" for name in _joint_states(cell, manager)),
        *(f"transform {group.base_link} {group.tip_frame}" for group in cell.groups),
        *_states(cell),
    )
    name = f"claim_{manager.name}" + ("" if spawned.only is None else f"_{spawned.only}")
    return _switch(cell, manager, "claim", name, waits_for, spawned.claiming, spawned.only)


def _switch(
    cell: Cell,
    manager: ControllerManager,
    stage: str,
    name: str,
    waits_for: tuple[str, ...],
    controllers: tuple[str, ...],
    only: str | None,
) -> Step:
    # Strict: all of them or none, so that a cell is never half claimed.
    command = f"ros2 control switch_controllers --activate {' '.join(controllers)} --strict -c {_node(manager)}"
    return Step(stage, name, manager.host, waits_for, command, only)


def _joint_states(cell: Cell, manager: ControllerManager) -> Iterator[str]:
    own = {controller.full_name for controller in manager.controllers}
    for interface in cell.interfaces:
        if interface.type == JOINT_STATE_TYPE and any(end.full_name in own for end in interface.sources):
            yield interface.name


def _states(cell: Cell) -> Iterator[str]:
    for node in cell.nodes:
        if node.lifecycle and not asks_for_motion(cell, node):
            yield f"lifecycle {node.full_name} active"


def _node(manager: ControllerManager) -> str:
    return f"{manager.namespace}/controller_manager"


@dataclass(frozen=True, slots=True)
class Spawning:
    """What one spawner loads and configures, and what is activated of it; alternates are never.

    Args:
        controllers: all that the spawner is given.
        observing: those to activate that read states and claim nothing.
        claiming: those to activate that claim command interfaces.
        only: the one target on which they are spawned; None for every target. On the others their hardware is no
            component, or lacks what they need, and a spawner would fail.
    """

    controllers: tuple[str, ...]
    observing: tuple[str, ...]
    claiming: tuple[str, ...]
    only: str | None

    def on(self, target: str) -> bool:
        """Tell whether it is started on a target."""
        return self.only in (None, target)


def spawnings(manager: ControllerManager) -> Iterator[Spawning]:
    """Yield what the spawners of a manager are given, in order; the first failure in a list stops the rest of it."""
    for only in (None, *TARGETS):
        controllers = [one for one in manager.controllers if _only_target(one) == only]
        if controllers:
            active = [one for one in controllers if one.active]
            yield Spawning(
                tuple(one.name for one in controllers),
                tuple(one.name for one in active if not one.command_interfaces),
                tuple(one.name for one in active if one.command_interfaces),
                only,
            )


def _only_target(controller: Controller) -> str | None:
    """Return the one target on which a controller is spawned, or None for one that is spawned on every target."""
    return controller.targets[0] if len(controller.targets) == 1 else None
