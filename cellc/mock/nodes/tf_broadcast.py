"""Transforms of observed frames on their way over /tf, from the node that publishes them to the listener."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from cellc.contract.contract import ContractInterface
from cellc.mock.bus.network import Network
from cellc.mock.bus.subscription import Subscription
from cellc.mock.bus.topic import Topic
from cellc.mock.engine.simulation import Simulation
from cellc.mock.tf.deferred import DeferredPose
from cellc.mock.tf.sources import SampledSource
from cellc.transforms import Pose

TF = "/tf"


class TransformSink(Protocol):
    """Takes the transforms of one frame."""

    def insert(self, stamp_ns: int, pose: Pose | DeferredPose) -> None:
        """Take a transform."""
        ...


@dataclass(frozen=True, slots=True)
class StampedTransform:
    """A geometry_msgs/TransformStamped; parent and authority are those of the listener's source."""

    child: str
    stamp_ns: int
    pose: Pose | DeferredPose


class TfBroadcast:
    """The topic /tf for frames that nodes observe."""

    def __init__(self, interface: ContractInterface | None, listener: str, network: Network, simulation: Simulation):
        """Bind the topic; where the contract does not describe a connection, transforms arrive as they are sent."""
        self._sources: dict[str, SampledSource] = {}
        self._simulation = simulation
        self._topic: Topic[StampedTransform] | None = None
        self._subscription: Subscription[StampedTransform] | None = None
        self._nodes: tuple[str, ...] = ()
        if interface is not None:
            self._topic = Topic[StampedTransform](TF, interface, network)
            self._subscription = self._topic.subscribe(listener, self._receive)
            self._nodes = tuple(source.node for source in interface.sources)

    def sender(self, node: str, child: str, source: SampledSource) -> TransformSink:
        """Return what a node hands the transforms of a frame to; ``source`` is where the listener stores them."""
        if self._topic is None or self._subscription is None or node not in self._nodes:
            return source
        self._sources[child] = source
        return _Sender(self._topic, node, child)

    def _receive(self) -> None:
        received = None if self._subscription is None else self._subscription.take(self._simulation.now_ns)
        if received is not None:
            sample = received.sample
            self._sources[sample.child].insert(sample.stamp_ns, sample.pose)


@dataclass(frozen=True, slots=True)
class _Sender:
    """The broadcaster of a node for one frame."""

    topic: Topic[StampedTransform]
    node: str
    child: str

    def insert(self, stamp_ns: int, pose: Pose | DeferredPose) -> None:
        """Send a transform."""
        self.topic.publish(self.node, StampedTransform(self.child, stamp_ns, pose))
