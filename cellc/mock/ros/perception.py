"""A perception node under test: it sees the images of the cell, and the cell takes the poses that it publishes."""

from __future__ import annotations

import math
from collections import OrderedDict
from functools import partial
from time import monotonic, sleep

from cellc.contract.contract import ContractFrame
from cellc.contract.frozen import dataclass
from cellc.contract.qos import DEFAULT
from cellc.contract.transforms import Pose
from cellc.mock.evidence.bag import messages
from cellc.mock.evidence.images.photographer import Photographer, Shot
from cellc.mock.evidence.run_bag import RunBag
from cellc.mock.evidence.topics import transforms_topic
from cellc.mock.nodes.observations import pose_interface
from cellc.mock.nodes.perception import DEFAULT_RATE_HZ, Image, ObjectPose, Perception
from cellc.mock.plant import Plant
from cellc.mock.ros.arrivals import Arrivals
from cellc.mock.ros.asked import Timing
from cellc.mock.ros.bridge import Received
from cellc.mock.ros.graph import Graph
from cellc.mock.ros.incoming import StampedPose, pose_stamped, transforms
from cellc.mock.ros.judgment import Judgment, Violation
from cellc.mock.tf.sources import DeferredPose

_GRACE_S = 0.05
"""Of the host: how long an answer is waited for that may come or not, such as to an image between two others."""
_SILENT = 3
"""After so many images without an answer, none is waited for that long."""
_KEPT = 1000
"""Images whose stamps are remembered: half a minute of a camera."""
_PROBE_AGE_S = 1.0
"""By how much the image is too old that is shown at the end."""
_CLOCK_S = 0.2
"""Of the host: until a node has taken the last message of `/clock`, which comes apart from the images."""
_PROBE_S = 0.3
"""Of the host: how long a node may take to use an image that is too old."""
_LOOK_AGAIN = 30
"""After so many images it is looked again who hears what."""
_UNIT = 1e-3
"""By how much the norm of a quaternion may miss 1."""


@dataclass(frozen=True, slots=True)
class Observed:
    """A dynamic frame that the node publishes.

    Attributes:
        topic: of its poses; empty where it is a transform alone.
        perception: what the cell takes its poses from.
    """

    name: str
    frame: ContractFrame
    topic: str
    perception: Perception


