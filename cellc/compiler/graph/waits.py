"""Times that are waited, each with what it waits for."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import Interface
from cellc.compiler.graph.time_pairs import (
    Pair,
    controllers_of,
    cycles_hz,
    number_of,
    parameter_of,
    rate_path,
    shown,
    topics_of,
)
from cellc.contract.vocabulary import InterfaceKind

MONITOR = "action_monitor_rate"
EXECUTING = frozenset({"moveit_msgs/action/MoveGroup", "moveit_msgs/action/ExecuteTrajectory"})
"""Actions behind which controllers move."""


def waits_for_sensors(cell: Cell) -> Iterator[Pair]:
    """A client waits for the sensors of a switched device at least as long as its way takes."""
    for device in cell.devices:
        switched, path = device.switched, (*device.path, "switching")
        if switched is not None and switched.inputs:
            because = f"the time of its way, {shown(switched.time_s)}"
            places = (("the way is here", (*path, "time")),)
            yield Pair(
                (*path, "within"), f"`within` of `{device.name}`", switched.within_s, switched.time_s, because, places
            )


def monitors(cell: Cell) -> Iterator[Pair]:
    """A controller answers a cancel when its monitor looks: at least once within the bound of a cancel."""
    rehearsed = ((run.within_s, (*run.path, "within")) for run in cell.rehearsals if run.expect == "canceled")
    overall = ((cell.kpis.cancel_s, ("kpis", "cancel")), *rehearsed)
    by_name, by_server = _actions(cell)
    for controller in cell.controllers:
        rate = number_of(parameter_of(cell, controller, MONITOR))
        if not rate or controller.action is None:
            continue
        ours = (*by_name.get(controller.action, ()), *by_server.get(controller.client or "", ()))
        bounds = ((action.cancel_within_s, (*action.path, "cancel_within")) for action in ours)
        within = [(bound_s, path) for bound_s, path in (*bounds, *overall) if bound_s]
        if within:
            bound_s, place = min(within)
            path = (*controller.path, "parameters", MONITOR)
            subject = f"the answer of `{controller.name}` to a cancel, one period of its `{MONITOR}` of {rate:g} Hz,"
            stated = cell.states(*path)
            at, other = (
                (path, ("the bound is here", place)) if stated else (place, ("the controller is here", controller.path))
            )
            yield Pair(at, subject, 1.0 / rate, bound_s, "the bound of a cancel", (other,))


_Actions = Mapping[str, Sequence[Interface]]


def _actions(cell: Cell) -> tuple[_Actions, _Actions]:
    """Return the actions of the spec by their names, and by the nodes that execute them."""
    by_name: dict[str, list[Interface]] = {}
    by_server: dict[str, list[Interface]] = {}
    for action in cell.interfaces:
        if action.kind is InterfaceKind.ACTION and not action.derived:
            by_name.setdefault(action.name, []).append(action)
            for end in action.sources:
                by_server.setdefault(end.node, []).append(action)
    return by_name, by_server


def stops(cell: Cell) -> Iterator[Pair]:
    """A loop of an adapter hears a cancel in its next cycle, and then takes its time to stand still."""
    by_name, _ = _actions(cell)
    for adapted in cell.adapters:
        places = (("the time is here", (*cell.device(adapted.device).path, "adapter", "stop_time")),)
        because = f"a cycle and the time to standstill of `{adapted.device}`"
        for action in by_name.get(adapted.action, ()):
            needed_s = adapted.command_period_s + adapted.stop_time_s
            path, subject = (*action.path, "cancel_within"), f"`cancel_within` of `{action.name}`"
            if action.cancel_within_s is not None:
                yield Pair(path, subject, action.cancel_within_s, needed_s, because, places)


def _nested(cell: Cell, key: str, of: Callable[[Interface], float | None]) -> Iterator[Pair]:
    """An action whose server calls another one is bounded no tighter than that one."""
    _, by_server = _actions(cell)
    inner_ones = (action for actions in by_server.values() for action in actions)
    for inner in dict.fromkeys(inner_ones):
        for outer in (action for end in inner.sinks for action in by_server.get(end.node, ()) if action is not inner):
            own, called = of(outer), of(inner)
            if own and called:
                because = f"that of `{inner.name}`, which it waits for"
                places = (("that one is here", (*inner.path, key)),)
                yield Pair((*outer.path, key), f"`{key}` of `{outer.name}`", own, called, because, places)


def inner_timeouts(cell: Cell) -> Iterator[Pair]:
    """A whole goal takes at least as long as the goal that it waits for."""
    yield from _nested(cell, "timeout", lambda interface: interface.timeout_s)


def goal_times(cell: Cell) -> Iterator[Pair]:
    """A whole goal takes at least as long as a controller may take past the end of its trajectory."""
    by_name, by_server = _actions(cell)
    for controller in cell.controllers if by_name else ():
        called = (action for action in by_server.get(controller.client or "", ()) if action.type in EXECUTING)
        for action in (*by_name.get(controller.action or "", ()), *called) if controller.goal_time_s else ():
            because = f"the time that `{controller.name}` allows past the end of a trajectory"
            places = (("that time is here", (*controller.path, "goal_time")),)
            path, subject = (*action.path, "timeout"), f"`timeout` of `{action.name}`"
            if action.timeout_s is not None:
                yield Pair(path, subject, action.timeout_s, controller.goal_time_s or 0.0, because, places)


def own_goal_times(cell: Cell) -> Iterator[Pair]:
    """A whole goal takes at least as long as an adapter, or fingers that stall, may take past its end."""
    actions = {interface.name: interface for interface in cell.interfaces if interface.timeout_s}
    taken = [
        (adapted.action, adapted.goal_time_s, (*cell.device(adapted.device).path, "adapter", "goal_time"))
        for adapted in cell.adapters
    ]
    for controller in cell.controllers:
        stalled_s = number_of(parameter_of(cell, controller, STALL))
        if controller.action is not None and stalled_s:
            taken.append((controller.action, stalled_s, (*controller.path, "parameters", STALL)))
    for action, needed_s, place in taken:
        if action in actions:
            path, subject = (*actions[action].path, "timeout"), f"`timeout` of `{action}`"
            timeout_s, because = actions[action].timeout_s or 0.0, "the time that its server takes past the end"
            yield Pair(path, subject, timeout_s, needed_s, because, (("that time is here", place),))


STALL = "stall_timeout"


def inner_cancels(cell: Cell) -> Iterator[Pair]:
    """A cancel reaches the inner goal through the outer one."""
    yield from _nested(cell, "cancel_within", lambda interface: interface.cancel_within_s)


def solvers(cell: Cell) -> Iterator[Pair]:
    """One solution of the inverse kinematics is a part of planning."""
    target_s = cell.kpis.plan_to_execute_s
    for group in cell.groups if target_s is not None else ():
        because = "the target from plan to execution"
        places = (("the target is here", ("kpis", "plan_to_execute")),)
        yield Pair(
            (*group.path, "ik_timeout"),
            f"`ik_timeout` of `{group.name}`",
            group.solver.timeout_s,
            target_s or 0.0,
            because,
            places,
        )


def rehearsed(cell: Cell) -> Iterator[Pair]:
    """A rehearsal ends after the waits that it is made of, and later than what it must end within."""
    for rehearsal in cell.rehearsals:
        path = (*rehearsal.path, "timeout")
        waited_s = sum(step.duration_s or 0.0 for step in rehearsal.steps)
        subject = f"`timeout` of `{rehearsal.name}`"
        if waited_s and not rehearsal.faults:
            yield Pair(
                path,
                subject,
                rehearsal.timeout_s,
                waited_s,
                "the sum of its waits",
                (("it waits here", rehearsal.path),),
            )
        if rehearsal.within_s is not None:
            places = (("it is bounded here", (*rehearsal.path, "within")),)
            yield Pair(path, subject, rehearsal.timeout_s, rehearsal.within_s, "what it must end `within`", places)


def servo_timeouts(cell: Cell) -> Iterator[Pair]:
    """Servo halts after a silence: a command must come in time, and be sent on before the next one."""
    servo, path = cell.servo, ("motion", "servo")
    if servo is not None:
        halted = f"the silence after which it halts, {shown(servo.command_timeout_s)}"
        places = (("the silence is here", (*path, "command_timeout")),)
        yield Pair(
            (*path, "period"),
            "`period` of Servo",
            servo.period_s,
            servo.command_timeout_s / 2.0,
            f"half of {halted}",
            places,
        )


def servo_commands(cell: Cell) -> Iterator[Pair]:
    """Servo waits for two commands at least, so that one that is late halts nothing."""
    servo, path = cell.servo, ("motion", "servo", "command_timeout")
    for topic in topics_of(cell) if servo is not None else ():
        heard = servo is not None and any(sink.node == servo.node for sink in topic.sinks)
        if servo is not None and heard and topic.type in SERVO_COMMANDS and topic.rate_hz:
            because = f"two periods of `{topic.name}`, {topic.rate_hz:g} Hz"
            places = (("its rate is here", (*topic.path, "rate")),)
            subject = "`command_timeout` of Servo"
            yield Pair(path, subject, servo.command_timeout_s, 2.0 / topic.rate_hz, because, places)


SERVO_COMMANDS = frozenset(
    {"control_msgs/msg/JointJog", "geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/TwistStamped"}
)
"""Types of the topics by which Servo is commanded."""


def servo_periods(cell: Cell) -> Iterator[Pair]:
    """The manager takes one command of Servo in each of its cycles; the others are lost."""
    for manager, controller in controllers_of(cell):
        if cell.servo is not None and cell.servo.controller == controller.full_name:
            cycle_s, path = 1.0 / cycles_hz(manager, controller), ("motion", "servo", "period")
            because = f"a cycle of `{controller.name}`"
            yield Pair(
                path,
                "`period` of Servo",
                cell.servo.period_s,
                cycle_s,
                because,
                (("its manager", rate_path(cell, manager, controller)),),
            )


def adapters(cell: Cell) -> Iterator[Pair]:
    """The watchdog of a loop waits for two commands at least, so that one that is late stops nothing."""
    topics = {topic.name: topic for topic in topics_of(cell)} if cell.adapters else {}
    for adapted in (adapted for adapted in cell.adapters if adapted.command_timeout_s > 0.0):
        path = (*cell.device(adapted.device).path, "adapter", "command_timeout")
        places = (("the period is here", (*topics[adapted.state_topic].path, "rate")),)
        because = f"two periods of its commands, {shown(adapted.command_period_s)} each"
        subject = f"`command_timeout` of `{adapted.device}`"
        yield Pair(path, subject, adapted.command_timeout_s, 2.0 * adapted.command_period_s, because, places)


def managers(cell: Cell) -> Iterator[Pair]:
    """A vendor's watchdog hears two cycles of a manager at least."""
    for manager in cell.managers:
        for device in map(cell.device, manager.devices):
            hardware = device.control.hardware
            if hardware is not None and hardware.command_timeout_s and "real" in hardware.targets:
                because = f"half of the silence after which `{device.name}` stops, {shown(hardware.command_timeout_s)}"
                path, period_s = (*manager.path, "update_rate"), 1.0 / manager.update_rate_hz
                yield Pair(path, f"the period of `{manager.name}`", period_s, hardware.command_timeout_s / 2.0, because)
