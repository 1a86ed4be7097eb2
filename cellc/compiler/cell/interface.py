"""Nodes of a cell and the contracts between them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import field
from enum import Enum
from typing import Annotated

from cellc.compiler.cell.entity import ELSEWHERE, Entity
from cellc.contract.diagnostics import Span, YamlPath
from cellc.contract.entities import TARGETS, ContractEndpoint, ContractInterface, Target
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import UNKNOWN

ParameterValue = bool | int | float | str | tuple[bool | int | float | str, ...]
"""What a ROS parameter can hold; an int where a double is declared is a mistake."""


class NodeSource(str, Enum):
    """Who brings a node into the cell."""

    SPEC = "spec"
    DEVICE = "device"  # a driver of the catalog
    STANDARD = "standard"  # robot_state_publisher, controller manager, controllers


@dataclass(frozen=True, slots=True, kw_only=True)
class NodeEndpoints:
    """What a program has at the ROS graph beside its offers, by its own names, ``~/`` below its own."""

    publishes: tuple[str, ...] = ()
    subscribes: tuple[str, ...] = ()
    serves: tuple[str, ...] = ()
    requests: tuple[str, ...] = ()
    executes: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class InnerNode:
    """A node in the process of another; ``full_name`` may end with ``*`` where it differs at every start."""

    full_name: str
    endpoints: NodeEndpoints
    parameters: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class ImpliedEndpoints:
    """What nodes have by what they are, in the distribution of the cell: all, and those of a kind besides."""

    node: NodeEndpoints = field(default_factory=NodeEndpoints)
    lifecycle: NodeEndpoints = field(default_factory=NodeEndpoints)
    controller: NodeEndpoints = field(default_factory=NodeEndpoints)
    component: NodeEndpoints = field(default_factory=NodeEndpoints)
    transforms: NodeEndpoints = field(default_factory=NodeEndpoints)


@dataclass(frozen=True, slots=True, kw_only=True)
class Callback:
    """What a node executes for an interface, or for a timer, which has a period.

    ``group`` is empty for the default one of the node, which is mutually exclusive.
    """

    takes_s: float | None
    group: str = ""
    reentrant: bool = False
    waits_for: tuple[str, ...] = ()
    period_s: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Node(Entity):
    """A node; ``name`` is its bare name, ``namespace`` empty or with a leading slash.

    ``clock`` is ``wall``, ``sim`` or None for the target's; ``real_only`` nodes are not started on a mock. ``host``
    is the computer that runs it, empty where the cell names none. ``remaps``
    are topics as the node's program names them → the names that they have in the cell. ``inside`` are further nodes of
    its process. ``callbacks`` are what it executes, as far as the spec says.
    """

    source: NodeSource
    package: str
    executable: str
    namespace: str = ""
    host: str
    lifecycle: bool = False
    owner: str
    language: str = UNKNOWN
    clock: str | None = None
    respawn: bool = False
    real_only: bool = False
    device: str | None = None
    executor: str | None = None
    threads: int | None = None
    callbacks: Mapping[str, Callback] = field(default_factory=dict)
    parameters: Mapping[str, ParameterValue]
    remaps: Mapping[str, str] = field(default_factory=dict)
    endpoints: Annotated[NodeEndpoints, ELSEWHERE] = field(default_factory=NodeEndpoints)
    inside: Annotated[tuple[InnerNode, ...], ELSEWHERE] = ()

    @property
    def is_planner(self) -> bool:
        """Whether it is MoveIt's move_group."""
        return self.package == "moveit_ros_move_group" and self.executable == "move_group"

    @property
    def is_bridge(self) -> bool:
        """Whether it is the end of a bridge to another cell, which is started with the plant of both."""
        return self.package == "domain_bridge" and self.executable == "domain_bridge"

    @property
    def full_name(self) -> str:
        """Fully qualified name, with a leading slash."""
        return f"{self.namespace}/{self.name}"

    @property
    def is_one_thread(self) -> bool:
        """Whether one thread executes all of its callbacks."""
        return self.executor in ("single_threaded", "events") or (self.executor is not None and self.threads == 1)

    def line_of(self, callback: Callback) -> str:
        """Return what callbacks share that never execute at the same time; empty for one that waits for none."""
        if self.is_one_thread:
            return self.full_name
        return "" if callback.reentrant else f"{self.full_name} {callback.group}".rstrip()


def node_labels(nodes: Sequence[Node]) -> tuple[str, ...]:
    """Return a name for each node that no other of them has: the bare one, or the full one where several share it."""
    times = Counter(node.name for node in nodes)
    return tuple(node.name if times[node.name] == 1 else node.full_name for node in nodes)


@dataclass(frozen=True, slots=True, kw_only=True)
class Endpoint(ContractEndpoint):
    """One end of an interface: a node, controller or device, and the QoS it offers or requests.

    Args:
        node: what the spec calls it: a node, a controller or a device. No other end of the cell is called so: where
            managers have controllers of one name, it is the full name.
        full_name: fully qualified name of the node in the ROS graph.
        targets: targets on which it is there.
    """

    path: YamlPath
    span: Span


@dataclass(frozen=True, slots=True, kw_only=True)
class Interface(Entity, ContractInterface):
    """A topic, service or action under its fully qualified name.

    ``sources`` publish a topic or serve a service or action; ``sinks`` subscribe to it or are its clients.
    ``derived`` interfaces follow from a device or controller and were not written by the user. ``timeout_s`` bounds a
    response or a whole goal; ``goal_time_s`` is what a controller allows past the end of a trajectory.
    """

    sources: tuple[Endpoint, ...]
    sinks: tuple[Endpoint, ...]
    derived: bool = False
    goal_time_s: float | None = None

    @property
    def targets(self) -> tuple[Target, ...]:
        """Targets on which somebody publishes or serves it; every target where no source is declared."""
        targets = {target for source in self.sources for target in source.targets}
        return tuple(target for target in TARGETS if target in targets or not self.sources)
