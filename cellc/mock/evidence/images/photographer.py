"""Images of the cameras of a cell: taken as a camera delivers one, and drawn where somebody asks for it.

They show the shapes of the description, and a cube for each part: enough to see that frames, streams and stamps are
right, and nothing to train or to tune perception with. Of a mesh the box around it is drawn, where its file is there.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from cellc.contract.devices import ContractImages
from cellc.contract.entities import Qos
from cellc.contract.frozen import dataclass
from cellc.contract.qos import DEFAULT
from cellc.contract.transforms import Pose, identity
from cellc.mock.evidence.bag import messages
from cellc.mock.evidence.images.rays import Body, Color, Pinhole, Solid, View, pinhole, seen
from cellc.mock.evidence.topics import BagTopic
from cellc.mock.nodes.perception import Image
from cellc.mock.plant import Plant
from cellc.robot.description.mesh_numbers import MeshNumbers, read_meshes
from cellc.robot.description.meshes import MeshFile, identify_all, readable
from cellc.robot.description.model import Box, Description, Link, Mesh

MOST_PIXELS = 160
"""Width of the images; those of a larger stream are scaled down by a whole factor, and their intrinsics with them."""
_DRAWN = ("rgb8", "bgr8", "mono8", "16UC1", "32FC1")
_PART_M = 0.04
"""Edge of the cube of a part whose width is not stated."""
_PART: Color = (0.85, 0.45, 0.15)
_PALETTE: Sequence[Color] = (
    (0.55, 0.60, 0.68),
    (0.40, 0.55, 0.75),
    (0.50, 0.68, 0.55),
    (0.72, 0.62, 0.45),
    (0.62, 0.52, 0.66),
)
_DEEPEST_MM = 65_535


@dataclass(frozen=True, slots=True)
class Shot:
    """An image that a camera delivered, with all that is needed to draw it later.

    Attributes:
        stamp_ns: as the camera stamps it.
        positions: of the joints when it was taken, rad or m.
        parts: where parts were in the root link, with their edges in m.
    """

    device: str
    sequence: int
    stamp_ns: int
    positions: Mapping[str, float]
    parts: tuple[tuple[Pose, float], ...]


@dataclass(frozen=True, slots=True)
class Painted:
    """A shape of a link, with its color."""

    link: str
    shape: Solid
    pose: Pose
    color: Color


class Photographer:
    """Takes what the cameras of a plant deliver, and draws it.

    Attributes:
        streams: of each device, those that can be drawn.
    """

    def __init__(self, plant: Plant, description: Description, mesh_roots: Sequence[Path]) -> None:
        """Bind to a plant.

        Args:
            mesh_roots: folders beside which the packages of meshes may lie.
        """
        self._plant = plant
        self._description = description
        self._mesh_roots = tuple(mesh_roots)
        self._last: dict[str, Shot] = {}
        self._painted: tuple[Painted, ...] | None = None
        self._seen: dict[str, tuple[Shot, View]] = {}
        devices = plant.contract.devices
        self.streams: dict[str, tuple[ContractImages, ...]] = {
            device: tuple(stream for stream in camera.images if stream.encoding in _DRAWN)
            for device in plant.cameras
            if (camera := devices[device].camera) is not None
        }

    def topics(self) -> Iterator[BagTopic]:
        """Yield the topics of images and of intrinsics, with the profile that the contract has for them."""
        for streams in self.streams.values():
            for stream in streams:
                yield BagTopic(stream.topic, messages.IMAGE, self._qos(stream.topic))
                yield BagTopic(stream.info_topic, messages.CAMERA_INFO, self._qos(stream.info_topic))

    def take(self, device: str, image: Image) -> Shot:
        """Return what an image shows; of one that is repeated, what it showed."""
        last = self._last.get(device)
        if last is not None and last.sequence == image.sequence:
            return last
        world = self._plant.world
        parts = tuple(self.parts(image.taken_ns))
        shot = Shot(device, image.sequence, image.stamp_ns, world.joint_positions(image.taken_ns), parts)
        self._last[device] = shot
        return shot

    def drawn(self, shot: Shot) -> Iterator[tuple[str, bytes]]:
        """Yield the messages of all streams of the camera, each with its topic."""
        for stream in self.streams[shot.device]:
            yield from ((topic, self.message(topic, shot)) for topic in (stream.topic, stream.info_topic))

    def message(self, topic: str, shot: Shot) -> bytes:
        """Return an image or its intrinsics, whichever is on a topic."""
        stream = next(each for each in self.streams[shot.device] if topic in (each.topic, each.info_topic))
        camera = _camera(stream)
        if topic == stream.info_topic:
            size = (camera.width, camera.height)
            return messages.camera_info(shot.stamp_ns, stream.frame, size, camera.focal, camera.center)
        last, view = self._seen.get(topic, (None, None))
        if view is None or last is None or (last.positions, last.parts) != (shot.positions, shot.parts):
            root_in_camera = self._plant.world.posed(stream.frame, shot.positions).inverse()
            view = seen(camera, self.bodies(root_in_camera, shot.positions, shot.parts))
            self._seen[topic] = shot, view
        return messages.image(shot.stamp_ns, stream.frame, stream.encoding, pixels(view, stream))

    def parts(self, stamp_ns: int) -> Iterator[tuple[Pose, float]]:
        """Yield where parts are in the root link at a time, with their edges in m."""
        world = self._plant.world
        yield from ((world.object_pose(name, stamp_ns), self._edge(name)) for name in world.objects())

    def bodies(
        self, root_in_camera: Pose, positions: Mapping[str, float], parts: Iterable[tuple[Pose, float]]
    ) -> Iterator[Body]:
        """Yield links and parts in an optical frame, where joints have some positions, rad or m."""
        world, poses = self._plant.world, dict[str, Pose]()
        if self._painted is None:
            self._painted = tuple(painted(self._description, self._mesh_roots))
        for each in self._painted:
            if each.link not in poses:
                poses[each.link] = root_in_camera @ world.posed(each.link, positions)
            yield Body(each.shape, poses[each.link] @ each.pose, each.color)
        for pose, edge in parts:
            yield Body(Box((edge, edge, edge)), root_in_camera @ pose, _PART)

    def _edge(self, name: str) -> float:
        grasp = self._plant.parts.grasp(name)
        return _PART_M if grasp is None or grasp.width_m is None else grasp.width_m

    def _qos(self, topic: str) -> Qos:
        interface = self._plant.contract.interfaces.get(topic)
        return interface.sources[0].qos if interface is not None and interface.sources else DEFAULT


class Album:
    """What the cameras of one rehearsal delivered, in the order of time, to be drawn afterwards.

    Attributes:
        shots: each with the instant of its delivery.
    """

    def __init__(self, photographer: Photographer) -> None:
        """Begin with nothing."""
        self.photographer = photographer
        self.shots: list[tuple[int, Shot]] = []

    def take(self, shot: Shot, now_ns: int) -> None:
        """Keep a shot."""
        self.shots.append((now_ns, shot))


def photograph(plant: Plant, album: Album, use: Callable[[Shot, int], None]) -> None:
    """Hand on what cameras deliver from now on, each shot with the instant of its delivery."""

    def deliver(device: str, image: Image) -> None:
        use(album.photographer.take(device, image), plant.now_ns)

    for device in album.photographer.streams:
        plant.cameras[device].listen(partial(deliver, device))


def _camera(stream: ContractImages) -> Pinhole:
    return pinhole(stream.width, stream.height, stream.horizontal, stream.vertical, MOST_PIXELS)


def pixels(view: View, stream: ContractImages) -> NDArray[np.generic]:
    """Return what is seen in the encoding of a stream.

    Depth is in mm as 16 bits, where 0 is no depth, or in m as 32 bits, where what is too near or too far is infinite
    (REP 118).
    """
    if stream.encoding in ("16UC1", "32FC1"):
        near, far = view.depth < stream.nearest_m, view.depth > stream.farthest_m
        if stream.encoding == "32FC1":
            return np.where(near, -np.inf, np.where(far, np.inf, view.depth)).astype(np.float32)
        steps = np.rint(np.where(near | far, 0.0, view.depth) * 1e3)
        return np.where(steps > _DEEPEST_MM, 0, steps).astype(np.uint16)
    color: NDArray[np.uint8] = np.rint(view.color * 255.0).astype(np.uint8)
    if stream.encoding == "mono8":
        color = color.mean(axis=-1).astype(np.uint8)
    if stream.encoding in ("rgb8", "mono8"):
        return color
    return np.flip(color, axis=-1)


def painted(description: Description, mesh_roots: Sequence[Path]) -> Iterator[Painted]:
    """Yield the shapes of all links: those to look at, or where a mesh of them is missing those that collide."""
    boxes = _boxes(description.links, mesh_roots)
    for link in description.links:
        plain = _PALETTE[zlib.crc32(link.name.encode()) % len(_PALETTE)]
        looks = [(each.geometry, each.pose, each.rgba[:3] if each.rgba else plain) for each in link.visuals]
        if not looks or any(isinstance(shape, Mesh) and shape not in boxes for shape, _, _ in looks):
            looks = [(each.geometry, each.pose, plain) for each in link.collisions] or looks
        for shape, pose, color in looks:
            if not isinstance(shape, Mesh):
                yield Painted(link.name, shape, pose, color)
            elif shape in boxes:
                box, place = boxes[shape]
                yield Painted(link.name, box, pose @ place, color)


def _boxes(links: Sequence[Link], roots: Sequence[Path]) -> dict[Mesh, tuple[Box, Pose]]:
    """Return the box around each mesh whose file is there, with its place."""
    looks = [each.geometry for link in links for each in link.visuals]
    shapes = [*looks, *(each.geometry for link in links for each in link.collisions)]
    meshes = tuple(dict.fromkeys(shape for shape in shapes if isinstance(shape, Mesh)))
    if not meshes:
        return {}
    files = identify_all(meshes, roots)
    at_hand = readable(files)
    read = dict(zip(at_hand, read_meshes(at_hand), strict=False))
    boxes = {}
    for mesh in meshes:
        file = files.get(mesh.filename)
        numbers = read.get(file) if isinstance(file, MeshFile) else None
        if isinstance(numbers, MeshNumbers) and len(numbers.vertices):
            points = numbers.vertices * np.array(mesh.scale)
            low, high = points.min(axis=0).tolist(), points.max(axis=0).tolist()
            size = (high[0] - low[0], high[1] - low[1], high[2] - low[2])
            middle = ((high[0] + low[0]) / 2.0, (high[1] + low[1]) / 2.0, (high[2] + low[2]) / 2.0)
            boxes[mesh] = Box(size), Pose(middle, identity().quaternion)
    return boxes
