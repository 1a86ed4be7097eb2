"""The robot as pinocchio sees it: kinematics, and collision shapes read from a URDF.

The parser underneath pinocchio prints its reason and raises the same sentence for every cause, so the causes are looked
for in the description that our own reader gives, and then in what was printed. Joints that follow other joints are
bound here too: pinocchio wants a leader before its followers in a tree that its parser has sorted by name, and would
refuse a gripper whose follower has the lesser name.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio

from cellc.contract.frozen import dataclass
from cellc.contract.limits import limits
from cellc.contract.printing import overheard
from cellc.contract.transforms import Pose
from cellc.robot.description.meshes import MESH_NOT_FOUND, MeshError, without_meshes
from cellc.robot.description.model import Description, Joint, Mimic
from cellc.robot.description.urdf_reader import read_urdf
from cellc.robot.description.urdf_values import reason_of_urdfdom
from cellc.robot.planning.mesh_shapes import mesh_shapes
from cellc.robot.planning.problem import Array, ModelError, UnknownShapeError

# pinocchio ships no type information: its values are Any, and stay inside this package.
PinModel = Any
PinData = Any
PinGeometry = Any
PinTransform = Any
PinShape = Any
PinManager = Any


@dataclass(frozen=True, slots=True, eq=False)
class RobotModel:
    """A URDF with its mimic joints and its collision shapes; never changed once read.

    Attributes:
        joints: names of the independent joints of one degree of freedom, parents first, without mimic joints.
        links: names of the links in the order of pinocchio's frames.
        mimics: joints that follow one of ``joints``; to pinocchio they are free, and every configuration sets them.
        scratch: what pinocchio computes in, for all who ask this model: each call fills what it reads, and none keeps
            what is in it. It grows with the third power of the joints. One model is not for two threads.
    """

    kinematics: PinModel
    geometry: PinGeometry
    joints: tuple[str, ...]
    links: tuple[str, ...]
    mimics: tuple[MimicJoint, ...]
    scratch: PinData

    @classmethod
    def from_urdf(
        cls, text: str, *, description: Description | None = None, mesh_roots: Sequence[Path] = ()
    ) -> RobotModel:
        """Read the text of an expanded URDF.

        Args:
            text: URDF; collision shapes may be primitives or meshes.
            description: what was read of ``text`` before; it is read here where absent.
            mesh_roots: folders under which meshes may lie besides those of the package path.

        Raises:
            UnknownShapeError: a mesh is not there.
            ModelError: the text is no robot description, with the reason that the parser prints.
        """
        described = _described(text) if description is None else description
        _check_description(described)
        mimics = _resolve_mimics(described)
        try:
            model = _kinematics(text)
            shapes = mesh_shapes(described, mesh_roots)
            plain = without_meshes(text) if shapes else text
            with overheard():
                geometry = pinocchio.buildGeomFromUrdfString(model, plain, pinocchio.GeometryType.COLLISION, None, [])
        except MeshError as error:
            raise (UnknownShapeError if error.code == MESH_NOT_FOUND else ModelError)(str(error)) from None
        except (ValueError, RuntimeError) as error:
            raise ModelError(f"pinocchio refuses the robot description: {str(error).splitlines()[0]}") from None
        _place(shapes, geometry, model)
        names = list(model.names)
        single = [names[index] for index in range(1, model.njoints) if model.nvs[index] == 1]
        following = {mimic.joint for mimic in mimics}
        joints = tuple(name for name in single if name not in following)
        links = tuple(frame.name for frame in model.frames if frame.type == pinocchio.FrameType.BODY)
        return cls(model, geometry, joints, links, mimics, model.createData())

    def frame_of(self, link: str) -> int:
        """Return pinocchio's index of a link's frame; raise ModelError where there is no such link."""
        if link not in self.links:
            raise ModelError(f"the robot description has no link `{link}`")
        return int(self.kinematics.getFrameId(link, pinocchio.FrameType.BODY))

    def joint_of(self, joint: str) -> int:
        """Return pinocchio's index of an independent joint; raise ModelError where there is no such joint."""
        if joint not in self.joints:
            raise ModelError(f"the robot description has no independent movable joint `{joint}`")
        return int(self.kinematics.getJointId(joint))

    def is_turning(self, joint: str) -> bool:
        """Tell whether a joint is revolute or continuous, so that a whole turn leaves the robot where it was."""
        return "JointModelR" in self.kinematics.joints[self.joint_of(joint)].shortname()

    def configuration(self, positions: Mapping[str, float]) -> Array:
        """Write joint positions as pinocchio's configuration; joints not named stand at the allowed value nearest zero.

        Args:
            positions: rad or meters by joint name; a mimic joint follows its joint and is not named.
        """
        vector: Array = np.array(pinocchio.neutral(self.kinematics), dtype=np.float64)
        for joint in positions:
            self.joint_of(joint)
        chosen = {joint: self.rest_of(joint) for joint in self.joints if joint not in positions} | dict(positions)
        for joint, value in chosen.items():
            self._set_position(vector, joint, value)
        for mimic in self.mimics:
            self._set_position(vector, mimic.joint, mimic.multiplier * chosen[mimic.leader] + mimic.offset)
        return vector

    def _set_position(self, vector: Array, joint: str, value: float) -> None:
        index = self.kinematics.getJointId(joint)
        at = self.kinematics.idx_qs[index]
        if self.kinematics.nqs[index] == 2:
            vector[at], vector[at + 1] = math.cos(value), math.sin(value)
        else:
            vector[at] = value

    def link_pose(self, link: str, positions: Mapping[str, float], *, base_link: str) -> Pose:
        """Return the pose of a link in the frame of another link."""
        data = self.scratch
        pinocchio.framesForwardKinematics(self.kinematics, data, self.configuration(positions))
        return to_pose(data.oMf[self.frame_of(base_link)].actInv(data.oMf[self.frame_of(link)]))

    def rest_of(self, joint: str) -> float:
        index = self.joint_of(joint)
        if self.kinematics.nqs[index] == 2:
            return 0.0
        at = self.kinematics.idx_qs[index]
        lower, upper = self.kinematics.lowerPositionLimit[at], self.kinematics.upperPositionLimit[at]
        return float(min(max(0.0, lower), upper))


