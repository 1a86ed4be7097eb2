"""Which streams of the control stack reach a node, and over which edge."""

from __future__ import annotations

from cellc.contract.contract import Contract
from cellc.mock.bus.matching import hears
from cellc.mock.bus.network import EdgeName, Network
from cellc.mock.bus.stream import StreamEdge
from cellc.mock.engine.control_stack import ControlStack
from cellc.mock.nodes.joint_state_feed import JointStateFeed
from cellc.mock.world.joint_states import JOINT_STATE_TYPE


def joint_state_feeds(
    contract: Contract, control: ControlStack, network: Network, node: str
) -> tuple[JointStateFeed, ...]:
    """Return the joint states whose broadcaster is connected to a node."""
    topics = {
        source.node: name
        for name, interface in contract.interfaces.items()
        if interface.type == JOINT_STATE_TYPE
        for source in interface.sources
    }
    return tuple(
        JointStateFeed(history, stream_edge(contract, network, topics.get(broadcaster, ""), broadcaster, node))
        for (_, broadcaster), history in control.histories.items()
        if hears(contract, topics.get(broadcaster, ""), broadcaster, node)
    )


def stream_edge(contract: Contract, network: Network, topic: str, source: str, sink: str) -> StreamEdge | None:
    """Return the edge of a stream; None where the contract does not describe both of its ends."""
    interface = contract.interfaces.get(topic)
    if interface is None:
        return None
    offered = next((end.qos for end in interface.sources if end.node == source), None)
    requested = next((end.qos for end in interface.sinks if end.node == sink), None)
    if offered is None or requested is None:
        return None
    return StreamEdge(EdgeName(topic, source, sink), offered, requested, network)
