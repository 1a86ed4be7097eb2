"""A grip step: drive the gripper, and let it take or release an object that is between its fingers."""

from __future__ import annotations

import math

from cellc.contract.devices import ContractGripper
from cellc.contract.vocabulary import AttemptOutcome, Behavior
from cellc.mock.control import GripperGoal
from cellc.mock.engine.process import Waiting
from cellc.mock.task.bounds import grip_timeout_s
from cellc.mock.task.context import Attempt, AttemptError, CurrentState, TaskContext
from cellc.mock.task.execute import execute, require_success
from cellc.mock.task.move import state_since

ARRIVAL_SHARE = 0.05
"""Share of its stroke by which a gripper may miss the position where it should come to rest."""
GRASP_TOLERANCE_M = 0.03
"""Largest distance of the tip from an object's frame at which closing fingers take it."""


def grip(context: TaskContext, attempt: Attempt, device: str, command: str) -> Waiting[None]:
    """Open or close a gripper; raise AttemptError where it does not get there."""
    named = context.contract.devices.get(device)
    facts = None if named is None else named.gripper
    if facts is None or facts.controller is None:
        raise AttemptError(AttemptOutcome.GOAL_REJECTION, f"no controller drives gripper {device}")
    between = object_between(context, device) if command == "close" else None
    target = facts.closed if command == "close" else facts.open
    goal = _goal(context, facts, target)
    timeout_s = grip_timeout_s(context.contract, facts.controller)
    ended = yield from execute(context, attempt, "grip", facts.controller, goal, timeout_s)
    require_success(ended, context)
    state = yield from state_since(context, ended.decided_ns)
    _require_arrival(state, facts, target)
    context.plant.loads.hold(device, holds=command == "close")
    if between is not None:
        take(context, device, between)
    elif command == "open":
        release(context, device)


def _require_arrival(state: CurrentState, facts: ContractGripper, expected: float) -> None:
    """Raise AttemptError where the fingers are elsewhere: a controller may call any stall a success."""
    allowed = ARRIVAL_SHARE * abs(facts.closed - facts.open)
    position = state.positions.get(facts.joint, math.nan)
    if not abs(position - expected) <= allowed:  # an unknown position is no arrival either
        text = f"joint {facts.joint} is at {position:.4g}, expected {expected:.4g} within {allowed:.2g}"
        raise AttemptError(AttemptOutcome.TOLERANCE_VIOLATION, text)


def _goal(context: TaskContext, facts: ContractGripper, position: float) -> GripperGoal:
    """Return the goal; GripperCommand has a field for effort, ParallelGripperCommand needs an interface for it."""
    for manager in context.contract.managers.values():
        controller = manager.controllers.get(facts.controller or "")
        if controller is not None and controller.behavior is Behavior.POSITION_GRIPPER:
            return GripperGoal(position=(position,), effort=(facts.max_effort,))
    return GripperGoal(position=(position,), joint_names=(facts.joint,))


def object_between(context: TaskContext, device: str) -> str | None:
    """Return the object whose frame is nearest to the tip behind the gripper, if it is within the tolerance."""
    plant = context.plant
    tip = _tip_link(context, device)
    if tip is None or device in context.held:
        return None
    position = plant.world.link_pose(tip, plant.now_ns).position
    distances = [
        (math.dist(position, plant.world.object_pose(name, plant.now_ns).position), name)
        for name in plant.world.objects()
    ]
    near = [entry for entry in distances if entry[0] <= GRASP_TOLERANCE_M]
    return min(near)[1] if near else None


def _tip_link(context: TaskContext, device: str) -> str | None:
    """Return the tip frame of the group whose chain goes through the gripper."""
    contract = context.contract
    root = _body(context, device)
    for group in contract.groups.values():
        frame = group.tip_frame
        for _ in range(len(contract.frames) + 1):
            if frame == root:
                return group.tip_frame
            if frame not in contract.frames:
                break
            frame = contract.frames[frame].parent
    return None


def _body(context: TaskContext, device: str) -> str:
    """Return the link that carries what is held: the one in which fingers move, which in an arm is not its base."""
    facts = context.contract.devices[device]
    fingers = None if facts.gripper is None else context.plant.world.carrier_of(facts.gripper.joint)
    return fingers or facts.root_link


def take(context: TaskContext, device: str, name: str) -> None:
    """Let a device hold an object from now on."""
    plant = context.plant
    link = _body(context, device)
    pose_in_link = plant.world.move(name, link, plant.now_ns)
    plant.planner.attach(name, link, pose_in_link, plant.world.joint_positions(plant.now_ns))
    context.held[device] = name
    context.acting_on = None


def release(context: TaskContext, device: str) -> None:
    """Let go of what a device holds; it stays where it is."""
    name = context.held.pop(device, None)
    if name is not None:
        context.plant.world.move(name, context.contract.root_frame, context.plant.now_ns)
        context.plant.planner.detach(name)
