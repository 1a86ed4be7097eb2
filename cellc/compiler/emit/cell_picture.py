"""``graph/cell.svg``: where everything is, from two sides.

SVG 1.1 without scripts, styles or fonts from elsewhere. Devices with their links, what is solid, and the frames of the
cell; the joints stand as in the first named pose, else where the mock begins. Left out: frames within a device other
than its mount, which `config/frames.yaml` has, meshes, and planes, beside which all else would be small.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.frame import WORLD, Frame, FrameKind, Solid
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.formats.views import Part, two_views
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, identity
from cellc.robot.description.bones import bones
from cellc.robot.description.posture import posture

FILE = "graph/cell.svg"


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the picture."""
    yield Artifact(FILE, two_views(_Standing(graph.cell).drawing(), plan.header.text))


@dataclass(frozen=True, slots=True)
class _Place:
    """Where a frame is in the world, and on which device; empty for the cell itself."""

    pose: Pose
    device: str


class _Standing:
    """Everything in one posture."""

    def __init__(self, cell: Cell) -> None:
        self._cell = cell
        self._frames = {frame.name: frame for frame in cell.frames}
        self._links: dict[str, tuple[Device, Pose]] = {}
        named = [pose for pose in cell.poses if pose.name == cell.poses[0].name]
        asked = {joint: value for pose in named for joint, value in zip(pose.joints, pose.positions, strict=True)}
        for device in cell.devices:
            for link, pose in posture(device.body.description, {**device.mock.home, **asked}).items():
                self._links.setdefault(link, (device, pose))
        self._places: dict[str, _Place] = {}

    def drawing(self) -> Part:
        """Return the cell as parts: what it carries, and what that carries."""
        return self._part("", self._cell.name)

    def _part(self, device: str, name: str) -> Part:
        carried = [item for item in self._cell.devices if self._place(item.mount.parent_frame).device == device]
        solids = [box for box in self._cell.scene if not box.is_plane and self._place(box.parent).device == device]
        parts = (
            *(self._solid(solid) for solid in solids),
            *(self._part(device.name, device.name) for device in carried),
        )
        frames = tuple(self._named(device))
        if not device:
            return Part(name, (0.0, 0.0, 0.0), frames=frames, parts=parts, solid=True)
        placed = self._cell.device(device)
        poses = {link: self._place(link).pose for link, (holder, _) in self._links.items() if holder is placed}
        shapes = (
            (poses[link.name], collision)
            for link in placed.body.description.links
            for collision in link.collisions
            if link.name in poses
        )
        return Part(
            name,
            poses[placed.body.root_link].position,
            tuple((pose @ shape.pose, shape.geometry) for pose, shape in shapes),
            tuple(bones(placed.body.description, poses)),
            frames,
            parts,
        )

    def _solid(self, box: Solid) -> Part:
        pose = self._place(box.parent).pose @ box.transform_to_parent
        body = (pose @ box.center, box.geometry)
        return Part(box.name, pose.position, (body,), frames=((box.name, pose),), solid=True)

    def _named(self, device: str) -> Iterator[tuple[str, Pose]]:
        """Yield the mount of a device, and the frames of the cell that it carries."""
        for frame in self._frames.values():
            if frame.kind in (FrameKind.LINK, FrameKind.SCENE):
                continue
            place = self._place(frame.name)
            if place.device == device and (frame.transform_to_parent is not None or frame.simulated_pose is not None):
                yield frame.name, place.pose

    def _place(self, name: str) -> _Place:
        if name not in self._places:
            self._places[name] = _Place(identity(), "")  # a cycle, which a rule refuses, ends here
            self._places[name] = self._found(name)
        return self._places[name]

    def _found(self, name: str) -> _Place:
        if name in self._links:
            device, pose = self._links[name]
            base = self._place(device.mount.parent_frame).pose @ device.mount.transform_root_to_parent
            return _Place(base @ pose, device.name)
        frame = self._frames.get(name)
        if frame is None or name == WORLD:
            return _Place(identity(), "")
        parent, pose = _edge(frame)
        above = self._place(parent)
        return _Place(above.pose @ pose, above.device)


def _edge(frame: Frame) -> tuple[str, Pose]:
    """Return the parent of a frame with its pose there; what a node publishes is where the mock puts it."""
    if frame.simulated_pose is not None:
        return frame.simulated_pose.parent, frame.simulated_pose.pose
    return frame.parent, frame.transform_to_parent or identity()
