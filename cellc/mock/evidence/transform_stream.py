"""The messages of robot_state_publisher on /tf, computed from the joint states that reach it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from cellc.mock.control import JointStateBlock
from cellc.mock.evidence.bag.messages import StampedTransform
from cellc.mock.nodes.robot_state_publisher import PUBLISH_FREQUENCY_HZ
from cellc.mock.plant import Plant
from cellc.mock.world.joint_states import JointStateHistory

_INTERVAL_NS = round(1e9 / PUBLISH_FREQUENCY_HZ)


@dataclass(frozen=True, slots=True)
class TransformMessage:
    """A tf2_msgs/TFMessage with the simulated instant at which it was published."""

    published_ns: int
    transforms: tuple[StampedTransform, ...]


class TransformStream:
    """Turns the joint states of one broadcaster into transforms, thinned as the node does it."""

    def __init__(self, plant: Plant, history: JointStateHistory) -> None:
        """Bind the stream; it reads the plant and changes nothing in it."""
        self._plant = plant
        self._history = history
        self._clock = plant.clocks.of(history.broadcaster)
        self._due_ns: int | None = None

    def take(self, block: JointStateBlock) -> Iterator[TransformMessage]:
        """Yield the messages that a block of joint states gives."""
        arrivals = self._history.arrivals(block.stamps_ns)
        for row in self._used(block):
            taken_ns = int(block.stamps_ns[row])
            positions = dict(zip(block.names, block.positions[row].tolist(), strict=True))
            transforms = self._transforms(taken_ns, positions)
            if transforms:
                yield TransformMessage(int(arrivals[row]), transforms)

    def _used(self, block: JointStateBlock) -> Iterator[int]:
        row = 0 if self._due_ns is None else int(np.searchsorted(block.stamps_ns, self._due_ns))
        while row < len(block.stamps_ns):
            yield row
            self._due_ns = int(block.stamps_ns[row]) + _INTERVAL_NS
            row = int(np.searchsorted(block.stamps_ns, self._due_ns))

    def _transforms(self, taken_ns: int, positions: dict[str, float]) -> tuple[StampedTransform, ...]:
        publisher, stamp_ns = self._plant.robot_state_publisher, self._clock.read(taken_ns)
        return tuple(
            StampedTransform(stamp_ns, joint.parent, joint.child, joint.pose(positions))
            for joint in publisher.moved_by(self._history)
            if publisher.publishes(joint.child, taken_ns)
        )


def static_transforms(plant: Plant) -> tuple[StampedTransform, ...]:
    """Return the fixed edges of the robot description, stamped with the beginning of time."""
    joints = plant.robot_state_publisher.links.joints.values()
    return tuple(StampedTransform(0, joint.parent, joint.child, joint.origin) for joint in joints if not joint.moves)
