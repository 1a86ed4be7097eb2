"""Objects that perception sees and grippers carry: ground truth with its history."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import partial

from cellc.mock.tf.sources import DeferredPose
from cellc.mock.world.joint_states import JointStateHistory
from cellc.mock.world.links import LinkTree
from cellc.transforms import Pose


@dataclass(frozen=True, slots=True)
class Placement:
    """From ``from_ns`` on the object stands still in the frame of ``link``."""

    from_ns: int
    link: str
    pose: Pose


def _begin_ns(placement: Placement) -> int:
    return placement.from_ns


class World:
    """Where links and objects really are at a time, computed from the recorded joint positions."""

    def __init__(self, links: LinkTree, histories: Iterable[JointStateHistory]) -> None:
        """Bind the world to the links of the cell and the recorded joint states."""
        self._links = links
        self._histories = tuple(histories)
        self._placements: dict[str, list[Placement]] = {}
        self._standing: dict[tuple[str, Placement], DeferredPose] = {}

    def joint_positions(self, stamp_ns: int) -> dict[str, float]:
        """Return the true positions of all recorded joints at a time."""
        positions: dict[str, float] = {}
        for history in self._histories:
            positions |= history.at(stamp_ns)
        return positions

    def link_pose(self, link: str, stamp_ns: int) -> Pose:
        """Return the true pose of a link in the root link at a time."""
        return self._links.pose(link, self.joint_positions(stamp_ns))

    def place(self, name: str, link: str, pose: Pose, now_ns: int) -> None:
        """Let an object stand still in the frame of a link from now on."""
        self._placements.setdefault(name, []).append(Placement(now_ns, link, pose))

    def objects(self) -> tuple[str, ...]:
        """Return the names of all objects, sorted."""
        return tuple(sorted(self._placements))

    def carrier(self, name: str) -> str:
        """Return the link that an object stands on or hangs from now."""
        return self._placements[name][-1].link

    def object_pose(self, name: str, stamp_ns: int) -> Pose:
        """Return the true pose of an object in the root link at a time."""
        placement = self._placement(name, stamp_ns)
        return self.link_pose(placement.link, stamp_ns) @ placement.pose

    def sight(self, link: str, name: str, stamp_ns: int) -> DeferredPose:
        """Return the true pose of an object in the frame of a link at a time, from what is recorded by now."""
        placement = self._placement(name, stamp_ns)
        if self._links.stands(link) and self._links.stands(placement.link):
            if (link, placement) not in self._standing:
                self._standing[link, placement] = DeferredPose(partial(self._relative, link, placement, {}))
            return self._standing[link, placement]
        positions = self.joint_positions(stamp_ns)
        pose = DeferredPose(partial(self._relative, link, placement, positions))
        if any(map(math.isnan, positions.values())):
            pose.get()  # so that it is seen to be none
        return pose

    def _placement(self, name: str, stamp_ns: int) -> Placement:
        placements = self._placements[name]
        index = bisect_right(placements, stamp_ns, key=_begin_ns) - 1
        return placements[max(0, index)]

    def _relative(self, link: str, placement: Placement, positions: Mapping[str, float]) -> Pose:
        in_root = self._links.pose(placement.link, positions) @ placement.pose
        return self._links.pose(link, positions).inverse() @ in_root

    def move(self, name: str, link: str, now_ns: int) -> Pose:
        """Hand an object over to another link without moving it; return its pose in the frame of that link."""
        pose = self.link_pose(link, now_ns).inverse() @ self.object_pose(name, now_ns)
        self.place(name, link, pose, now_ns)
        return pose
