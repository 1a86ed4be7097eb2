"""What two foreign parsers, yourdfpy and pinocchio, make of a robot description, in terms that both share."""

from __future__ import annotations

import importlib
import logging
import math
import sys
from collections.abc import Mapping, Sequence
from importlib.abc import MetaPathFinder
from io import BytesIO
from itertools import pairwise
from types import ModuleType
from typing import Any

import numpy as np
import pinocchio

from cellc.contract.errors import CellcError
from cellc.contract.frozen import dataclass
from cellc.contract.printing import overheard
from cellc.contract.signals import held
from cellc.contract.transforms import Pose, quaternion_of
from cellc.robot.description.urdf_values import reason_of_urdfdom

_MOVABLE = ("revolute", "prismatic", "continuous")
_LOGGERS = ("yourdfpy", "trimesh")
"""What they log is found by the comparison, in words of ours; Python prints it to standard error if none listens."""
_SCENE = {
    "build_scene_graph": False,
    "build_collision_scene_graph": True,
    "load_meshes": False,
    "load_collision_meshes": False,
    "force_collision_mesh": False,
}
"""That of the collision shapes: it has the same links, and takes 20 ms less for each description."""
_HEAVY = ("scipy", "networkx", "PIL", "shapely", "rtree")


@dataclass(frozen=True, slots=True)
class JointReading:
    """Limits of one movable joint, in rad or m; a joint without position bounds has infinite ones."""

    lower: float
    upper: float
    velocity: float
    effort: float


@dataclass(frozen=True, slots=True)
class Reading:
    """Joints by name, and the pose of every link in the root link, by name.

    Args:
        at_zero: poses with every joint at position zero.
        displaced: poses with every joint at the position that `_displaced_positions` gives it.
    """

    joints: Mapping[str, JointReading]
    at_zero: Mapping[str, Pose]
    displaced: Mapping[str, Pose]


class RefusedError(CellcError):
    """A parser refuses the description."""


def _displaced_positions(joints: Mapping[str, str | None]) -> dict[str, float]:
    """Return a position away from zero for each joint, by which axes and signs show.

    Args:
        joints: movable joints by name, each with the joint that it mimics or None. A mimic joint gets none: what
            it does follows from the other.
    """
    free = sorted(name for name, mimicked in joints.items() if mimicked is None)
    return {name: 0.1 + 0.05 * (index % 7) for index, name in enumerate(free)}


def read_by_yourdfpy(urdf: str) -> tuple[Reading, dict[str, float]]:
    """Return joints and link poses, and the positions of all joints in the displaced poses, mimic joints included.

    Raises:
        RefusedError: yourdfpy does not take the description.
    """
    try:
        with held():
            # Transforms alone: no mesh is opened, nothing is looked up beside the text, and nothing is colored.
            yourdfpy = import_yourdfpy()
            read = yourdfpy.URDF.load(BytesIO(urdf.encode()), **_SCENE | {"build_collision_scene_graph": False}).robot
            for link in read.links:
                link.collisions.clear()  # for each shape trimesh hashes all links
            robot = yourdfpy.URDF(read, **_SCENE)
    except Exception as error:  # it lets through whatever its parts raise
        raise RefusedError(f"yourdfpy refuses it: {type(error).__name__} {error}") from error
    movable = [joint for joint in robot.robot.joints if joint.type in _MOVABLE]
    mimicked = {joint.name: joint.mimic.joint if joint.mimic else None for joint in movable}
    positions = _displaced_positions(mimicked)
    at_zero = _yourdfpy_poses(robot, dict.fromkeys(positions, 0.0))
    displaced = _yourdfpy_poses(robot, positions)
    positions |= {joint.name: _followed(joint, positions) for joint in movable if joint.mimic}
    return Reading({joint.name: _yourdfpy_joint(joint) for joint in movable}, at_zero, displaced), positions


def _followed(joint: Any, positions: dict[str, float]) -> float:
    multiplier = 1.0 if joint.mimic.multiplier is None else joint.mimic.multiplier
    return float(multiplier * positions.get(joint.mimic.joint, 0.0) + (joint.mimic.offset or 0.0))


def _yourdfpy_joint(joint: Any) -> JointReading:
    limit = joint.limit
    is_bounded = joint.type != "continuous"
    lower = (limit.lower or 0.0) if limit and is_bounded else -math.inf
    upper = (limit.upper or 0.0) if limit and is_bounded else math.inf
    velocity, effort = (limit.velocity, limit.effort) if limit else (None, None)
    return JointReading(
        lower, upper, math.inf if velocity is None else velocity, math.inf if effort is None else effort
    )


