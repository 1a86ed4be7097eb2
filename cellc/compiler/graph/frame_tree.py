"""The frame graph: which frame hangs on which and who publishes the edge; and the links and joints behind it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from graphlib import CycleError, TopologicalSorter
from typing import TYPE_CHECKING

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.frame import Frame, FrameKind
from cellc.contract.diagnostics import Span, YamlPath
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, climb
from cellc.robot.description.model import Joint, Link

if TYPE_CHECKING:
    import networkx


@dataclass(frozen=True, slots=True)
class FrameTree:
    """Frames by name; a name with several edges has several authorities, which tf2 does not allow."""

    edges: Mapping[str, tuple[Frame, ...]]

    def __contains__(self, name: object) -> bool:
        return name in self.edges

    def get(self, name: str) -> Frame | None:
        """Find a frame, the first where a name occurs twice."""
        edges = self.edges.get(name)
        return edges[0] if edges else None

    def names(self) -> tuple[str, ...]:
        """Name every frame once, in the order of the cell."""
        return tuple(self.edges)

    def parent(self, name: str) -> str | None:
        """Name the parent of a frame; None for a root and for a frame that does not exist."""
        frame = self.get(name)
        return frame.parent or None if frame else None

    def carrier(self, name: str) -> tuple[str, Pose]:
        """Return the link that carries a frame by fixed transforms alone, and the pose of the frame in it."""

        def edge(child: str) -> tuple[str, Pose] | None:
            frame = self.get(child)
            if frame is None or frame.kind is not FrameKind.FIXED or frame.transform_to_parent is None:
                return None
            return frame.parent, frame.transform_to_parent

        return climb(name, edge)

    def authorities(self, name: str) -> tuple[Frame, ...]:
        """Return every edge that somebody publishes for one child frame."""
        return self.edges.get(name, ())

    def roots(self) -> tuple[str, ...]:
        """Name the frames that hang on nothing; a valid tree has the world alone."""
        return tuple(name for name, frames in self.edges.items() if not any(frame.parent for frame in frames))

    def cycles(self) -> tuple[tuple[str, ...], ...]:
        """Return each cycle as its frames from child to parent, the smallest name first."""
        try:
            TopologicalSorter(self._parents()).prepare()
        except CycleError:
            return self._find_cycles()
        return ()

    def chain(self, name: str) -> tuple[Frame, ...]:
        """Return the edges from a frame up to its root; it ends where a frame is missing or would come twice."""
        chain: list[Frame] = []
        seen: set[str] = set()
        frame = self.get(name)
        while frame is not None and frame.name not in seen:
            seen.add(frame.name)
            chain.append(frame)
            frame = self.get(frame.parent)
        return tuple(chain)

    def in_world(self, name: str) -> Pose | None:
        """Return the pose of a frame in the world; a dynamic frame is where the mock puts what it follows.

        Returns:
            None for a frame that a joint moves, and for a dynamic frame without a simulated pose.
        """

        def edge(child: str) -> tuple[str, Pose] | None:
            frame = self.get(child)
            if frame is not None and frame.simulated_pose is not None:
                return frame.simulated_pose.parent, frame.simulated_pose.pose
            return self._edge(child, rigid=True)

        top, pose = climb(name, edge)
        frame = self.get(top)
        return None if frame is None or frame.parent else pose

    def pose_in(self, name: str, ancestor: str, *, rigid: bool = False) -> Pose | None:
        """Return the pose of a frame in one that it hangs on, joints at zero; None where it hangs on another.

        Args:
            rigid: None where a joint lies between the two, too.
        """
        top, pose = climb(name, lambda child: self._edge(child, rigid=rigid), (ancestor,))
        return pose if top == ancestor and name in self else None

    def _edge(self, name: str, *, rigid: bool) -> tuple[str, Pose] | None:
        frame = self.get(name)
        if frame is None or not frame.parent or frame.transform_to_parent is None or (rigid and frame.moving):
            return None
        return frame.parent, frame.transform_to_parent

    def _parents(self) -> dict[str, tuple[str, ...]]:
        return {name: tuple(frame.parent for frame in frames if frame.parent) for name, frames in self.edges.items()}

    def _digraph(self) -> networkx.DiGraph[str]:
        import networkx

        graph: networkx.DiGraph[str] = networkx.DiGraph()
        graph.add_nodes_from(self.edges)
        graph.add_edges_from((child, parent) for child, parents in self._parents().items() for parent in parents)
        return graph

    def _find_cycles(self) -> tuple[tuple[str, ...], ...]:
        import networkx

        # One cycle a component: where frames have several parents, simple cycles can be exponentially many.
        graph = self._digraph()
        cycles = []
        for component in networkx.strongly_connected_components(graph):
            first = min(component)
            if len(component) > 1 or graph.has_edge(first, first):
                edges = networkx.find_cycle(graph.subgraph(sorted(component)), first)
                cycles.append(tuple(edge[0] for edge in edges))
        return tuple(sorted(cycles))


def build_frame_tree(cell: Cell) -> FrameTree:
    """Gather the edges of every frame under its name."""
    edges: dict[str, list[Frame]] = {}
    for frame in cell.frames:
        edges.setdefault(frame.name, []).append(frame)
    return FrameTree({name: tuple(frames) for name, frames in edges.items()})


@dataclass(frozen=True, slots=True)
class ModelLink:
    """A link; ``span`` is its element in the description, or the device's model where that has no place."""

    device: Device
    link: Link
    span: Span
    path: YamlPath


@dataclass(frozen=True, slots=True)
class ModelJoint:
    """A joint; ``span`` is its element in the description, or the device's model where that has no place."""

    device: Device
    joint: Joint
    span: Span
    path: YamlPath


@dataclass(frozen=True, slots=True)
class ModelParts:
    """The robot descriptions of a cell, part by part, in the order of the files."""

    cell: Cell

    def links(self) -> Iterator[ModelLink]:
        """Yield every link of every device."""
        for device in self.cell.devices:
            path = (*device.path, "model")
            for link in device.body.description.links:
                yield ModelLink(device, link, link.span or self.cell.locate(*path), path)

    def joints(self) -> Iterator[ModelJoint]:
        """Yield every joint of every device."""
        for device in self.cell.devices:
            path = (*device.path, "model")
            for joint in device.body.description.joints:
                yield ModelJoint(device, joint, joint.span or self.cell.locate(*path), path)
