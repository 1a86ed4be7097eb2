"""An edge for a dense stream: nothing happens at its samples, who looks asks which of them have arrived.

The update loop publishes joint states thousands of times between two looks. What becomes of a sample is therefore a
function of the instant at which it was published, and of nothing that was asked before: the random numbers of a sample
are the hash of that instant and the seed of the edge.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from cellc.contract.entities import Qos
from cellc.contract.frozen import dataclass
from cellc.mock.bus.network import EdgeBehavior, EdgeName, Network

IntArray = npt.NDArray[np.int64]
FloatArray = npt.NDArray[np.float64]
NEVER_NS = 2**62
"""Arrival of a sample that is lost."""
_MOST_RETRIES = 4096
"""An outage of a minute at the shortest retry; a sample that is sent again more often counts as lost."""


@dataclass(frozen=True, slots=True)
class BehaviorSince:
    """How an edge behaves from a simulated instant on."""

    from_ns: int
    behavior: EdgeBehavior


class StreamEdge:
    """Tells when samples arrive that were published at given instants.

    Attributes:
        ideal: every sample so far arrived as it was published.
    """

    def __init__(self, name: EdgeName, offered: Qos, requested: Qos, network: Network) -> None:
        """Bind a pair of endpoints that match."""
        self.ideal = True
        self._reliable = (offered.reliability, requested.reliability) == ("reliable", "reliable")
        self._depth = None if offered.history == "keep_all" else max(1, offered.depth)
        self._seed = network.random(name).getrandbits(63)
        self._timers = network.timers
        self._since: list[BehaviorSince] = []
        network.attach(name, self._behave)

    def arrivals(self, published_ns: IntArray) -> IntArray:
        """Return when samples arrive; their instants rise, and none between the first and the last is left out."""
        if self.ideal:
            return published_ns
        arrivals = self._first_arrivals(published_ns)
        if not self._reliable:
            return _without_overtaken(arrivals)
        return _in_order(arrivals)

    def _behave(self, behavior: EdgeBehavior) -> None:
        now_ns = self._timers.now_ns if self._since else 0
        self._since.append(BehaviorSince(now_ns, behavior))
        self.ideal = self.ideal and behavior.is_ideal

    def _first_arrivals(self, published_ns: IntArray) -> IntArray:
        """Return when samples arrive, each on its own: sent, sent again where the pair is reliable, or lost."""
        sent_ns, arrivals = published_ns.copy(), np.full(len(published_ns), NEVER_NS, dtype=np.int64)
        open_, attempt = np.flatnonzero(self._may_arrive(sent_ns)), 0
        while open_.size and attempt < _MOST_RETRIES:
            travel, loss, retry = self._figures(sent_ns[open_], published_ns[open_], attempt)
            through = self._draw(published_ns[open_], 2 * attempt) >= loss
            arrivals[open_[through]] = sent_ns[open_[through]] + travel[through]
            open_, retry = open_[~through], retry[~through]
            if not self._reliable:
                break
            sent_ns[open_] += retry
            open_ = open_[self._kept(open_, sent_ns, published_ns) & self._may_arrive(sent_ns[open_])]
            attempt += 1
        return self._overtake(arrivals, published_ns)

    def _may_arrive(self, sent_ns: IntArray) -> npt.NDArray[np.bool_]:
        """Tell which of the instants are not in an outage that goes on: there is no use in sending into it again."""
        last = self._since[-1]
        return (
            np.asarray(sent_ns < last.from_ns) if last.behavior.loss >= 1.0 else np.ones(len(sent_ns), dtype=np.bool_)
        )

    def _kept(self, open_: IntArray, sent_ns: IntArray, published_ns: IntArray) -> npt.NDArray[np.bool_]:
        """Tell which samples the writer still has when it is to send them again."""
        if self._depth is None:
            return np.ones(len(open_), dtype=np.bool_)
        replaced = np.minimum(open_ + self._depth, len(published_ns) - 1)
        known = open_ + self._depth < len(published_ns)
        return ~known | (published_ns[replaced] > sent_ns[open_])

    def _figures(self, at_ns: IntArray, published_ns: IntArray, attempt: int) -> tuple[IntArray, FloatArray, IntArray]:
        """Return travel time, loss and time to the next attempt of samples that are sent at given instants."""
        begins = [each.from_ns for each in self._since]
        index = np.maximum(np.searchsorted(begins, at_ns, side="right") - 1, 0)
        behaviors = [each.behavior for each in self._since]
        jitter = self._draw(published_ns, 2 * attempt + 1)
        travel_s = np.array([each.latency_s for each in behaviors])[index]
        travel_s = travel_s + np.array([each.jitter_s for each in behaviors])[index] * jitter
        loss = np.array([each.loss for each in behaviors])[index]
        retry_s = np.array([each.retry_s for each in behaviors])[index]
        return np.rint(travel_s * 1e9).astype(np.int64), loss, np.rint(retry_s * 1e9).astype(np.int64)

    def _overtake(self, arrivals: IntArray, published_ns: IntArray) -> IntArray:
        """Let the samples that are overtaken arrive right after the next one that is not."""
        begins = [each.from_ns for each in self._since]
        index = np.maximum(np.searchsorted(begins, published_ns, side="right") - 1, 0)
        share = np.array([each.behavior.reordering for each in self._since])[index]
        late = self._draw(published_ns, -1) < share
        places = np.where(late, len(arrivals), np.arange(len(arrivals)))
        following = np.minimum.accumulate(places[::-1])[::-1]
        known = late & (following < len(arrivals))
        arrivals[known] = np.maximum(arrivals[known], np.minimum(arrivals[following[known]], NEVER_NS - 1) + 1)
        arrivals[late & ~known] = NEVER_NS - 1
        return arrivals

    def _draw(self, published_ns: IntArray, number: int) -> FloatArray:
        """Return numbers from 0 to 1: the hash of each instant, the seed of the edge and the number of the draw."""
        mixed = published_ns.astype(np.uint64) ^ np.uint64((self._seed + 0x9E3779B97F4A7C15 * (number + 2)) % 2**64)
        # The finaliser of SplitMix64 (Steele, Lea, Flood 2014): every bit of the input changes half of the output.
        mixed = (mixed ^ (mixed >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        mixed = (mixed ^ (mixed >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        mixed = mixed ^ (mixed >> np.uint64(31))
        numbers: FloatArray = (mixed >> np.uint64(11)).astype(np.float64) / float(2**53)
        return numbers


def _in_order(arrivals: IntArray) -> IntArray:
    """Let each sample wait for those before it; one that never comes delays no other sample."""
    waited = np.maximum.accumulate(np.where(arrivals == NEVER_NS, 0, arrivals))
    return np.where(arrivals == NEVER_NS, NEVER_NS, waited)


def _without_overtaken(arrivals: IntArray) -> IntArray:
    """Drop each sample that comes after a later one."""
    if not arrivals.size:
        return arrivals
    soonest_later = np.minimum.accumulate(arrivals[::-1])[::-1]
    overtaken = np.append(arrivals[:-1] > soonest_later[1:], False)
    return np.where(overtaken, NEVER_NS, arrivals)
