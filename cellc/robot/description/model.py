"""A robot description as URDF means it: links, joints, shapes, all in SI and radians.

Nothing here decides validity: reversed limits, a zero axis or an impossible inertia survive reading, so that rules can
report them where they stand.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace
from typing import Union

from cellc.contract.diagnostics import Span
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, Vector3


@dataclass(frozen=True, slots=True)
class Box:
    """A box about its origin; ``size`` is the full extent along x, y, z in meters."""

    size: Vector3


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A cylinder about its origin, its axis along z; meters."""

    radius: float
    length: float


@dataclass(frozen=True, slots=True)
class Sphere:
    """A sphere about its origin; meters."""

    radius: float


@dataclass(frozen=True, slots=True)
class Mesh:
    """A mesh file as the description names it (``package://`` or a path), with a factor per axis."""

    filename: str
    scale: Vector3
    span: Span | None = field(default=None, compare=False)


Geometry = Union[Box, Cylinder, Sphere, Mesh]


@dataclass(frozen=True, slots=True)
class Collision:
    """A shape that the link occupies; ``pose`` is the shape in the link frame."""

    name: str | None
    pose: Pose
    geometry: Geometry


@dataclass(frozen=True, slots=True)
class Visual:
    """A shape to look at; ``rgba`` in 0..1, None where the material names none."""

    name: str | None
    pose: Pose
    geometry: Geometry
    material: str | None
    rgba: tuple[float, float, float, float] | None


@dataclass(frozen=True, slots=True)
class Inertial:
    """Mass in kg and the inertia tensor in kg m^2 about the center of mass, in axes of ``pose``.

    ``pose`` is the center of mass and the axes of the tensor in the link frame.
    """

    pose: Pose
    mass: float
    ixx: float
    ixy: float
    ixz: float
    iyy: float
    iyz: float
    izz: float
    span: Span | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Link:
    """A rigid body or a bare frame."""

    name: str
    inertial: Inertial | None
    visuals: tuple[Visual, ...]
    collisions: tuple[Collision, ...]
    span: Span | None = None

    def collision_meshes(self) -> tuple[Mesh, ...]:
        """Return the meshes among its collision shapes, in their order."""
        return tuple(shape.geometry for shape in self.collisions if isinstance(shape.geometry, Mesh))


@dataclass(frozen=True, slots=True)
class JointLimit:
    """Limits of one joint: rad or m, per second, N m or N; None where the description gives none."""

    lower: float | None
    upper: float | None
    velocity: float | None
    effort: float | None
    span: Span | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Mimic:
    """``position = multiplier * position of joint + offset``."""

    joint: str
    multiplier: float
    offset: float
    span: Span | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class JointDynamics:
    """Viscous damping (N m s/rad or N s/m) and static friction (N m or N)."""

    damping: float
    friction: float


