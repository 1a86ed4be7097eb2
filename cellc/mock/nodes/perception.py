"""Perception: images in, stamped object poses and their transform out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from cellc.contract.contract import ContractFrame
from cellc.mock.bus.subscription import Subscription
from cellc.mock.clocks import Clock
from cellc.mock.engine.simulation import Simulation
from cellc.mock.nodes.camera import Image
from cellc.mock.nodes.tf_broadcast import TransformSink
from cellc.mock.tf.deferred import DeferredPose
from cellc.mock.world.objects import World
from cellc.transforms import Pose

PROCESSING_S = 0.02
"""Simulated time from taking an image to knowing the pose in it; no field of the contract states one."""


@dataclass(frozen=True, slots=True)
class ObjectPose:
    """A geometry_msgs/PoseStamped of an object: the stamp is that of the image, not of the message."""

    stamp_ns: int
    frame: str
    seen: DeferredPose

    @property
    def pose(self) -> Pose:
        """The pose, computed now where nobody has looked at it yet."""
        return self.seen.get()


PoseListener = Callable[[ObjectPose, bool], None]
"""Takes a published pose, and whether it was published as a transform too."""


class Perception:
    """Finds one object in the images of one camera.

    Attributes:
        publishes_transform: cleared by a fault; the pose topic goes on.
        rejected: images that were too old when their turn came, or stamped as far in the future.
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
        simulation: Simulation,
    ) -> None:
        """Bind the node that publishes frame ``name``, as a transform and through ``publish``.

        Args:
            clock: on which the node measures how old an image is.
        """
        self.publishes_transform = True
        self.rejected = 0
        self._name = name
        self._frame = frame
        self._images = images
        self._max_image_age_ns = None if max_image_age_s is None else round(max_image_age_s * 1e9)
        self._publish_pose = publish
        self._transform = transform
        self._world = world
        self._clock = clock
        self._simulation = simulation
        self._listeners: list[PoseListener] = []

    def listen(self, listener: PoseListener) -> None:
        """Call ``listener`` with every pose that is published, and whether its transform is too."""
        self._listeners.append(listener)

    def start(self, rate_hz: float) -> None:
        """Take an image at every tick from now on."""
        self._simulation.every(self._simulation.now_ns, rate_hz, lambda _: self._look())

    def _look(self) -> None:
        now_ns = self._simulation.now_ns
        received = self._images.take(now_ns)
        if received is None:
            return
        image = received.sample
        age_ns = self._clock.read(now_ns) - image.stamp_ns
        if self._max_image_age_ns is not None and abs(age_ns) > self._max_image_age_ns:
            self.rejected += 1
            return
        self._simulation.at_background(now_ns + round(PROCESSING_S * 1e9), lambda: self._publish(image))

    def _publish(self, image: Image) -> None:
        """Publish where the object was, seen from the camera, when the image was taken."""
        seen = self._world.sight(image.frame, self._name, image.taken_ns)
        if self.publishes_transform:
            self._transform.insert(image.stamp_ns, seen)
        published = ObjectPose(image.stamp_ns, self._frame.parent, seen)
        self._publish_pose(published)
        for listener in self._listeners:
            listener(published, self.publishes_transform)
