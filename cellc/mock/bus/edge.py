"""One matched pair of a topic: samples travel, are lost or overtaken, and wait in the queue of the reader."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from random import Random
from typing import Generic, TypeVar

from cellc.contract.entities import ContractEndpoint
from cellc.contract.frozen import dataclass
from cellc.mock.bus.network import IDEAL, Network, QosEvent, QosEventKind
from cellc.mock.bus.timers import DeadlineWatch, Timers

Sample = TypeVar("Sample")


@dataclass(frozen=True, slots=True)
class Sent(Generic[Sample]):
    """A sample on its way, by its sequence number at the writer."""

    number: int
    sample: Sample
    expires_ns: int | None


class Edge(Generic[Sample]):
    """Carries the samples of a writer to one reader.

    Where both ends are reliable a lost sample is sent again as long as the writer's history still holds it, and later
    ones wait for it; otherwise it is gone, and one that was overtaken comes too late (DDSI-RTPS 2.5, 8.4.9 to 8.4.12:
    a reliable reader sees a change when all before it are seen, a best-effort one when none after it was).

    Attributes:
        behavior: of the network, from the next sample on.
    """

    def __init__(
        self,
        *,
        reliable: bool,
        depth: int | None,
        random: Random,
        timers: Timers,
        deliver: Callable[[Sample, int | None], None],
        lose: Callable[[int], None],
    ) -> None:
        """Bind the pair.

        Args:
            depth: samples that the writer keeps to send again; None for all.
            deliver: called with each sample that reaches the reader, and the time at which it expires.
            lose: called with the number of samples that never will, when the reader knows.
        """
        self.behavior = IDEAL
        self._reliable = reliable
        self._depth = depth
        self._random = random
        self._timers = timers
        self._deliver = deliver
        self._lose = lose
        self._sent = 0
        self._seen = 0
        self._waiting: dict[int, Sent[Sample]] = {}
        self._gone: set[int] = set()
        self._overtaken: list[Sent[Sample]] = []

    def send(self, sample: Sample, expires_ns: int | None) -> None:
        """Send the next sample of the writer."""
        self._sent += 1
        if self.behavior.is_ideal and self._seen == self._sent - 1 and not self._overtaken:
            self._seen = self._sent  # nothing is on its way: what both branches of ``_arrive`` come to
            self._deliver(sample, expires_ns)
            return
        sent = Sent(self._sent, sample, expires_ns)
        if self.behavior.is_ideal:
            self._arrive(sent)
        elif self._random.random() < self.behavior.reordering:
            self._overtaken.append(sent)
        else:
            self._transmit(sent)

    def _transmit(self, sent: Sent[Sample]) -> None:
        behavior, now_ns = self.behavior, self._timers.now_ns
        travel_s = behavior.latency_s + behavior.jitter_s * self._random.random()
        if self._random.random() >= behavior.loss:
            self._timers.at_background(now_ns + round(travel_s * 1e9), lambda: self._arrive(sent))
        elif self._reliable:
            self._timers.at_background(now_ns + round(behavior.retry_s * 1e9), lambda: self._send_again(sent))

    def _send_again(self, sent: Sent[Sample]) -> None:
        if self._depth is None or self._sent - sent.number < self._depth:
            self._transmit(sent)
        else:
            self._gone.add(sent.number)
            self._lose(1)
            self._hand_over()

    def _arrive(self, sent: Sent[Sample]) -> None:
        if self._reliable:
            self._waiting[sent.number] = sent
            self._hand_over()
        elif sent.number > self._seen:
            if sent.number > self._seen + 1:
                self._lose(sent.number - self._seen - 1)
            self._seen = sent.number
            self._deliver(sent.sample, sent.expires_ns)
        overtaken, self._overtaken = self._overtaken, []
        for each in overtaken:
            self._arrive(each)

    def _hand_over(self) -> None:
        """Give the reader what is next, as far as nothing is missing."""
        while (number := self._seen + 1) in self._waiting or number in self._gone:
            self._seen = number
            self._gone.discard(number)
            sent = self._waiting.pop(number, None)
            if sent is not None:
                self._deliver(sent.sample, sent.expires_ns)


@dataclass(frozen=True, slots=True)
class Received(Generic[Sample]):
    """A sample in the queue of a subscription, with the time at which it arrived."""

    arrived_ns: int
    expires_ns: int | None
    sample: Sample


class Subscription(Generic[Sample]):
    """Holds what has arrived and was not taken yet; a full keep-last queue drops its oldest sample.

    Attributes:
        endpoint: who subscribes, and the profile that it requests.
        arrived: number of samples that arrived.
        dropped: number of samples that the queue had no room for.
        expired: number of samples that outlived their lifespan on their way or in the queue.
        lost: number of samples that never arrived, as far as the subscription knows.
    """

    def __init__(self, endpoint: ContractEndpoint, on_sample: Callable[[], None] | None = None) -> None:
        """Bind the subscription; ``on_sample`` is called after each arrival."""
        self.lost = 0
        self.endpoint = endpoint
        self.arrived = 0
        self.dropped = 0
        self.expired = 0
        keep_all = endpoint.qos.history == "keep_all"
        self._depth = None if keep_all else max(1, endpoint.qos.depth)
        self._queue: deque[Received[Sample]] = deque()
        self._on_sample = on_sample

    def listen(self, on_sample: Callable[[], None]) -> None:
        """Call ``on_sample`` after each arrival from now on, in place of what was called before."""
        self._on_sample = on_sample

    def deliver(self, sample: Sample, now_ns: int, expires_ns: int | None) -> None:
        """Put an arriving sample at the end of the queue, unless its lifespan is over."""
        if expires_ns is not None and now_ns >= expires_ns:
            self.expired += 1
            return
        self.arrived += 1
        if self._depth is not None and len(self._queue) >= self._depth:
            self._queue.popleft()
            self.dropped += 1
        self._queue.append(Received(now_ns, expires_ns, sample))
        if self._on_sample is not None:
            self._on_sample()

    def take(self, now_ns: int) -> Received[Sample] | None:
        """Remove and return the oldest sample whose lifespan has not passed, or None."""
        while self._queue:
            received = self._queue.popleft()
            if received.expires_ns is None or now_ns < received.expires_ns:
                return received
            self.expired += 1
        return None


class Reader(Generic[Sample]):
    """Fills a subscription and watches its requested deadline and the liveliness of its writers."""

    def __init__(self, topic: str, subscription: Subscription[Sample], network: Network) -> None:
        """Bind the reader to its subscription."""
        self.subscription = subscription
        self.endpoint = subscription.endpoint
        self._topic = topic
        self._network = network
        self._alive = 0
        self._not_alive = 0
        deadline_s = self.endpoint.qos.deadline_s if network.middleware.reports_events else None
        self._deadline = None if deadline_s is None else DeadlineWatch(deadline_s, network.timers, self._missed)

    def deliver(self, sample: Sample, expires_ns: int | None) -> None:
        """Put a sample into the queue."""
        if self._deadline is not None:
            self._deadline.note()
        self.subscription.deliver(sample, self._network.timers.now_ns, expires_ns)

    def lose(self, count: int) -> None:
        """Take note of samples that will not come."""
        self.subscription.lost += count
        self._note(QosEventKind.MESSAGE_LOST, count)

    def note_liveliness(self, *, alive: bool, known: bool) -> None:
        """Record that a writer is alive, or no longer; ``known`` where it had been alive before."""
        self._alive += 1 if alive else -1
        if known:
            self._not_alive += -1 if alive else 1
        self._note(QosEventKind.LIVELINESS_CHANGED, 1, f"{self._alive} alive, {self._not_alive} not alive")

    def _missed(self) -> None:
        self._note(QosEventKind.REQUESTED_DEADLINE_MISSED, 1)

    def _note(self, kind: QosEventKind, count: int, detail: str = "") -> None:
        now_ns = self._network.timers.now_ns
        self._network.events.note(QosEvent(kind, self._topic, self.endpoint.node, now_ns, count, detail))