@dataclass(frozen=True, slots=True)
class SafetyController:
    """Soft limits that ros2_control reads from URDF ``<safety_controller>``; rad or m, gains in 1/s and N s/rad."""

    soft_lower: float
    soft_upper: float
    k_position: float
    k_velocity: float


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint between two links; ``pose`` is the joint frame, which is the child frame at zero, in the parent link.

    ``unheld`` are the ends that are stated for a continuous joint, which has none.
    """

    name: str
    type: str
    parent: str
    child: str
    pose: Pose
    axis: Vector3
    limit: JointLimit | None = None
    mimic: Mimic | None = None
    dynamics: JointDynamics | None = None
    safety: SafetyController | None = None
    span: Span | None = None
    unheld: tuple[float, float] | None = field(default=None, compare=False, repr=False)

    @property
    def movable(self) -> bool:
        """Whether the joint has a position of its own or of the joint that it follows."""
        return self.type in ("revolute", "continuous", "prismatic")

    @property
    def slides(self) -> bool:
        """Whether its positions are lengths."""
        return self.type == "prismatic"


def as_number(text: str) -> float | None:
    """Return the number that a parameter in ``<ros2_control>`` is, or None."""
    try:
        return float(text)
    except ValueError:
        return None


@dataclass(frozen=True, slots=True)
class HardwareInterface:
    """A command or state interface in ``<ros2_control>``; initial value and bounds as written, empty where absent."""

    name: str
    data_type: str
    initial_value: str
    minimum: str
    maximum: str


@dataclass(frozen=True, slots=True)
class HardwarePart:
    """A joint, sensor or gpio of a hardware component.

    Attributes:
        mimic: the ``mimic`` attribute as written, None where absent.
        limits_enabled: False with ``<limits enable="false"/>``.
    """

    name: str
    command_interfaces: tuple[HardwareInterface, ...]
    state_interfaces: tuple[HardwareInterface, ...]
    mimic: str | None
    limits_enabled: bool
    span: Span | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class HardwareComponent:
    """One ``<ros2_control>`` element; an ``rw_rate`` of 0 means the rate of the controller manager."""

    name: str
    type: str
    plugin: str
    rw_rate: int
    is_async: bool
    parameters: dict[str, str]
    joints: tuple[HardwarePart, ...]
    sensors: tuple[HardwarePart, ...]
    gpios: tuple[HardwarePart, ...]
    span: Span | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Description:
    """A robot model: links, joints and hardware components in the order of the file.

    ``hardware_error`` is what the parser of hardware_interface says where it refuses a ``<ros2_control>`` element:
    ``hardware`` is empty then. The compiler looks at neither, because it writes ``<ros2_control>`` itself.
    """

    name: str
    links: tuple[Link, ...]
    joints: tuple[Joint, ...]
    hardware: tuple[HardwareComponent, ...] = ()
    hardware_error: str = ""
    hardware_error_span: Span | None = None

    def link(self, name: str) -> Link | None:
        """Find a link, the first where a name occurs twice."""
        return next((link for link in self.links if link.name == name), None)

    def joint(self, name: str) -> Joint | None:
        """Find a joint, the first where a name occurs twice."""
        return next((joint for joint in self.joints if joint.name == name), None)

    def roots(self) -> tuple[str, ...]:
        """Name the links that are no joint's child, in the order of the file; a valid model has exactly one."""
        children = {joint.child for joint in self.joints}
        return tuple(link.name for link in self.links if link.name not in children)

    def unreached(self, root: str) -> tuple[str, ...]:
        """Name the links that no chain of joints joins to a root, in the order of the file; cycles are among them."""
        children: dict[str, list[str]] = {}
        for joint in self.joints:
            children.setdefault(joint.parent, []).append(joint.child)
        reached, waiting = set[str](), [root]
        while waiting:
            link = waiting.pop()
            if link not in reached:
                reached.add(link)
                waiting += children.get(link, [])
        return tuple(link.name for link in self.links if link.name not in reached)

    def without_leaderless(self) -> Description:
        """Make joints of their own of those that mimic a joint that is not there."""
        names = {joint.name for joint in self.joints}
        joints = (
            replace(joint, mimic=None) if joint.mimic is not None and joint.mimic.joint not in names else joint
            for joint in self.joints
        )
        return replace(self, joints=tuple(joints))

    def with_direct_mimics(self) -> Description:
        """Let each joint that follows a follower follow the joint at the end of the chain; a circle stays one.

        robot_state_publisher goes over the followers once, in the order of their names: of a follower whose leader
        has a later name it publishes no transform. Pinocchio and yourdfpy read no chains.
        """
        mimics = {joint.name: joint.mimic for joint in self.joints if joint.type != "fixed" and joint.mimic is not None}
        joints = (
            replace(joint, mimic=_direct(mimics[joint.name], mimics)) if joint.name in mimics else joint
            for joint in self.joints
        )
        return replace(self, joints=tuple(joints))

    def with_link_names(self, names: Mapping[str, str]) -> Description:
        """Return the same with other names of some links, in every reference to one too."""
        if not names:
            return self
        links = tuple(replace(link, name=names.get(link.name, link.name)) for link in self.links)
        joints = tuple(
            replace(joint, parent=names.get(joint.parent, joint.parent), child=names.get(joint.child, joint.child))
            for joint in self.joints
        )
        return replace(self, links=links, joints=joints)

    def renamed(self, prefix: str) -> Description:
        """Put ``prefix`` before the name of every link and joint, and in every reference to one."""
        links = tuple(replace(link, name=prefix + link.name) for link in self.links)
        return replace(self, links=links, joints=tuple(_renamed_joint(joint, prefix) for joint in self.joints))


def _direct(mimic: Mimic, mimics: Mapping[str, Mimic]) -> Mimic:
    direct = mimic
    for _ in mimics:
        above = mimics.get(direct.joint)
        if above is None:
            return direct
        offset = direct.multiplier * above.offset + direct.offset
        direct = Mimic(above.joint, direct.multiplier * above.multiplier, offset)
    return mimic if direct.joint in mimics else direct


def _renamed_joint(joint: Joint, prefix: str) -> Joint:
    mimic = None if joint.mimic is None else replace(joint.mimic, joint=prefix + joint.mimic.joint)
    return replace(
        joint, name=prefix + joint.name, parent=prefix + joint.parent, child=prefix + joint.child, mimic=mimic
    )