def _yourdfpy_poses(robot: Any, positions: dict[str, float]) -> dict[str, Pose]:
    robot.update_cfg([positions[name] for name in robot.actuated_joint_names])
    # From link to link, each once: asked for a link in the root, it goes the whole way for every link again.
    above = {joint.child: joint.parent for joint in robot.robot.joints}
    matrices: dict[str, Any] = {robot.base_link: np.eye(4)}
    for name in robot.link_map:
        unknown = [name]
        while unknown[-1] not in matrices:
            unknown.append(above[unknown[-1]])
        for parent, link in pairwise(reversed(unknown)):
            matrices[link] = matrices[parent] @ robot.get_transform(link, parent, collision_geometry=True)
    return {name: _pose(matrices[name]) for name in robot.link_map}


def _pose(matrix: Any) -> Pose:
    """Read a homogeneous transform, 4x4."""
    m = [[float(value) for value in row] for row in matrix]
    return Pose((m[0][3], m[1][3], m[2][3]), quaternion_of(m))


def import_yourdfpy() -> ModuleType:
    """Return the package ``yourdfpy``.

    It builds its scene on trimesh, which imports libraries for mesh operations where they are installed and works
    without them. Hiding them from that import saves every build 0.6 s of 0.75 s processor time; later imports get them.
    """
    for name in _LOGGERS:
        logging.getLogger(name).addHandler(logging.NullHandler())
    if "trimesh" in sys.modules:
        return importlib.import_module("yourdfpy")
    absent = _Absent()
    sys.meta_path.insert(0, absent)
    try:
        return importlib.import_module("yourdfpy")
    except ImportError:
        pass  # a trimesh that insists on them
    finally:
        sys.meta_path.remove(absent)
    return importlib.import_module("yourdfpy")


class _Absent(MetaPathFinder):
    """Finds that none of the heavy libraries is installed; those that are loaded already are not asked for."""

    def find_spec(self, name: str, path: Sequence[str] | None, target: ModuleType | None = None) -> None:
        """Raise ModuleNotFoundError for a heavy library, and leave any other module to the finders after this one."""
        if name.partition(".")[0] in _HEAVY:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)


def read_by_pinocchio(urdf: str, positions: Mapping[str, float]) -> Reading:
    """Return joints and link poses.

    Args:
        positions: position of each joint for the displaced poses, in rad or m. Mimic joints are included: pinocchio
            treats them as free here, so that zero means zero for all.

    Raises:
        RefusedError: pinocchio does not take the description.
    """
    model = _pinocchio_model(urdf)
    joints = {name: _pinocchio_joint(model, index) for index, name in enumerate(model.names) if index}
    zero, displaced = pinocchio.neutral(model), pinocchio.neutral(model)
    for name in joints:
        _set(model, displaced, name, positions.get(name, 0.0))
    return Reading(joints, _pinocchio_poses(model, zero), _pinocchio_poses(model, displaced))


def _pinocchio_model(urdf: str) -> Any:
    with overheard() as said:
        try:
            return pinocchio.buildModelFromXML(urdf)
        except (ValueError, RuntimeError) as error:
            refused = str(error)
    raise RefusedError(f"pinocchio refuses it: {reason_of_urdfdom(said, refused)}")


def _pinocchio_joint(model: Any, index: int) -> JointReading:
    position, velocity = model.joints[index].idx_q, model.joints[index].idx_v
    if model.joints[index].nq == 2:  # continuous: cosine and sine
        lower, upper = -np.inf, np.inf
    else:
        lower, upper = model.lowerPositionLimit[position], model.upperPositionLimit[position]
    limits = (lower, upper, model.velocityLimit[velocity], model.effortLimit[velocity])
    return JointReading(*(float(limit) for limit in limits))


def _set(model: Any, configuration: Any, name: str, position: float) -> None:
    joint = model.joints[model.getJointId(name)]
    values = (np.cos(position), np.sin(position)) if joint.nq == 2 else (position,)
    configuration[joint.idx_q : joint.idx_q + joint.nq] = values


def _pinocchio_poses(model: Any, configuration: Any) -> dict[str, Pose]:
    """Return the pose of every link; without `Data` of the model, which has the third power of the joints in it."""
    placements = [pinocchio.SE3.Identity()]
    for index in range(1, model.njoints):
        joint = model.joints[index]
        moved = joint.createData()
        joint.calc(moved, configuration)
        placements.append(placements[model.parents[index]] * model.jointPlacements[index] * moved.M)
    poses = {}
    for frame in model.frames:
        if frame.type == pinocchio.FrameType.BODY:
            placement = placements[frame.parentJoint] * frame.placement
            x, y, z = map(float, placement.translation)
            qx, qy, qz, qw = map(float, pinocchio.Quaternion(placement.rotation).coeffs())
            poses[frame.name] = Pose((x, y, z), (qx, qy, qz, qw))
    return poses
