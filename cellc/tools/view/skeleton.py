"""The cell as rigid groups: what no joint between them can move apart, so that a posture is one pose for each group."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cellc.contract.contract import ContractFrame
from cellc.contract.transforms import Pose, climb, identity
from cellc.mock.world.world import LinkTree, link_tree
from cellc.robot.description.model import Description
from cellc.tools.view.poses import Poses, Values, alike, composed, displaced
from cellc.tools.view.standing import Standing

Carried = Mapping[str, tuple[str, Pose]]
"""Where dynamic frames stand: the link that each hangs from, and its pose there."""


@dataclass(frozen=True, slots=True)
class Held:
    """A place that does not move in its group."""

    group: int
    pose: Pose


class Skeleton:
    """Groups of links, and of what perception finds.

    Attributes:
        groups: name of the first link of each group, of each dynamic frame that the mock places, and of each part that
            lies at a fixed frame.
        parts: where each part that can be gripped begins, by its frame.
        frames: where each frame of the cell is held; dynamic ones that nothing places are left out.
        links: of the groups, how many are links: the dynamic frames follow them.
    """

    def __init__(self, standing: Standing) -> None:
        """Find the groups of the static parts."""
        description = standing.description
        self._tree: LinkTree = link_tree(description)
        self._start = {name: np.asarray(at) for name, at in _start_positions(description)}
        moved = {joint.child for joint in description.joints if joint.movable}
        self._links = tuple(link.name for link in description.links)
        roots = [name for name in self._links if name in moved or name not in self._tree.joints]
        self._placed: Carried = {
            name: (frame.simulated_parent, frame.simulated_pose.pose)
            for name, frame in standing.frames.items()
            if frame.simulated_parent in self._links and frame.simulated_pose is not None
        }
        gripped = {name for name, frame in standing.frames.items() if frame.grasp is not None}
        self._at_rest = {f"{name} (part)": name for name in gripped - set(self._placed) if name in self._links}
        self.groups: tuple[str, ...] = (*roots, *self._placed, *sorted(self._at_rest))
        self.links = len(roots)
        self._numbers = {name: number for number, name in enumerate(self.groups)}
        self.frames = dict(self._frames(standing.frames))
        groups = {name: name for name in self._placed} | {name: group for group, name in self._at_rest.items()}
        self.parts = {name: Held(self._numbers[groups[name]], identity()) for name in sorted(gripped & set(groups))}

    def posture(self, positions: Mapping[str, float]) -> tuple[Pose, ...]:
        """Return the pose of each group in the root link; joints that are not named stand where the mock begins."""
        whole = self.postures({name: np.array([position]) for name, position in positions.items()}, [{}])
        return tuple(Pose((x, y, z), (i, j, k, w)) for x, y, z, i, j, k, w in (poses[:, 0].tolist() for poses in whole))

    def postures(self, positions: Mapping[str, Values], carried: Sequence[Carried]) -> tuple[Values, ...]:
        """Return the poses of each group in the root link at some times, shape (7, times).

        Args:
            positions: rad or m by joint, at each time; the others stand where the mock begins.
            carried: dynamic frames that stand elsewhere than at first, at each time.
        """
        at = {**self._start, **positions}
        known: dict[str, Poses] = {}
        return tuple(self._over_time(name, at, carried, known) for name in self.groups)

    def _over_time(
        self, name: str, at: Mapping[str, Values], carried: Sequence[Carried], known: dict[str, Poses]
    ) -> Values:
        found = np.empty((7, len(carried)))
        frame = self._at_rest.get(name, name)
        if frame in self._links and name not in self._at_rest:
            found[:] = np.broadcast_arrays(found[0], *self._poses(name, at, known))[1:]
            return found
        first = self._placed.get(name, (frame, identity()))
        held = [each.get(frame, first) for each in carried]
        for place in dict.fromkeys(held):
            then = np.array([each == place for each in held])
            poses = composed(self._poses(place[0], at, known), alike(place[1]))
            found[:, then] = np.array(np.broadcast_arrays(found[0], *poses)[1:])[:, then]
        return found

    def _poses(self, link: str, at: Mapping[str, Values], known: dict[str, Poses]) -> Poses:
        """Return the poses of a link; ``known`` are those behind each joint, before what is fixed there."""
        first, moving = self._tree.run(link)
        begin = next((n for n in range(len(moving), 0, -1) if moving[n - 1][0].child in known), 0)
        poses = composed(known[moving[begin - 1][0].child], alike(moving[begin - 1][1])) if begin else alike(first)
        for joint, fixed in moving[begin:]:
            known[joint.child] = composed(poses, displaced(joint, at))
            poses = composed(known[joint.child], alike(fixed))
        return poses

    def held(self, link: str) -> Held:
        """Return where a link is held."""

        def edge(child: str) -> tuple[str, Pose]:
            joint = self._tree.joints[child]
            return joint.parent, joint.origin

        top, pose = climb(link, edge, self._numbers)
        return Held(self._numbers[top], pose)

    def _frames(self, frames: Mapping[str, ContractFrame]) -> Iterator[tuple[str, Held]]:
        for name in frames:
            top, pose = climb(name, lambda child: _edge(frames, child), {*self._links, *self._placed})
            if top in self._links or top in self._placed:
                held = self.held(top)
                yield name, Held(held.group, held.pose @ pose)


def _edge(frames: Mapping[str, ContractFrame], name: str) -> tuple[str, Pose] | None:
    frame = frames.get(name)
    return None if frame is None or frame.pose is None else (frame.parent, frame.pose.pose)


def _start_positions(description: Description) -> Iterable[tuple[str, float]]:
    """Yield where the joints of the mock begin, as the description tells its hardware."""
    for component in description.hardware:
        for joint in component.joints:
            for interface in joint.state_interfaces:
                if interface.name == "position" and interface.initial_value:
                    yield joint.name, float(interface.initial_value)
