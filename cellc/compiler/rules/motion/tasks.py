"""Rules on the steps of a task and its rehearsals."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.frame import FrameKind, SharedArea
from cellc.compiler.cell.motion import Rehearsal, Step
from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.geometry import KNOWN_GOALS
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rule
from cellc.contract.vocabulary import Motion


@rule(Severity.ERROR)
def call_that_moves(graph: CellGraph) -> Findings:
    """Yield calls of services that the catalog knows to move something."""
    moving = dict(_moving(graph.cell))
    for rehearsal in graph.cell.rehearsals:
        for step in rehearsal.steps:
            if step.kind == "call" and step.name in moving:
                message = f"`{step.name}` moves past every controller: {moving[step.name]}"
                yield found(graph, (*step.path, "call"), message)


def _moving(cell: Cell) -> Iterator[tuple[str, str]]:
    """Yield the names that drivers and controllers offer and that move something, with what a call does."""
    for device in cell.devices:
        for offer in device.control.offers:
            if offer.effect is not None and offer.effect.motion not in _HARMLESS:
                yield offer.name, offer.effect.does
    for controller in cell.controllers:
        yield from ((name, call.does) for name, call in controller.calls.items() if call.motion not in _HARMLESS)


_HARMLESS = (Motion.NONE, Motion.HOLDS)


@rule(Severity.ERROR)
def empty_rehearsal(graph: CellGraph) -> Findings:
    """Yield rehearsals without steps."""
    for rehearsal in graph.cell.rehearsals:
        if not rehearsal.steps:
            yield found(graph, rehearsal.path, f"rehearsal `{rehearsal.name}` does nothing")


_GOALS_WITH_A_PART = 2
"""A part that was gripped at a named pose is brought to one goal; two goals are where it is and where it goes."""


@rule(Severity.WARNING)
def grip_before_arrival(graph: CellGraph) -> Findings:
    """Yield steps that close a gripper away from a goal and are followed by two goals before it opens."""
    goals, reported = {goal.name for goal in graph.cell.goals}, set()
    for step, before, after in _closings(graph.cell):
        ahead = _goals_until_open(after, goals)
        away = not before or before[-1] not in goals
        if away and len(ahead) >= _GOALS_WITH_A_PART and step.path not in reported:
            reported.add(step.path)
            message = f"`{step.name}` must close at a goal, but it closes before the arm goes to `{ahead[0]}`"
            yield found(graph, step.path, message)


def _closings(cell: Cell) -> Iterator[tuple[Step, list[str], Sequence[Step]]]:
    """Yield each step that closes a gripper, in each rehearsal, with the moves before it and the steps after it."""
    for rehearsal in cell.rehearsals:
        for number, step in enumerate(rehearsal.steps):
            if step.kind == "grip" and step.command == "close":
                before = [earlier.name for earlier in rehearsal.steps[:number] if earlier.kind == "move"]
                yield step, before, rehearsal.steps[number + 1 :]


def _goals_until_open(steps: Sequence[Step], goals: set[str]) -> list[str]:
    """Return the different goals that are taken before the gripper opens again."""
    found_: dict[str, None] = {}
    for step in steps:
        if step.kind == "grip" and step.command == "open":
            break
        if step.kind == "move" and step.name in goals:
            found_[step.name] = None
    return list(found_)


@rule(Severity.WARNING)
def part_never_released(graph: CellGraph) -> Findings:
    """Yield steps that close a gripper which opens no more, although the arm visits another goal and leaves it."""
    goals, reported = {goal.name for goal in graph.cell.goals}, set()
    for step, before, after in _closings(graph.cell):
        opened = any(item.kind == "grip" and item.name == step.name for item in after)
        moves = [item for item in after if item.kind == "move"]
        left = next((move for move in moves[:-1] if move.name in goals and [move.name] != before[-1:]), None)
        if not opened and left is not None and step.path not in reported:
            reported.add(step.path)
            message = f"`{step.name}` must open at `{left.name}` or after it, but stays closed to the end"
            yield found(graph, step.path, message, related=(Related("the arm leaves this goal", left.span),))


_Inside = Mapping[str, frozenset[str]]
"""Posture → arms with a link in the area; the empty posture is where the cell starts."""


@rule(Severity.ERROR, assumes=KNOWN_GOALS)
def shared_area_taken(graph: CellGraph) -> Findings:
    """Yield the first step of each rehearsal after which two arms stand in an area that is not released to both."""
    if not graph.cell.areas:
        return
    arms = _arms(graph)
    answers = motion_answer(graph).areas
    for area in graph.cell.areas:
        inside = {
            answer.posture: frozenset(arms[link] for link in answer.links if link in arms)
            for answer in answers
            if answer.area == area.name
        }
        if not area.released:
            yield from _taken(graph, area, inside, arms)


def _taken(graph: CellGraph, area: SharedArea, inside: _Inside, arms: Mapping[str, str]) -> Findings:
    place = Related("the area is stated here", area.span)
    reported = set()
    if len(inside.get("", ())) > 1:
        yield found(graph, area.path, _message(area, inside[""], "start in it"))
        return
    for rehearsal in graph.cell.rehearsals:
        for step, standing in _standing(graph, rehearsal, inside, arms):
            if len(standing) > 1:
                if step.path not in reported:
                    reported.add(step.path)
                    message = _message(area, standing, f"are in it after `move: {step.name}`")
                    yield found(graph, step.path, message, related=(place,))
                break


def _message(area: SharedArea, standing: frozenset[str], do: str) -> str:
    names = " and ".join(f"`{name}`" for name in sorted(standing))
    return f"area `{area.name}` must be held by one arm at a time, but {names} {do}"


def _standing(
    graph: CellGraph, rehearsal: Rehearsal, inside: _Inside, arms: Mapping[str, str]
) -> Iterator[tuple[Step, frozenset[str]]]:
    """Yield each move with the arms that stand in the area after it, each where its own last move took it."""
    last: dict[str, str] = {}
    for step in rehearsal.steps:
        if step.kind == "move":
            last |= dict.fromkeys(_moved(graph, step.name, arms), step.name)
            yield step, frozenset(arm for arm in set(arms.values()) if arm in inside.get(last.get(arm, ""), ()))


def _moved(graph: CellGraph, target: str, arms: Mapping[str, str]) -> set[str]:
    """Return the arms that a pose or a goal moves."""
    cell = graph.cell
    groups = {pose.group for pose in cell.poses if pose.name == target}
    groups |= {goal.group for goal in cell.goals if goal.name == target}
    return {arms[group.base_link] for group in cell.groups if group.name in groups and group.base_link in arms}


def _arms(graph: CellGraph) -> dict[str, str]:
    """Return for each link the device that carries it and is mounted on none: an arm with all that hangs on it."""
    carried = {}
    for device in graph.cell.devices:
        for link in device.body.description.links:
            devices = [frame.device for frame in graph.frames.chain(link.name) if frame.device is not None]
            carried[link.name] = devices[-1] if devices else device.name
    return carried


@rule(Severity.WARNING, assumes=("object-under-another-camera",))
def unprovoked_failure(graph: CellGraph) -> Findings:
    """Yield rehearsals that expect a failure and inject nothing, or nothing that can lead to it."""
    for rehearsal in graph.cell.rehearsals:
        if rehearsal.expect == "succeeded":
            continue
        if not rehearsal.faults:
            message = f"`{rehearsal.name}` expects `{rehearsal.expect}`, but nothing provokes it"
            yield found(graph, (*rehearsal.path, "expect"), message)
        elif all((fault.at_s or 0.0) >= rehearsal.timeout_s for fault in rehearsal.faults):
            fault = rehearsal.faults[0]
            message = f"a fault of `{rehearsal.name}` must come before its timeout, {rehearsal.timeout_s:g} s,"
            yield found(graph, fault.path, f"{message} got {fault.at_s:g} s")
        elif rehearsal.expect == "stale_state":
            yield from _other_camera(graph, rehearsal)


def _other_camera(graph: CellGraph, rehearsal: Rehearsal) -> Findings:
    """Yield the only fault where it freezes a camera, and all that is detected is seen by others."""
    frames = {
        device.name: set(device.body.frames.values())
        for device in graph.cell.devices
        if device.sensing.camera is not None
    }
    seen = [graph.frames.get(step.name) for step in rehearsal.steps if step.kind == "detect"]
    used = {name for name, cameras in frames.items() for frame in seen if frame is not None and frame.parent in cameras}
    fault = rehearsal.faults[0]
    alone = len(rehearsal.faults) == 1 and fault.kind == "freeze" and fault.name in frames
    if alone and used and fault.name not in used:
        message = f"`{rehearsal.name}` must freeze `{'` or `'.join(sorted(used))}`, which it detects with, got"
        yield found(graph, fault.path, f"{message} `{fault.name}`")


@rule(Severity.ERROR)
def unread_sensor(graph: CellGraph) -> Findings:
    """Yield the first move of each rehearsal that comes before the sensor of a device is read."""
    sensed = {
        device.name: switched
        for device in graph.cell.devices
        if (switched := device.switched) is not None and switched.inputs
    }
    reported: set[tuple[YamlPath, str]] = set()
    for rehearsal in graph.cell.rehearsals:
        # What no output switches may be in any state at first; the others are where their outputs have them.
        unread = {name: "" for name, switched in sensed.items() if not switched.signals}
        for step in rehearsal.steps:
            if step.kind == "set" and step.name in sensed and step.state in sensed[step.name].distinct_states:
                unread[step.name] = step.state or ""
            elif step.kind == "sense":
                unread.pop(step.name, None)
            elif step.kind == "move":
                for name, state in unread.items():
                    if (step.path, name) not in reported:
                        reported.add((step.path, name))
                        after = f"`{name}` was set to `{state}`" if state else "the cell started"
                        wanted = state or "…"
                        message = f"`{step.name}` is approached after {after} without checking the sensor of `{name}`"
                        help_ = f"add the step `{{sense: {name}, state: {wanted}}}` before it"
                        yield found(graph, step.path, message, help_)
                unread.clear()


@rule(Severity.ERROR)
def sense_against_set(graph: CellGraph) -> Findings:
    """Yield steps that wait for a state whose outputs are not those that were set last, where nothing else is meant."""
    switched = {device.name: device.switched.states for device in graph.cell.devices if device.switched is not None}
    reported: set[YamlPath] = set()
    for rehearsal in graph.cell.rehearsals:
        set_last: dict[str, Step] = {}
        for step in rehearsal.steps if not rehearsal.faults and rehearsal.expect == "succeeded" else ():
            states, state, before = switched.get(step.name, {}), step.state or "", set_last.get(step.name)
            if step.kind == "set" and state in states:
                set_last[step.name] = step
            elif step.kind == "sense" and before is not None and state in states and step.path not in reported:
                was = before.state or ""
                if states[state].outputs != states[was].outputs:
                    reported.add(step.path)
                    message = f"`{step.name}` was set to `{was}` and cannot become `{state}` before this step"
                    related = (Related("it is set here", before.span),)
                    yield found(graph, step.path, message, f"write `{{sense: {step.name}, state: {was}}}`", related)


@rule(Severity.ERROR)
def unsimulated_object(graph: CellGraph) -> Findings:
    """Yield dynamic frames that a rehearsal detects and that have no simulated pose."""
    detected = {step.name for rehearsal in graph.cell.rehearsals for step in rehearsal.steps if step.kind == "detect"}
    for frame in graph.cell.frames:
        if frame.kind is FrameKind.DYNAMIC and frame.name in detected and frame.simulated_pose is None:
            message = f"a rehearsal detects `{frame.name}`, but the mock does not know where it is"
            yield found(graph, frame.path, message)