class PerceptionUnderTest:
    """Hands images to a node, and what it answers to the cell.

    Attributes:
        answers: poses that it published.
    """

    def __init__(
        self,
        node: str,
        plant: Plant,
        graph: Graph,
        arrivals: Arrivals,
        bag: RunBag,
        photographer: Photographer,
        judgment: Judgment,
        timing: Timing,
    ) -> None:
        """Take the place of a node of the contract in a plant in which nothing has run yet."""
        self.answers = 0
        self._node, self._plant, self._graph, self._arrivals = node, plant, graph, arrivals
        self._bag, self._photographer, self._judgment, self._timing = bag, photographer, judgment, timing
        self._sent: OrderedDict[int, Shot] = OrderedDict()
        """Images by their stamps."""
        self._too_old = False
        """The image that was sent last is too old, and the node can know it."""
        self._images = 0
        self._newest_ns: int | None = None
        """Stamp of the newest image that was answered; of the first image before any was."""
        self._prompt = True
        self._silent = 0
        self._observed = tuple(self._frames())
        self._device, self._image_topic = self._camera()
        streams = photographer.streams[self._device]
        self._topics = tuple(topic for each in streams for topic in (each.topic, each.info_topic))
        interface = plant.contract.interfaces[self._image_topic]
        self._max_age_ns = None if interface.max_age_s is None else round(interface.max_age_s * 1e9)
        self._channels = {self._poses_of(each): each for each in self._observed if each.topic}
        self._tf = graph.subscribe("/tf", messages.TF_MESSAGE, transforms_topic(plant.contract).qos)
        arrivals.go_to(node, self.take)
        self._observed[0].perception.leave_to(self._see, takes_time=timing.pace is None)
        for each in self._observed[1:]:
            each.perception.leave_to(lambda _: None, takes_time=timing.pace is None)

    def end(self) -> None:
        """Hear what is still on its way, and show the last image once more when it is too old to be used."""
        while self._arrivals.hear(_GRACE_S) is not None:
            pass
        if not self._sent or self._max_age_ns is None:
            return
        stamp_ns, shot = next(reversed(self._sent.items()))
        now_ns = self._plant.now_ns
        ahead_ns = max(0, stamp_ns - self._plant.clocks.of(self._node).read(now_ns))
        late_ns = now_ns + ahead_ns + self._max_age_ns + round(_PROBE_AGE_S * 1e9)
        self._graph.tick(late_ns)
        sleep(_CLOCK_S)
        self._too_old = True
        for topic in filter(self._graph.is_heard, self._topics):
            self._bag.image(topic, self._photographer.message(topic, shot), late_ns)
        while self._arrivals.hear(_PROBE_S) is not None:
            pass

    def _frames(self) -> list[Observed]:
        contract, found = self._plant.contract, []
        for name, perception in self._plant.perceptions.items():
            if contract.frames[name].authority == self._node:
                stated = pose_interface(contract, name)
                found.append(Observed(name, contract.frames[name], "" if stated is None else stated[0], perception))
        return found

    def _camera(self) -> tuple[str, str]:
        """Return the camera that the node looks through, and the topic of its images."""
        devices = self._plant.contract.devices
        for device in self._plant.cameras:
            camera = devices[device].camera
            sinks = () if camera is None else self._plant.contract.interfaces[camera.topic].sinks
            if camera is not None and any(sink.node == self._node for sink in sinks):
                return device, camera.topic
        raise AssertionError("a frame is observed in images of a camera")

    def _poses_of(self, observed: Observed) -> int:
        return self._graph.subscribe(observed.topic, messages.POSE_STAMPED, DEFAULT)

    def _see(self, image: Image) -> None:
        """Send an image, and wait for what is expected of it."""
        now_ns, contract = self._plant.now_ns, self._plant.contract
        shot = self._photographer.take(self._device, image)
        self._graph.tick(now_ns)
        if self._images % _LOOK_AGAIN == 0:
            self._graph.look()
        self._images += 1
        for topic in filter(self._graph.is_heard, self._topics):
            self._bag.image(topic, self._photographer.message(topic, shot), now_ns)
        self._sent[image.stamp_ns] = shot
        age_ns = self._plant.clocks.of(self._node).read(now_ns) - image.stamp_ns
        fresh = self._max_age_ns is None or age_ns <= self._max_age_ns
        if len(self._sent) > _KEPT:
            self._sent.popitem(last=False)
        rate_hz = min(contract.frames[each.name].rate_hz or DEFAULT_RATE_HZ for each in self._observed)
        self._newest_ns = image.stamp_ns if self._newest_ns is None else self._newest_ns
        late = image.stamp_ns - self._newest_ns > 2e9 / rate_hz
        if self._timing.pace is None:
            self._wait(image.stamp_ns, fresh=fresh, late=late)
        if late and fresh and image.stamp_ns - self._newest_ns > 2e9 / rate_hz:
            silent_s = (image.stamp_ns - self._newest_ns) / 1e9
            text = f"no pose from `{self._node}` for {silent_s:.3f} s of images, {rate_hz:g} Hz are stated"
            self._judgment.note(Violation.TOO_SLOW, self._node, text)

    def _wait(self, stamp_ns: int, *, fresh: bool, late: bool) -> None:
        """Let the host's time pass until an image is answered, if it must be, or may be."""
        must = fresh and self._silent < _SILENT and (self._prompt or late)
        until_s = monotonic() + (self._timing.patience_s if must else _GRACE_S)
        while (left_s := until_s - monotonic()) > 0.0 and self._arrivals.hear(left_s) is not None:
            if self.answers and self._newest_ns is not None and self._newest_ns >= stamp_ns:
                self._prompt, self._silent = True, 0
                return
        self._prompt = self._prompt and not fresh
        self._silent += must

    def take(self, received: Received) -> bool:
        """Take a message, where it is one of this node.

        Raises:
            MalformedMessageError: it cannot be read.
        """
        if received.channel == self._tf:
            for each in transforms(received.data):
                self._transform(each)
        elif received.channel in self._channels:
            observed = self._channels[received.channel]
            stamped = pose_stamped(received.data)
            if self._sound(observed.topic, observed, stamped):
                self._note_stamp(observed.topic, stamped.stamp_ns)
                self._answer(observed, stamped)
        else:
            return False
        return True

    def _answer(self, observed: Observed, stamped: StampedPose) -> None:
        self.answers += 1
        self._newest_ns = max(stamped.stamp_ns, self._newest_ns or 0)
        seen = DeferredPose(partial(_pose, stamped.pose))
        observed.perception.answer(ObjectPose(stamped.stamp_ns, observed.frame.parent, seen))

    def _transform(self, stamped: StampedPose) -> None:
        for observed in self._observed:
            if stamped.child == observed.name and self._sound("/tf", observed, stamped):
                observed.perception.answer_transform(stamped.stamp_ns, stamped.pose)
                if not observed.topic:
                    self._note_stamp("/tf", stamped.stamp_ns)
                    self._answer(observed, stamped)

    def _sound(self, topic: str, observed: Observed, stamped: StampedPose) -> bool:
        """Tell whether a pose can be taken; note why it cannot."""
        pose, parent = stamped.pose, observed.frame.parent
        if stamped.frame.removeprefix("/") != parent:
            text = f"`{topic}` is in frame `{stamped.frame}`, the contract has it in `{parent}`"
            self._judgment.note(Violation.WRONG_FRAME, topic, text)
            return False
        norm = math.sqrt(sum(part * part for part in pose.quaternion))
        if not all(map(math.isfinite, (*pose.position, norm))) or abs(norm - 1.0) > _UNIT:
            text = f"`{topic}` has position {pose.position} and quaternion {pose.quaternion}, which is no pose"
            self._judgment.note(Violation.INVALID_POSE, topic, text)
            return False
        return True

    def _note_stamp(self, topic: str, stamp_ns: int) -> None:
        """Compare a stamp with those of the images that were sent."""
        if self._too_old:
            text = f"`{topic}` was seen in an image that was {_PROBE_AGE_S:g} s older than is allowed"
            text += f" on `{self._image_topic}`"
            self._judgment.note(Violation.STALE_INPUT_USED, topic, text)
        elif stamp_ns not in self._sent:
            newest_ns = next(reversed(self._sent), None)
            after = "before any image was sent"
            if newest_ns is not None:
                after = f"{abs(stamp_ns - newest_ns) / 1e6:.3f} ms {'after' if stamp_ns > newest_ns else 'before'}"
                after += " the newest image"
            text = f"`{topic}` is stamped {after}; it must have the stamp of the image that it was seen in"
            self._judgment.note(Violation.STAMP_OF_ANOTHER_TIME, topic, text)


def _pose(pose: Pose) -> Pose:
    return pose
