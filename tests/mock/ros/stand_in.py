"""A graph without ROS: in place of the bridge, with a perception node that does what a test says."""

from __future__ import annotations

import struct
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import pytest

from cellc.contract.entities import Qos
from cellc.mock import MockCell
from cellc.mock.cell import Watch
from cellc.mock.evidence.bag import messages
from cellc.mock.evidence.bag.messages import StampedTransform
from cellc.mock.evidence.images.photographer import Photographer
from cellc.mock.plant import Plant
from cellc.mock.ros import session
from cellc.mock.ros.asked import AmongNodes, Timing
from cellc.mock.ros.bridge import GraphEnd, Received
from cellc.mock.ros.session import Judged, rehearse_among

IMAGES, POSES = "/camera/color/image_raw", "/object_pose"
CAMERA = "camera_color_optical_frame"
Said = tuple[str, bytes]
Node = Callable[["Graph", int], Sequence[Said]]
"""What a node publishes after it has seen an image of a stamp."""


class Graph:
    """Answers as the program at the other end of the bridge does."""

    def __init__(self, node: Node, **changes: Any) -> None:
        self.node = node
        self.plant: Plant | None = None
        self.clock_ns = 0
        self.published: list[str] = []
        self.ahead_ns = -(10**9)
        """By how much the newest joint state was ahead of the time at which an image was published, at most."""
        self._states_ns = 0
        self.distro = str(changes.get("distro", "jazzy"))
        self.seen = frozenset(changes.get("nodes", {"/perception"}))
        self.ends: Mapping[str, Sequence[GraphEnd]] = {
            IMAGES: [GraphEnd("/perception", messages.IMAGE, "best_effort", "volatile")],
            POSES: [GraphEnd("/perception", messages.POSE_STAMPED, "reliable", "volatile")],
            **changes.get("ends", {}),
        }
        self.services: dict[str, int] = {}
        self.actions: dict[str, int] = {}
        self.parameters: dict[str, dict[str, object]] = {}
        """Of each node that is played."""
        self.code: int | None = changes.get("code")
        self._topics: dict[int, str] = {}
        self._channels: dict[str, int] = {}
        self._said: deque[Received] = deque()

    def __enter__(self) -> Graph:
        return self

    def __exit__(self, *_: object) -> None:
        return

    def environment(self) -> dict[str, str]:
        return {"distro": self.distro}

    def nodes(self) -> frozenset[str]:
        return self.seen

    def publishers(self, topic: str) -> Sequence[GraphEnd]:
        return () if topic == IMAGES else self.ends.get(topic, ())

    def subscriptions(self, topic: str) -> Sequence[GraphEnd]:
        return self.ends.get(topic, ()) if topic == IMAGES else ()

    def heard(self) -> frozenset[int]:
        return frozenset(self._topics)

    def open_node(self, node: str, parameters: Mapping[str, object]) -> None:
        self.parameters[node] = dict(parameters)

    def open_publisher(self, channel: int, node: str, topic: str, kind: str, qos: Qos) -> None:
        self._topics[channel] = topic

    def open_subscription(self, channel: int, node: str, topic: str, kind: str, qos: Qos) -> None:
        self._channels[topic] = channel

    def open_action(self, channel: int, node: str, action: str, kind: str) -> None:
        self.actions[action] = channel

    def open_service(self, channel: int, node: str, service: str, kind: str) -> None:
        self.services[service] = channel

    def transition(self, node: str, name: str, within_s: float) -> str:
        return ""

    def start(self, command: Sequence[str]) -> None:
        return

    def exit_code(self) -> int | None:
        return self.code

    def publish(self, channel: int, data: bytes) -> None:
        topic = self._topics[channel]
        self.published.append(topic)
        if topic == "/clock":
            self.clock_ns = _stamp_ns(data)
        elif topic == "/joint_states":
            self._states_ns = _stamp_ns(data)
        elif topic == IMAGES:
            if self.plant is not None:
                self.ahead_ns = max(self.ahead_ns, self._states_ns - self.plant.now_ns)
            for name, said in self.node(self, _stamp_ns(data)):
                self._said.append(Received(self._channels[name], said))

    def take(self, within_s: float = 0.0) -> Received | None:
        return self._said.popleft() if self._said else None


def _stamp_ns(data: bytes) -> int:
    seconds, nanoseconds = struct.unpack_from("<iI", data, 4)
    return int(seconds) * 1_000_000_000 + int(nanoseconds)


def right(graph: Graph, stamp_ns: int, *, max_age_ns: int = 100_000_000) -> Sequence[Said]:
    """See the part where it is, with the stamp of the image; an image that is too old is left alone."""
    if graph.clock_ns - stamp_ns > max_age_ns or graph.plant is None:
        return ()
    pose = graph.plant.world.sight(CAMERA, "object", stamp_ns).get()
    transform = messages.transforms((StampedTransform(stamp_ns, CAMERA, "object", pose),))
    return (POSES, messages.pose_stamped(stamp_ns, CAMERA, pose)), ("/tf", transform)


def run(
    cell: MockCell,
    monkeypatch: pytest.MonkeyPatch,
    graph: Graph,
    name: str = "pick_and_place",
    *,
    launch: str = "",
    watch: Watch | None = None,
) -> Judged:
    """Run a rehearsal around the node of a graph, in lockstep."""
    begin = session._Around.begin

    def watched(around: Any, plant: Plant) -> None:
        graph.plant = plant
        begin(around, plant)

    monkeypatch.setattr(session._Around, "begin", watched)
    monkeypatch.setattr(session, "Bridge", lambda *_: graph)
    monkeypatch.setattr(Photographer, "message", lambda _, topic, shot: messages.clock(shot.stamp_ns))  # draws nothing
    for wait in ("_DISCOVERY_S", "_AGAIN_S", "_LOOK_S", "_MEET_S"):
        monkeypatch.setattr(session, wait, 0.0)
    monkeypatch.setattr("cellc.mock.ros.perception._CLOCK_S", 0.0)
    asked = AmongNodes(("perception",), "python3", Timing(None), launch=launch, appear_s=0.0)
    return rehearse_among(cell, cell.entry(name), 0, asked, watch)


def changed(change: Callable[[Graph, int, Sequence[Said]], Sequence[Said]], **allowed: int) -> Node:
    """Return the right node with a change of what it publishes."""
    return partial(_changed, change, allowed)


def _changed(
    change: Callable[[Graph, int, Sequence[Said]], Sequence[Said]],
    allowed: Mapping[str, int],
    graph: Graph,
    stamp_ns: int,
) -> Sequence[Said]:
    return change(graph, stamp_ns, right(graph, stamp_ns, **allowed))
