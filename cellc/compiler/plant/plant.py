"""The plant: its cells with their poses, the topics that cross from one to others, and the one rule of names.

Each cell is a ROS graph of its own, in a DDS domain of its own: its package is the same with the plant and without,
and no name of one cell meets that of another. In the plant the key of a cell, ``line_1``, is its ROS namespace: its
topic ``/part_ready`` is ``/line_1/part_ready``, and is called so in the graph of every cell that hears it; in its own
graph it has no namespace. References name a node or a frame as ``line_1/task``. A bridge of two cells is a node in both
graphs. Frames keep their names: a bridge forwards serialized messages, and changes nothing that they say.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.frame import WORLD
from cellc.compiler.cell.interface import Interface
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.rules.shared_domain import Presence
from cellc.compiler.source.document import SourceDocument
from cellc.contract.diagnostics import Span, YamlPath
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, Vector3


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """A cell of the plant.

    Args:
        key: its name in the plant.
        file: its spec as the current folder sees it; ``spec`` as the plant writes it.
        pose: its world in the world of the plant.
        document: its spec as it was read.
    """

    key: str
    path: YamlPath
    span: Span
    file: str
    spec: str
    owner: str
    pose: Pose
    graph: CellGraph
    document: SourceDocument

    @property
    def cell(self) -> Cell:
        """What its spec says."""
        return self.graph.cell

    @property
    def domain(self) -> int:
        """The domain of its graph."""
        return self.cell.network.domain_id

    def own_name(self, topic: str) -> str:
        """Return what its own graph calls a topic of the plant; those of other cells have their namespace there."""
        return topic.removeprefix(f"/{self.key}") if topic.startswith(f"/{self.key}/") else topic

    def frame_of(self, reference: str) -> str | None:
        """Return the TF frame that its spec calls so; None where it has no such frame."""
        if reference in self.graph.frames:
            return reference
        device, _, short = reference.partition("/")
        links = (each.body.frames for each in self.cell.devices if each.name == device)
        return next((frames[short] for frames in links if short in frames), None)

    def at_rest(self, frame: str) -> Pose | None:
        """Return the pose of a frame in the world of the cell; None for one that moves, or hangs on what moves."""
        return self.graph.frames.pose_in(frame, WORLD, rigid=True)

    def interface(self, name: str) -> Interface | None:
        """Find an interface by the name that its own graph has for it."""
        return next((each for each in self.cell.interfaces if each.name == name), None)


def bridge_name(source: str, receiver: str) -> str:
    """Return what the bridge from one cell to another is called."""
    return f"{source}_to_{receiver}"


def bridge_node(source: Part, receiver: Part, of: Part) -> str:
    """Return the name of the bridge's node in the graph of one of its cells.

    The program adds the number of the domain (domain_bridge/src/domain_bridge/domain_bridge.cpp, 0.5.0).
    """
    return f"{bridge_name(source.key, receiver.key)}_{of.domain}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Crossing:
    """A topic from a node of one cell to one of another."""

    name: str
    path: YamlPath
    span: Span
    type: str
    owner: str
    source: Part
    source_node: str
    receiver: Part
    receiver_node: str


@dataclass(frozen=True, slots=True, kw_only=True)
class PlantArea:
    """A volume that arms of several cells share, in the world of the plant: full edge lengths in m."""

    name: str
    span: Span
    pose: Pose
    size: Vector3
    granted_by: str
    released: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Plant:
    """Cells, what crosses between them, and the volumes that they share; in the order of the spec."""

    name: str
    named_at: Span
    file: str
    summary: str
    parts: Mapping[str, Part]
    crossings: tuple[Crossing, ...]
    areas: tuple[PlantArea, ...]

    @property
    def first(self) -> Part:
        """The cell that the distribution and the middleware of all are compared with."""
        return next(iter(self.parts.values()))

    @property
    def presence(self) -> Presence:
        """The plant as other specs of a call see it: it has no graph of its own."""
        place = self.named_at
        return Presence(self.name, place, domain_id=-1, discovery="off", cards=(), peers=(), domain_at=place)

    def pairs(self) -> Iterator[tuple[Part, Part]]:
        """Yield each two cells once."""
        parts = tuple(self.parts.values())
        yield from ((one, other) for number, one in enumerate(parts) for other in parts[number + 1 :])

    def bridges(self) -> Mapping[tuple[str, str], tuple[Crossing, ...]]:
        """Return what crosses from one cell to another, by their keys."""
        found: dict[tuple[str, str], tuple[Crossing, ...]] = {}
        for crossing in self.crossings:
            keys = (crossing.source.key, crossing.receiver.key)
            found[keys] = (*found.get(keys, ()), crossing)
        return found
