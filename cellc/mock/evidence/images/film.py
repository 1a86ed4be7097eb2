"""A rehearsal as somebody beside the cell sees it: shapes of the description and parts, ten times a second.

What moves is noted while the rehearsal runs, and drawn when it is over: then it is known what has to be in the picture.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, Vector3, quaternion_of
from cellc.mock.evidence.images.photographer import Photographer
from cellc.mock.evidence.images.rays import Pinhole, seen
from cellc.mock.plant import Plant
from cellc.robot.description.model import Description

RATE_HZ = 10
SIZE = (480, 360)
"""Width and height in pixels."""
_ANGLE = math.radians(36.0)
"""Of the view from its lower to its upper edge."""
_TOWARDS: Vector3 = (0.72, -0.56, 0.41)
"""From the middle of the cell to the eye: in front of the robot and to its right, above what it works on."""
_ROOM_M = 0.2
"""Around the frames of what moves: links are thicker than their frames."""
_LOST_M = 5.0
"""A part that is farther from what moves is not looked for: it fell, or is not there."""

Frame = NDArray[np.uint8]
Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Moment:
    """Where everything is at an instant.

    Attributes:
        positions: of joints, rad or m.
        parts: where parts are in the root link, with their edges in m.
    """

    stamp_ns: int
    positions: Mapping[str, float]
    parts: tuple[tuple[Pose, float], ...]


class Film:
    """What moves in one rehearsal."""

    def __init__(self, plant: Plant, description: Description, mesh_roots: Sequence[Path]) -> None:
        """Begin to note it."""
        self._plant = plant
        self._description = description
        self._photographer = Photographer(plant, description, mesh_roots)
        self._moments: list[Moment] = []
        plant.simulation.every(0, RATE_HZ, self._take)

    def _take(self, index: int) -> None:
        world, at_ns = self._plant.world, index * 1_000_000_000 // RATE_HZ
        if any(history.first_ns is not None for history in self._plant.control.histories.values()):
            parts = tuple(self._photographer.parts(at_ns))
            self._moments.append(Moment(at_ns, world.joint_positions(at_ns), parts))

    def moments(self, since_ns: int) -> tuple[Moment, ...]:
        """Return what was noted since an instant."""
        return tuple(moment for moment in self._moments if moment.stamp_ns >= since_ns)

    def frames(self, moments: Sequence[Moment]) -> Iterator[Frame]:
        """Yield a picture of each moment, in red, green and blue."""
        camera = Pinhole(*SIZE, SIZE[1] / 2.0 / math.tan(_ANGLE / 2.0))
        eye = self._eye(moments)
        for moment in moments:
            bodies = self._photographer.bodies(eye.inverse(), moment.positions, moment.parts)
            yield np.rint(seen(camera, bodies).color * 255.0).astype(np.uint8)

    def _eye(self, moments: Sequence[Moment]) -> Pose:
        """Return where it is looked from, so that all that moves is in the picture."""
        points = np.array(list(self._places(moments)))
        low, high = points.min(axis=0) - _ROOM_M, points.max(axis=0) + _ROOM_M
        distance = float(np.linalg.norm(high - low)) / 2.0 / math.sin(_ANGLE / 2.0)
        towards = np.array(_TOWARDS) / np.linalg.norm(_TOWARDS)
        x, y, z = ((low + high) / 2.0 + distance * towards).tolist()
        right = np.cross(-towards, (0.0, 0.0, 1.0))
        right = right / np.linalg.norm(right)
        turn = np.stack([right, np.cross(-towards, right), -towards], axis=1)  # optical: right, down, forward
        return Pose((x, y, z), quaternion_of(turn.tolist()))

    def _places(self, moments: Sequence[Moment]) -> Iterator[Vector3]:
        world, joints = self._plant.world, [joint for joint in self._description.joints if joint.movable]
        for moment in moments:
            links = [
                world.posed(link, moment.positions).position for each in joints for link in (each.parent, each.child)
            ]
            yield from links
            for pose, _ in moment.parts:
                if min((math.dist(pose.position, link) for link in links), default=0.0) < _LOST_M:
                    yield pose.position
        if not joints:
            yield (0.0, 0.0, 0.0)
