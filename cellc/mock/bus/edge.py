"""One matched pair of a topic: samples travel, are lost, sent again, overtaken, and given to the reader in order."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from random import Random
from typing import Generic, TypeVar

from cellc.mock.bus.behaviour import IDEAL
from cellc.mock.bus.timers import Timers

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
        behaviour: of the network, from the next sample on.
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
            deliver: is given each sample that reaches the reader, with the time at which it expires.
            lose: is told how many samples never will, when the reader knows.
        """
        self.behaviour = IDEAL
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
        sent = Sent(self._sent, sample, expires_ns)
        if self.behaviour.is_ideal:
            self._arrive(sent)
        elif self._random.random() < self.behaviour.reordering:
            self._overtaken.append(sent)
        else:
            self._transmit(sent)

    def _transmit(self, sent: Sent[Sample]) -> None:
        behaviour, now_ns = self.behaviour, self._timers.now_ns
        travel_s = behaviour.latency_s + behaviour.jitter_s * self._random.random()
        if self._random.random() >= behaviour.loss:
            self._timers.at_background(now_ns + round(travel_s * 1e9), lambda: self._arrive(sent))
        elif self._reliable:
            self._timers.at_background(now_ns + round(behaviour.retry_s * 1e9), lambda: self._send_again(sent))

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
