"""The one small goal that a person sends before an application is started: one joint, from where the robot is."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.compiler.cell.cell import Cell
from cellc.compiler.deploy.files import BRING_UP_PROGRAM, FIRST_GOAL_PROGRAM, REQUIRED_PROGRAM, VERSIONS_PROGRAM
from cellc.compiler.deploy.processes import motion_clients
from cellc.compiler.link.hardware import JOINT_STATES
from cellc.contract.vocabulary import TRAJECTORIES, Feature, features

_PEAK = 1.5
"""Peak over mean velocity of a joint that goes by a cubic spline from rest to rest, as the controller interpolates."""

NODE = "first_goal"


@dataclass(frozen=True, slots=True)
class FirstGoal:
    """What the program of the first goal gets.

    Args:
        action: that of the controller or adapter of the joint, on the real target.
        joints: what its goals name.
        topic: where states of its joints arrive.
        joint: the one that moves, by its name in the description.
        delta: by how much, rad or m, with its sign.
        duration_s: of the motion; no joint is faster than the first motion of the spec.
        timeout_s: within which it ends.
        absent: full names of nodes that ask for motion, none of which may be there.
    """

    action: str
    joints: tuple[str, ...]
    topic: str
    joint: str
    delta: float
    duration_s: float
    timeout_s: float
    absent: tuple[str, ...]


def first_goal(cell: Cell) -> FirstGoal | None:
    """Return the goal, for a first motion whose joint a trajectory controller or an adapter of the real target moves.

    It is sent behind the proof that everything waits for that asks for motion, so that a cell without that has none.
    """
    first = cell.bringup.first_motion
    if first is None or not motion_clients(cell):
        return None
    device, _, local = first.joint.partition("/")
    joint = next((joint.name for joint in cell.device(device).joints if joint.local_name == local), local)
    sign = -1.0 if first.direction == "-" else 1.0
    for action, joints, topic in _takers(cell):
        if joint in joints:
            fastest_s = _PEAK * first.max_delta.value / first.velocity.value
            return FirstGoal(
                action=action,
                joints=joints,
                topic=topic,
                joint=joint,
                delta=sign * first.max_delta.value,
                duration_s=max(fastest_s, first.timeout_s / 2.0),
                timeout_s=first.timeout_s,
                absent=tuple(node.full_name for node in motion_clients(cell)),
            )
    return None


def _takers(cell: Cell) -> Iterator[tuple[str, tuple[str, ...], str]]:
    """Yield what takes trajectories on the real target: its action, its joints, and where their states arrive."""
    for controller in cell.controllers:
        if (
            controller.behavior in TRAJECTORIES
            and controller.active
            and "real" in controller.targets
            and controller.action
        ):
            yield controller.action, controller.joints, JOINT_STATES
    for adapted in cell.adapters:
        yield adapted.action, adapted.joints, adapted.state_topic


def programs(cell: Cell) -> tuple[str, ...]:
    """Return the programs that the package installs."""
    ends = () if Feature.EXIT_ENDS_LAUNCH in features(cell.distro) else (REQUIRED_PROGRAM,)
    goal = () if first_goal(cell) is None else (FIRST_GOAL_PROGRAM,)
    return (BRING_UP_PROGRAM, VERSIONS_PROGRAM, *ends, *goal)
