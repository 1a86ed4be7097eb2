"""QoS of a node's topics as the parameters that rclcpp's QosOverridingOptions read."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.cell import Cell
from cellc.cell.interface import InterfaceKind, Node, ParameterValue, Qos

_NANOSECONDS = 1_000_000_000


def qos_parameters(cell: Cell, node: Node) -> dict[str, ParameterValue]:
    """Return the overrides of a node for the topics that the spec writes; none for one that has no end there."""
    found: dict[str, ParameterValue] = {}
    for topic in cell.interfaces:
        if topic.kind is not InterfaceKind.TOPIC or topic.derived:
            continue
        for side, ends in (("publisher", topic.sources), ("subscription", topic.sinks)):
            for qos in (end.qos for end in ends if end.full_name == node.full_name):
                prefix = f"qos_overrides.{topic.name}.{side}"
                found |= {f"{prefix}.{policy}": value for policy, value in _policies(qos, side)}
    return found


def _policies(qos: Qos, side: str) -> Iterator[tuple[str, ParameterValue]]:
    yield "reliability", qos.reliability
    yield "durability", qos.durability
    yield "history", qos.history
    yield "depth", qos.depth
    yield "liveliness", qos.liveliness
    durations = {"deadline": qos.deadline_s, "liveliness_lease_duration": qos.lease_duration_s}
    if side == "publisher":  # a lifespan belongs to the sample's writer
        durations["lifespan"] = qos.lifespan_s
    for name, seconds in durations.items():
        if seconds is not None:
            yield name, round(seconds * _NANOSECONDS)
