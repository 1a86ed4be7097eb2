"""The small goals that a person sends before an application is started: one joint each, from where the robot is."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device, DeviceJoint
from cellc.compiler.cell.site import FirstMotion
from cellc.compiler.deploy.files import (
    BRING_UP_PROGRAM,
    FIRST_GOAL_PROGRAM,
    OBSERVE_MODULES,
    OBSERVE_PROGRAM,
    REQUIRED_PROGRAM,
    VERSIONS_PROGRAM,
    WATCH_PROGRAM,
)
from cellc.compiler.deploy.processes import motion_clients
from cellc.compiler.deploy.watches import watches
from cellc.compiler.link.names import JOINT_STATES
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import Feature, features

_PEAK = 1.5
"""Peak over mean velocity of a joint that goes by a cubic spline from rest to rest, as the controller interpolates."""

NODE = "first_goal"


@dataclass(frozen=True, slots=True)
class FirstGoal:
    """What the program of the first goals gets for one device.

    Args:
        device: the one that moves.
        release: the device that the word of the release names; empty where only one has goals.
        action: that of its controller or adapter, on the real target.
        topic: where states of its joints arrive.
        joints: what its goals name, in their order.
        moves: the joints that may move, by their names in the description: the stated one, then from tip to base.
        by: to either side of where the joint is, rad or m, half of what the spec allows; its sign is the first side.
        duration_s: of one motion; no joint is faster than the first motion of the spec.
        timeout_s: within which a goal ends, with the device as slow as people set it for first motions.
        absent: full names of motion clients, none of which may run.
    """

    device: str
    release: str
    action: str
    topic: str
    joints: tuple[DeviceJoint, ...]
    moves: tuple[str, ...]
    by: float
    duration_s: float
    timeout_s: float
    absent: tuple[str, ...]


def first_goals(cell: Cell) -> tuple[FirstGoal, ...]:
    """Return the goals of each first motion whose joint a trajectory controller or an adapter of the real target moves.

    They are sent behind the proof that every motion client waits for, so that a cell without one has none.
    """
    if not motion_clients(cell):
        return ()
    takers = {joint: taker for taker in reversed(tuple(_takers(cell))) for joint in taker.joints}
    absent = tuple(node.full_name for node in motion_clients(cell))
    goals = (_goal(cell, first, takers, absent) for first in cell.bringup.first_motions)
    return tuple(goal for goal in goals if goal is not None)


class _Taker(NamedTuple):
    """What takes trajectories: its action, its joints, and where their states arrive."""

    action: str
    joints: tuple[str, ...]
    state_topic: str


def _goal(cell: Cell, first: FirstMotion, takers: Mapping[str, _Taker], absent: tuple[str, ...]) -> FirstGoal | None:
    device = cell.device(first.device)
    stated = next((joint.name for joint in device.joints if joint.local_name == first.local_joint), "")
    if (taker := takers.get(stated)) is None:
        return None
    by, control = first.max_delta.value / 2.0, device.procedures.speed_control
    return FirstGoal(
        device=device.name,
        release=device.name if len(cell.bringup.first_motions) > 1 else "",
        action=taker.action,
        topic=taker.state_topic,
        joints=tuple(cell.joints_by_name[name] for name in taker.joints),
        moves=(stated, *(name for name in _movable(device, first) if name in taker.joints and name != stated)),
        by=-by if first.direction == "-" else by,
        duration_s=max(_PEAK * by / first.velocity.value, first.timeout_s / 2.0),
        timeout_s=first.timeout_s / (1.0 if control is None else control.low),
        absent=absent,
    )


def _movable(device: Device, first: FirstMotion) -> Iterator[str]:
    """Yield the joints of a device to which the figures of a first motion apply, from tip to base."""
    return (joint.name for joint in reversed(device.actuated_joints) if joint.slides == first.max_delta.linear)


def _takers(cell: Cell) -> Iterator[_Taker]:
    """Yield what takes trajectories on the real target."""
    for controller in cell.trajectory_controllers:
        if controller.action:
            yield _Taker(controller.action, controller.joints, JOINT_STATES)
    yield from (_Taker(adapted.action, adapted.joints, adapted.state_topic) for adapted in cell.adapters)


def programs(cell: Cell) -> tuple[str, ...]:
    """Return the programs that the package installs."""
    ends = () if Feature.EXIT_ENDS_LAUNCH in features(cell.distro) else (REQUIRED_PROGRAM,)
    goal = (FIRST_GOAL_PROGRAM,) if first_goals(cell) else ()
    watch = (WATCH_PROGRAM,) if any(watches(cell)) else ()
    return (BRING_UP_PROGRAM, VERSIONS_PROGRAM, *ends, *goal, *watch, OBSERVE_PROGRAM, *OBSERVE_MODULES)
