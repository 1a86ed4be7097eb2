"""What moves: planning groups, poses and goals, joints and frames bound, and rehearsals with their steps and faults."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

from cellc.compiler.cell.entity import ELSEWHERE, Entity
from cellc.compiler.cell.interface import ParameterValue
from cellc.contract.faults import FaultKind
from cellc.contract.frozen import dataclass
from cellc.contract.steps import StepKind
from cellc.contract.transforms import Pose, Vector3


@dataclass(frozen=True, slots=True, kw_only=True)
class Solver:
    """What solves the inverse kinematics of a group for MoveIt: a plugin, and what it gets."""

    name: str
    plugin: str
    package: str
    parameters: Mapping[str, ParameterValue]
    search_resolution: float
    timeout_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Pipeline:
    """A planning pipeline of MoveIt.

    Args:
        timed: it states its own times, and needs no time parameterization.
        joint_goals: it takes goals of joints alone.
        avoids_nothing: it moves straight, and refuses a motion with something in its way.
        capabilities: of move_group, which it brings along.
    """

    name: str
    plugin: str
    package: str
    parameters: Mapping[str, ParameterValue]
    timed: bool
    joint_goals: bool
    avoids_nothing: Annotated[bool, ELSEWHERE]
    capabilities: tuple[str, ...]


DEPTH_IMAGE, POINT_CLOUD = "sensor_msgs/msg/Image", "sensor_msgs/msg/PointCloud2"
"""Types of interfaces that can feed an occupancy map."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Octomap:
    """The occupancy map of move_group; ``source`` is the topic that feeds it, ``nearest_m`` what its sensor sees."""

    source: str
    resolution_m: float
    range_m: float
    padding_m: float
    rate_hz: float
    nearest_m: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Servo:
    """MoveIt Servo: a node that turns twists, joint speeds or poses into commands of a controller.

    Args:
        node: its name in the spec.
        controller: full name of the controller; ``topic`` and ``type`` are what it is commanded by.
        positions, velocities: what of the joints it is sent.
        commands: speed_units or unitless; ``linear``, ``rotational`` and ``joint`` are the largest speeds in SI.
    """

    node: str
    group: str
    controller: str
    topic: str
    type: str
    positions: bool
    velocities: bool
    commands: str
    linear: float
    rotational: float
    joint: float
    period_s: float
    command_timeout_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanningGroup(Entity):
    """A chain of joints from ``base_link`` to ``tip_frame``; ``controllers`` drive its joints.

    ``planner`` is that of the sampling pipeline, by OMPL's name.
    """

    base_link: str
    tip_frame: str
    joints: tuple[str, ...]
    controllers: tuple[str, ...]
    solver: Solver
    planner: str


@dataclass(frozen=True, slots=True, kw_only=True)
class NamedPose(Entity):
    """Joint positions of one group, rad or m, in the order of ``joints``; ``linear`` where written as a length."""

    group: str
    joints: tuple[str, ...]
    positions: tuple[float, ...]
    linear: tuple[bool, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class CartesianGoal(Entity):
    """Where the tip of a group goes in ``frame``; ``approach`` is in the tip's own axes, m."""

    group: str
    frame: str
    transform_tip_to_frame: Pose
    approach: Vector3 | None
    transform_at: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Step(Entity):
    """One step; ``name`` is the pose, goal, frame, device or service, or who acknowledges."""

    kind: StepKind
    command: str | None = None  # open or close, for grip; together, for groups of a pose that move together
    state: str | None = None  # for set and sense
    duration_s: float | None = None  # for wait


@dataclass(frozen=True, slots=True)
class StepEvent:
    """How far a step has come: ``when`` is started, accepted or moving; ``after_s`` is counted from there."""

    step: int  # from 1
    when: str
    after_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault(Entity):
    """One fault: ``kind`` as in the spec, ``name`` the ROS name of what it hits; times in simulated seconds.

    It begins at ``at_s``, with ``event`` or with ``phase`` of the bring-up; two of them are None.
    ``amount`` is what its kind says beside the target, in SI; ``linear`` where that is in meters.
    """

    kind: FaultKind
    at_s: float | None
    event: StepEvent | None
    phase: str | None
    lasting_s: float | None
    cycles: int | None
    amount: float | None
    linear: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Rehearsal(Entity):
    """A run of the mock and the outcome that it must end in.

    ``bring_up`` is the target whose bring-up is taken; with ``real`` its devices act as their vendors' drivers do.
    ``success`` is the least share of the runs of a sweep that must succeed, with ``confidence``; None where none must.
    """

    steps: tuple[Step, ...]
    faults: tuple[Fault, ...]
    expect: str
    within_s: float | None
    timeout_s: float
    bring_up: str
    success: float | None
    confidence: float
