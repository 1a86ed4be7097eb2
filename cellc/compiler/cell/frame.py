"""Frames of a cell: links of devices, fixed frames, and dynamic ones; and its solid things."""

from __future__ import annotations

import math
from dataclasses import field
from enum import Enum
from typing import Annotated

from cellc.compiler.cell.entity import Entity
from cellc.contract.frozen import dataclass
from cellc.contract.grading import Graded, Rule
from cellc.contract.transforms import Pose, Vector3, identity
from cellc.contract.vocabulary import ReviewArea
from cellc.robot.description.model import Box, Cylinder, Geometry, Mesh, Sphere

WORLD = "world"
"""Root of every cell's frame tree."""
FRICTION = 0.5
"""Of the surface of a part where none is stated: that of dry rubber."""


class FrameKind(str, Enum):
    """Where a frame comes from."""

    WORLD = "world"
    LINK = "link"  # a link inside a device, joint poses apart
    MOUNT = "mount"  # root link of a device
    FIXED = "fixed"  # stated in the spec
    SCENE = "scene"  # a solid thing
    DYNAMIC = "dynamic"  # published by a node while the cell runs


_MEET, _LESS = "arms may meet in it", "arms may meet where they were kept apart"


@dataclass(frozen=True, slots=True, kw_only=True)
class SimulatedPose:
    """Where the mock puts what a dynamic frame follows."""

    parent: str
    pose: Pose


@dataclass(frozen=True, slots=True, kw_only=True)
class Grasp:
    """A part as fingers meet it, m and kg; None of what is not stated.

    Args:
        size_m: its edges along x, y and z of its frame.
        friction: dry, of its surface.
    """

    width_m: float | None
    tolerance_m: float | None
    mass_kg: float | None
    size_m: Vector3 | None = None
    friction: float | None = None

    @property
    def grips_with(self) -> float:
        """The dry friction between it and what it touches, stated or not."""
        return FRICTION if self.friction is None else self.friction


@dataclass(frozen=True, slots=True, kw_only=True)
class Frame(Entity):
    """One TF frame and its edge to the parent.

    Args:
        parent: parent frame; empty for the world alone.
        transform_to_parent: pose in the parent, at joint position zero for links; None for a dynamic frame.
        authority: node that publishes the edge: ``robot_state_publisher`` or another.
        calibration: id of the calibration that measured the edge.
        designed: the edge is by design, no calibration is needed.
        moving: the edge moves with a joint.
        grasp: the part that lies there, or that the frame follows.
    """

    kind: FrameKind
    parent: str
    transform_to_parent: Pose | None
    authority: str
    device: str | None = None
    calibration: str | None = None
    designed: bool = False
    moving: bool = False
    rate_hz: float | None = None
    buffer_s: float | None = None
    reference_points: Annotated[int, Graded(ReviewArea.CALIBRATION, rule=Rule.FEWER)] = 0
    simulated_pose: SimulatedPose | None = None
    grasp: Grasp | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class SharedArea(Entity):
    """A volume that several arms may stand in: full edge lengths in m, center pose in ``parent``.

    Args:
        granted_by: who lets one in at a time on the real cell.
        released: why several may be in it together; empty where they may not.
    """

    parent: str
    transform_to_parent: Annotated[Pose, Graded(ReviewArea.SAFETY, "pose of the shared area", Rule.APART, why=_LESS)]
    size: Annotated[Vector3, Graded(ReviewArea.SAFETY, "size of the shared area", Rule.APART, "m", why=_LESS)]
    granted_by: Annotated[str, Graded(ReviewArea.SAFETY, "who grants access", Rule.DANGEROUS, why=_MEET)]
    released: Annotated[str, Graded(ReviewArea.SAFETY, "why arms may be in it together", Rule.APART, why=_MEET)]


@dataclass(frozen=True, slots=True, kw_only=True)
class TouchedFit:
    """What a shape was fitted to: how many touched points, and their distances from its surface, m."""

    points: int
    root_mean_square_m: float
    largest_m: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Solid(Entity):
    """A thing that planning avoids.

    Args:
        transform_to_parent: its frame in ``parent``.
        size: full edge lengths of the box around it, m; zero where a mesh alone knows them.
        shape: what it is where it is no box.
        center: middle of its shape in its frame.
        touched: what its figures were fitted to, where they were measured by touch.
    """

    parent: str
    transform_to_parent: Pose
    size: Vector3
    kind: str
    shape: Cylinder | Sphere | Mesh | None = None
    center: Pose = field(default_factory=identity)
    touched: TouchedFit | None = None

    @property
    def geometry(self) -> Geometry:
        """Its shape, about its center."""
        return self.shape or Box(self.size)

    def depth_m(self, point: Vector3) -> float | None:
        """Return how deep a point of ``parent`` is within it, m, negative outside; None of a mesh."""
        x, y, z = (self.transform_to_parent @ self.center).inverse().apply(point)
        if isinstance(self.shape, Mesh):
            return None
        if isinstance(self.shape, Sphere):
            return self.shape.radius - math.hypot(x, y, z)
        if isinstance(self.shape, Cylinder):
            return min(self.shape.radius - math.hypot(x, y), self.shape.length / 2.0 - abs(z))
        return min(size / 2.0 - abs(along) for size, along in zip(self.size, (x, y, z), strict=True))

    @property
    def is_plane(self) -> bool:
        """Whether it is the surface of all that is behind it."""
        return self.center != identity()
