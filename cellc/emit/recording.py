"""``config/recording_qos.yaml``: what an attempt records, with the QoS that every publisher offers.

QoS override file of rosbag2, whose topics are those of the motion path and those that the spec adds; the command to
record stands in its first lines. Durations are left at their defaults, which match any publisher. Left out: raw images
of cameras on the control path, unless the spec asks for them: their volume belongs on another card.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.cell.cell import Cell
from cellc.cell.interface import Interface, InterfaceKind, Qos
from cellc.formats.header import Header
from cellc.formats.yaml_text import Tree, render
from cellc.graph.cell_graph import CellGraph

_FILE = "config/recording_qos.yaml"


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield the override file."""
    topics = _topics(graph.cell)
    command = [
        "ros2 bag record --storage mcap --include-hidden-topics",
        f"--qos-profile-overrides-path {_FILE}",
        "--output evidence/<attempt_id>/bag",
        *(() if graph.cell.distro == "humble" else ("--topics",)),
        *topics,
    ]
    head = header.commented("#") + "# " + " \\\n#   ".join(command) + "\n\n"
    yield Artifact(_FILE, head + render({name: _profile(qos) for name, qos in topics.items()}))


def _topics(cell: Cell) -> dict[str, Qos]:
    found = {interface.name: _offered(interface) for interface in cell.interfaces if _on_the_path(interface)}
    # Goals and results of actions are hidden services; feedback and status tell what became of them.
    for action in (i for i in cell.interfaces if i.kind is InterfaceKind.ACTION):
        found[f"{action.name}/_action/feedback"] = Qos()
        found[f"{action.name}/_action/status"] = Qos(durability="transient_local", depth=1)
    for name in ("/diagnostics", *cell.spec.recording.topics):
        found.setdefault(name, Qos())
    return found


def _on_the_path(interface: Interface) -> bool:
    return interface.kind is InterfaceKind.TOPIC and not interface.type.endswith(("/Image", "/PointCloud2"))


def _offered(interface: Interface) -> Qos:
    """Return a profile that every publisher satisfies: the weakest that one of them offers."""
    offered = [source.qos for source in interface.sources]
    weak = any(qos.reliability == "best_effort" for qos in offered)
    volatile = any(qos.durability == "volatile" for qos in offered) or not offered
    return Qos(
        reliability="best_effort" if weak else "reliable",
        durability="volatile" if volatile else "transient_local",
        depth=max((qos.depth for qos in offered), default=10),
    )


def _profile(qos: Qos) -> Tree:
    return {
        "history": "keep_last",
        "depth": qos.depth,
        "reliability": qos.reliability,
        "durability": qos.durability,
    }
