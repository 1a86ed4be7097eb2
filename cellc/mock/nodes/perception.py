"""Cameras and perception: images in, stamped object poses and their transforms on /tf out."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Protocol

from cellc.contract.contract import ContractFrame
from cellc.contract.devices import ContractCamera
from cellc.contract.entities import ContractInterface, Processing
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose
from cellc.mock.bus.edge import Subscription
from cellc.mock.bus.network import Network
from cellc.mock.bus.topic import Topic
from cellc.mock.clocks import Clock
from cellc.mock.engine.simulation import Simulation
from cellc.mock.nodes.executors import Executors
from cellc.mock.tf.sources import DeferredPose, SampledSource
from cellc.mock.world.world import World

DEFAULT_TRANSPORT_S = 0.005
"""Where the contract states no transport time: readout and copy of one image on a local bus."""

TF = "/tf"
POSE_TYPE = "geometry_msgs/msg/PoseStamped"
DEFAULT_RATE_HZ = 10.0
"""Of a dynamic frame whose rate is not stated."""
PROCESSING_S = 0.02
"""Simulated time from taking an image to knowing the pose in it, where the contract states no callback."""


@dataclass(frozen=True, slots=True)
class Image:
    """What is known of an image: when its exposure began, and which one it is.

    Attributes:
        stamp_ns: begin of the exposure on the clock of the camera.
        taken_ns: the same in simulated time, which no node knows.
    """

    stamp_ns: int
    taken_ns: int
    frame: str
    sequence: int


class Camera:
    """Publishes one stream; a frozen camera repeats its last image with its old stamp.

    Attributes:
        last: the image delivered last.
    """

    def __init__(
        self,
        device: str,
        facts: ContractCamera,
        topic: Topic[Image],
        transport_s: float | None,
        clock: Clock,
        simulation: Simulation,
    ) -> None:
        """Bind the camera to its topic; ``transport_s`` is the time from readout to arrival."""
        self.device = device
        self._frozen = False
        self.last: Image | None = None
        self._listeners: list[Callable[[Image], None]] = []
        self._facts = facts
        self._topic = topic
        self._clock = clock
        self._simulation = simulation
        transport = DEFAULT_TRANSPORT_S if transport_s is None else transport_s
        self._latency_ns = round((facts.exposure_s + transport) * 1e9)

    def listen(self, listener: Callable[[Image], None]) -> None:
        """Call ``listener`` with every image as it is delivered."""
        self._listeners.append(listener)

    def freeze(self, frozen: bool) -> None:
        """Repeat the last image with its old stamp from now on, or stream again."""
        self._frozen = frozen

    def start(self) -> None:
        """Stream from now on."""
        start_ns = self._simulation.now_ns
        rate_hz = self._facts.rate_hz

        def deliver(sequence: int) -> None:
            taken_ns = start_ns + round(sequence * 1e9 / rate_hz)
            self._deliver(Image(self._clock.read(taken_ns), taken_ns, self._facts.frame, sequence))

        self._simulation.every(start_ns + self._latency_ns, rate_hz, deliver)

    def _deliver(self, image: Image) -> None:
        if not self._frozen or self.last is None:
            self.last = image
        self._topic.publish(self.device, self.last)
        for listener in self._listeners:
            listener(self.last)


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


@dataclass(frozen=True, slots=True)
class ObjectPose:
    """A geometry_msgs/PoseStamped of an object: the stamp is that of the image, not of the message."""

    stamp_ns: int
    frame: str
    seen: DeferredPose

    @property
    def pose(self) -> Pose:
        """The pose, computed at its first use."""
        return self.seen.get()


PoseListener = Callable[[ObjectPose, bool], None]
"""Takes a published pose, and whether it was published as a transform too."""


@dataclass(frozen=True, slots=True)
class Look:
    """An image that a node has taken from its queue, when, and whether it was too old to be used."""

    image: Image
    taken_ns: int
    rejected: bool


class Perception:
    """Finds one object in the images of one camera.

    Attributes:
        taken: images that were taken from the queue.
        rejected: those that were too old when taken, or stamped as far in the future.
        oldest_ns: the greatest age of those that were rejected.
        last: what was taken last.
    """

    def __init__(
        self,
        name: str,
        frame: ContractFrame,
        images: Subscription[Image],
        max_image_age_s: float | None,
        publish: Callable[[ObjectPose], None],
        transform: TransformSink,
        world: World,
        clock: Clock,
        executors: Executors,
        simulation: Simulation,
    ) -> None:
        """Bind the node that publishes frame ``name``, as a transform and through ``publish``.

        Args:
            clock: on which the node measures how old an image is.
        """
        self._publishes_transform = True
        self._looks = True
        self.taken = 0
        self.rejected = 0
        self.oldest_ns = 0
        self.last: Look | None = None
        self._name = name
        self._frame = frame
        self._images = images
        self._max_image_age_ns = None if max_image_age_s is None else round(max_image_age_s * 1e9)
        self._publish_pose = publish
        self._transform = transform
        self._world = world
        self._clock = clock
        self._executors = executors
        self._simulation = simulation
        self._processing = images.endpoint.processing or Processing(line="", takes_s=PROCESSING_S)
        self._listeners: list[PoseListener] = []

    def listen(self, listener: PoseListener) -> None:
        """Call ``listener`` with every pose that is published, and whether its transform is too."""
        self._listeners.append(listener)

    @property
    def depth(self) -> int | None:
        """How many images its queue holds; None for any number."""
        qos = self._images.endpoint.qos
        return None if qos.history == "keep_all" else qos.depth

    def publish_transform(self, publish: bool) -> None:
        """Publish poses as transforms too from now on, or no more; the pose topic goes on."""
        self._publishes_transform = publish

    def leave_to(self, see: Callable[[Image], None], *, takes_time: bool) -> None:
        """Let somebody else look at each image as it arrives, and publish what is seen in it by `answer`.

        Args:
            takes_time: an answer is known after the time that the callback takes; else when it comes.
        """

        def arrive() -> None:
            now_ns = self._simulation.now_ns
            received = self._images.take(now_ns)
            if received is not None:
                self.taken += 1
                self.last = Look(received.sample, now_ns, rejected=False)
                see(received.sample)

        self._images.listen(arrive)
        self._looks = False
        if not takes_time:
            self._processing = Processing(line="", takes_s=0.0)

    def answer(self, published: ObjectPose) -> None:
        """Publish a pose once the callback has ended that it comes from."""

        def publish() -> None:
            self._publish_pose(published)
            for listener in self._listeners:
                listener(published, False)

        self._executors.execute(self._processing, publish)

    def answer_transform(self, stamp_ns: int, pose: Pose) -> None:
        """Publish a transform once the callback has ended that it comes from."""
        if self._publishes_transform:
            self._executors.execute(self._processing, partial(self._transform.insert, stamp_ns, pose))

    def start(self, rate_hz: float) -> None:
        """Take an image at every tick from now on."""
        if self._looks:
            self._simulation.every(self._simulation.now_ns, rate_hz, lambda _: self._look())

    def _look(self) -> None:
        now_ns = self._simulation.now_ns
        received = self._images.take(now_ns)
        if received is None:
            return
        image = received.sample
        age_ns = self._clock.read(now_ns) - image.stamp_ns
        rejected = self._max_image_age_ns is not None and abs(age_ns) > self._max_image_age_ns
        self.taken += 1
        self.last = Look(image, now_ns, rejected)
        if rejected:
            self.rejected += 1
            self.oldest_ns = max(self.oldest_ns, abs(age_ns))
            return
        self._executors.execute(self._processing, lambda: self._publish(image))

    def _publish(self, image: Image) -> None:
        """Publish where the object was, seen from the camera, when the image was taken."""
        seen = self._world.sight(image.frame, self._name, image.taken_ns)
        if self._publishes_transform:
            self._transform.insert(image.stamp_ns, seen)
        published = ObjectPose(image.stamp_ns, self._frame.parent, seen)
        self._publish_pose(published)
        for listener in self._listeners:
            listener(published, self._publishes_transform)
