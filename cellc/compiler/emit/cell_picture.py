"""``graph/cell.svg``: where everything is, from two sides.

SVG 1.1 without scripts, styles or fonts from elsewhere. Devices with their links, what is solid, and the frames of the
cell; the joints stand as in the first named pose, else where the mock begins. Left out: frames within a device other
than its mount, which `config/frames.yaml` has, meshes, and planes, beside which all else would be small.
"""

from __future__ import annotations

from collections import defaultdict
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
        self._links_of, self._carried = defaultdict[str, list[str]](list), defaultdict[str, list[Device]](list)
        self._solids, self._named = defaultdict[str, list[Solid]](list), defaultdict[str, list[tuple[str, Pose]]](list)
        self._sort(cell)

    def _sort(self, cell: Cell) -> None:
        """Sort links, devices, things and frames by the device that has or carries them."""
        for link, (holder, _) in self._links.items():
            self._links_of[holder.name].append(link)
        for device in cell.devices:
            self._carried[self._place(device.mount.parent_frame).device].append(device)
        for solid in cell.scene:
            if not solid.is_plane:
                self._solids[self._place(solid.parent).device].append(solid)
        for frame in self._frames.values():
            if frame.kind in (FrameKind.LINK, FrameKind.SCENE):
                continue
            place = self._place(frame.name)
            if frame.transform_to_parent is not None or frame.simulated_pose is not None:
                self._named[place.device].append((frame.name, place.pose))

    def drawing(self) -> Part:
        """Return the cell as parts: what it carries, and what that carries."""
        return self._part("", self._cell.name)

    def _part(self, device: str, name: str) -> Part:
        parts = (
            *(self._solid(solid) for solid in self._solids[device]),
            *(self._part(carried.name, carried.name) for carried in self._carried[device]),
        )
        frames = tuple(self._named[device])
        if not device:
            return Part(name, (0.0, 0.0, 0.0), frames=frames, parts=parts, solid=True)
        placed = self._cell.device(device)
        poses = {link: self._place(link).pose for link in self._links_of[device]}
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
