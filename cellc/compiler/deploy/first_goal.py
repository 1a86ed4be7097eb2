"""The small goals that a person sends before an application is started: one joint each, from where the robot is."""

from __future__ import annotations

from collections.abc import Iterator

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
    return tuple(goal for first in cell.bringup.first_motions for goal in _goals(cell, first))


def _goals(cell: Cell, first: FirstMotion) -> Iterator[FirstGoal]:
    device = cell.device(first.device)
    stated = next((joint.name for joint in device.joints if joint.local_name == first.local_joint), "")
    for action, names, topic in _takers(cell):
        if stated in names:
            by, control = first.max_delta.value / 2.0, device.procedures.speed_control
            yield FirstGoal(
                device=device.name,
                release=device.name if len(cell.bringup.first_motions) > 1 else "",
                action=action,
                topic=topic,
                joints=tuple(_joint(cell, name) for name in names),
                moves=(stated, *(name for name in _movable(device, first) if name in names and name != stated)),
                by=-by if first.direction == "-" else by,
                duration_s=max(_PEAK * by / first.velocity.value, first.timeout_s / 2.0),
                timeout_s=first.timeout_s / (1.0 if control is None else control.low),
                absent=tuple(node.full_name for node in motion_clients(cell)),
            )
            return


def _movable(device: Device, first: FirstMotion) -> Iterator[str]:
    """Yield the joints of a device to which the figures of a first motion apply, from tip to base."""
    return (joint.name for joint in reversed(device.actuated_joints) if joint.slides == first.max_delta.linear)


def _joint(cell: Cell, name: str) -> DeviceJoint:
    return next(joint for device in cell.devices for joint in device.joints if joint.name == name)


def _takers(cell: Cell) -> Iterator[tuple[str, tuple[str, ...], str]]:
    """Yield what takes trajectories on the real target: its action, its joints, and where their states arrive."""
    yield from ((taker.action, taker.joints, JOINT_STATES) for taker in cell.trajectory_controllers if taker.action)
    yield from ((adapted.action, adapted.joints, adapted.state_topic) for adapted in cell.adapters)


def programs(cell: Cell) -> tuple[str, ...]:
    """Return the programs that the package installs."""
    ends = () if Feature.EXIT_ENDS_LAUNCH in features(cell.distro) else (REQUIRED_PROGRAM,)
    goal = (FIRST_GOAL_PROGRAM,) if first_goals(cell) else ()
    watch = (WATCH_PROGRAM,) if any(watches(cell)) else ()
    return (BRING_UP_PROGRAM, VERSIONS_PROGRAM, *ends, *goal, *watch, OBSERVE_PROGRAM, *OBSERVE_MODULES)
