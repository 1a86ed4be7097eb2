"""Which streams of the control stack reach a node, and over which edge."""

from __future__ import annotations

from cellc.contract.contract import Contract, ContractEndpoint
from cellc.mock.bus.events import QosEvent, QosEventKind
from cellc.mock.bus.matching import hears
from cellc.mock.bus.network import EdgeName, Network
from cellc.mock.bus.stream import StreamEdge
from cellc.mock.bus.timers import StreamDeadline
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


def watch_deadlines(contract: Contract, control: ControlStack, network: Network) -> None:
    """Watch the deadlines that the ends of joint state topics promise or rely on; none costs nothing."""
    for name, interface in contract.interfaces.items():
        if interface.type != JOINT_STATE_TYPE or not network.middleware.tells:
            continue
        for source in interface.sources:
            for (_, broadcaster), history in control.histories.items():
                if broadcaster == source.node and source.qos.deadline_s is not None:
                    sent = JointStateFeed(history, None)
                    _watch(network, QosEventKind.OFFERED_DEADLINE_MISSED, name, source, sent)
        for sink in interface.sinks:
            for feed in joint_state_feeds(contract, control, network, sink.node) if sink.qos.deadline_s else ():
                _watch(network, QosEventKind.REQUESTED_DEADLINE_MISSED, name, sink, feed)


def _watch(network: Network, kind: QosEventKind, topic: str, end: ContractEndpoint, feed: JointStateFeed) -> None:
    def note() -> None:
        network.events.note(QosEvent(kind, topic, end.node, network.timers.now_ns))

    if end.qos.deadline_s is not None:
        StreamDeadline(end.qos.deadline_s, network.timers, feed.newest_arrival_ns, note)


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