def _kinematics(text: str) -> PinModel:
    with overheard() as said:
        try:
            return pinocchio.buildModelFromXML(text)
        except (ValueError, RuntimeError) as error:
            refused = str(error)
    raise ValueError(reason_of_urdfdom(said, refused))


def _place(shapes: Mapping[tuple[str, int], PinShape], geometry: PinGeometry, model: PinModel) -> None:
    """Put each mesh in the place of the shape that represents it; those of a link are in the order of the file."""
    numbers: Counter[str] = Counter()
    for shape in geometry.geometryObjects if shapes else ():
        link = str(model.frames[shape.parentFrame].name)
        if (link, numbers[link]) in shapes:
            shape.geometry = shapes[link, numbers[link]]
        numbers[link] += 1


def _described(text: str) -> Description:
    read = read_urdf(text, "robot_description")
    if read.value is None:
        raise ModelError(f"the robot description cannot be read: {read.diagnostics[0].message}")
    return read.value


def _check_description(description: Description) -> None:
    """Raise ModelError with the first reason for which links and joints are no robot."""
    links = [link.name for link in description.links]
    if not links:
        raise ModelError("the robot description has no link")
    _refuse_repeated("link", links)
    _refuse_repeated("joint", [joint.name for joint in description.joints])
    _refuse_too_many("links", len(links), limits().robot_links)  # pinocchio goes down a chain by recursion
    # What it computes in has the third power of the joints.
    moving = sum(joint.type != "fixed" for joint in description.joints)
    _refuse_too_many("joints that move", moving, limits().robot_joints)
    known = frozenset(links)
    for joint in description.joints:
        _check_joint(joint, known)
    _check_tree(description)


def _refuse_too_many(what: str, count: int, most: int) -> None:
    if count > most:
        raise ModelError(f"robots that can reach each other have {count} {what}, at most {most} are read")


def _refuse_repeated(kind: str, names: Iterable[str]) -> None:
    seen: set[str] = set()
    for name in names:
        if name in seen:
            raise ModelError(f"{kind} `{name}` is declared twice")
        seen.add(name)


def _check_joint(joint: Joint, links: Container[str]) -> None:
    for end, link in (("parent", joint.parent), ("child", joint.child)):
        if link not in links:
            raise ModelError(f"joint `{joint.name}` has the {end} link `{link}`, which does not exist")
    if joint.limit is None:
        if joint.type in ("revolute", "prismatic"):
            raise ModelError(f"joint `{joint.name}` is {joint.type} and has no limit")
        return
    for name, value in (("effort", joint.limit.effort), ("velocity", joint.limit.velocity)):
        if value is None:
            raise ModelError(f"the limit of joint `{joint.name}` states no {name}")


def _check_tree(description: Description) -> None:
    children: set[str] = set()
    for joint in description.joints:
        if joint.child in children:
            raise ModelError(f"link `{joint.child}` is the child of two joints")
        children.add(joint.child)
    roots = description.roots()
    if len(roots) != 1:
        shown = ", ".join(f"`{root}`" for root in roots) or "none"
        raise ModelError(f"the links must have exactly one root, found {shown}")
    unreached = description.unreached(roots[0])
    if unreached:
        raise ModelError(f"link `{unreached[0]}` is on a cycle of joints")


@dataclass(frozen=True, slots=True)
class MimicJoint:
    """A joint that is at ``multiplier * leader + offset``; the leader itself follows nothing."""

    joint: str
    leader: str
    multiplier: float
    offset: float


def _resolve_mimics(description: Description) -> tuple[MimicJoint, ...]:
    """Return the mimic joints in the order of the file; a mimic of a mimic is led by the joint at the end.

    Raises:
        ModelError: the joint followed does not exist or is fixed, or joints follow each other in a circle.
    """
    types = {joint.name: joint.type for joint in description.joints}
    for follower, stated in _followers(description):
        if stated.joint not in types:
            raise ModelError(f"joint `{follower}` mimics `{stated.joint}`, which does not exist")
        if types[stated.joint] == "fixed":
            raise ModelError(f"joint `{follower}` mimics `{stated.joint}`, which is fixed")
    direct = dict(_followers(description.with_direct_mimics()))
    for follower, mimic in direct.items():
        if mimic.joint in direct:
            raise ModelError(f"joint `{follower}` mimics itself over `{mimic.joint}`")
    return tuple(MimicJoint(name, mimic.joint, mimic.multiplier, mimic.offset) for name, mimic in direct.items())


def _followers(description: Description) -> Iterator[tuple[str, Mimic]]:
    for joint in description.joints:
        if joint.mimic is not None and joint.type != "fixed":  # a fixed joint follows no joint
            yield joint.name, joint.mimic


def to_pose(transform: PinTransform) -> Pose:
    """Turn pinocchio's rigid transform into a pose."""
    x, y, z, qx, qy, qz, qw = (float(value) for value in pinocchio.SE3ToXYZQUAT(transform))
    return Pose((x, y, z), (qx, qy, qz, qw))


def from_pose(pose: Pose) -> PinTransform:
    """Turn a pose into pinocchio's rigid transform."""
    return pinocchio.XYZQUATToSE3(np.array([*pose.position, *pose.quaternion]))
