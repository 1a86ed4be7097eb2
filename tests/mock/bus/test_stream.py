"""Edges of dense streams: the same rules as for single samples, computed for all of them at once."""

from __future__ import annotations

import numpy as np
import pytest

from cellc.contract.entities import ContractInterface, Qos, SimulatedNetwork
from cellc.contract.vocabulary import InterfaceKind
from cellc.mock.bus.network import SEVERED, EdgeName, Network
from cellc.mock.bus.stream import NEVER_NS, IntArray, StreamEdge
from tests.mock.bus.bench import MS, TOPIC, StepClock, qos

BEST_EFFORT = qos(reliability="best_effort")
NAME = EdgeName(TOPIC, "talker", "listener")


def published(count: int, period_ms: float) -> IntArray:
    instants: IntArray = np.rint(np.arange(count) * period_ms * MS).astype(np.int64)
    return instants


def edge(
    offered: Qos,
    requested: Qos,
    network: SimulatedNetwork | None = None,
    seed: int = 0,
    outage_ms: tuple[float, float] | None = None,
) -> StreamEdge:
    """Return an edge after an outage, with its clock moved past it."""
    clock = StepClock()
    interface = ContractInterface(kind=InterfaceKind.TOPIC, type="", sources=(), sinks=(), simulated=network)
    carried = Network({TOPIC: interface}, clock, seed)
    stream = StreamEdge(NAME, offered, requested, carried)
    if outage_ms is not None:
        clock.run_until(outage_ms[0])
        carried.disturb(TOPIC, SEVERED)
        clock.run_until(outage_ms[1])
        carried.restore_topic(TOPIC)
    return stream


def in_ms(arrivals: IntArray) -> list[float | None]:
    return [None if at == NEVER_NS else int(at) / MS for at in arrivals]


def test_ideal_edge_hands_on_as_it_is_published() -> None:
    stream = edge(qos(), qos())
    assert stream.ideal
    assert in_ms(stream.arrivals(published(3, 2))) == [0.0, 2.0, 4.0]


def test_latency_is_added() -> None:
    stream = edge(qos(), qos(), SimulatedNetwork(latency_s=0.003))
    assert in_ms(stream.arrivals(published(3, 2))) == [3.0, 5.0, 7.0]


def test_best_effort_stream_loses_what_is_sent_in_an_outage() -> None:
    stream = edge(BEST_EFFORT, BEST_EFFORT, outage_ms=(15, 35))
    assert in_ms(stream.arrivals(published(5, 10))) == [0.0, 10.0, None, None, 40.0]


def test_reliable_stream_sends_again_and_later_samples_wait() -> None:
    stream = edge(qos(), qos(), outage_ms=(15, 25))
    # Number 3 is sent at 20 ms into nothing and again after 10 ms, as on a topic of single samples.
    assert in_ms(stream.arrivals(published(5, 10))) == [0.0, 10.0, 30.0, 30.0, 40.0]


def test_reliable_stream_loses_what_its_writer_has_replaced() -> None:
    stream = edge(qos(depth=1), qos(), outage_ms=(15, 25))
    assert in_ms(stream.arrivals(published(10, 4))) == [0.0, 4.0, 8.0, 12.0, None, None, None, 28.0, 32.0, 36.0]


def test_deeper_history_keeps_what_is_sent_again_in_time() -> None:
    stream = edge(qos(depth=3), qos(), outage_ms=(15, 25))
    # 16, 20 and 24 ms are tried again at 26, 30 and 34 ms, when the third sample after each is not yet published.
    expected = [0.0, 4.0, 8.0, 12.0, 26.0, 30.0, 34.0, 34.0, 34.0, 36.0]
    assert in_ms(stream.arrivals(published(10, 4))) == expected


@pytest.mark.parametrize(("profile", "lost"), [(BEST_EFFORT, 0.2), (qos(depth=100), 0.0)])
def test_share_of_lost_samples_is_what_is_stated(profile: Qos, lost: float) -> None:
    stream = edge(profile, profile, SimulatedNetwork(loss=0.2))
    arrivals = stream.arrivals(published(10_000, 2))
    assert np.mean(arrivals == NEVER_NS) == pytest.approx(lost, abs=0.016)  # four standard deviations of 0.004


def test_jitter_is_spread_evenly() -> None:
    stream = edge(BEST_EFFORT, BEST_EFFORT, SimulatedNetwork(jitter_s=0.001))
    sent = published(10_000, 2)
    delays = (stream.arrivals(sent) - sent) / MS
    assert (delays >= 0.0).all()
    assert (delays <= 1.0).all()
    assert np.histogram(delays, bins=10, range=(0.0, 1.0))[0] == pytest.approx([1000] * 10, abs=120)


def test_overtaken_samples_are_lost_to_best_effort_and_late_for_reliable() -> None:
    network = SimulatedNetwork(reordering=0.3)
    sent = published(5000, 2)
    lossy = edge(BEST_EFFORT, BEST_EFFORT, network).arrivals(sent)
    assert np.mean(lossy == NEVER_NS) == pytest.approx(0.3, abs=0.03)
    whole = edge(qos(depth=100), qos(), network).arrivals(sent)
    assert (whole[:4900] < sent[:4900] + 100 * MS).all()
    assert (np.diff(whole) >= 0).all()


def test_what_becomes_of_a_sample_does_not_depend_on_when_it_is_asked_for() -> None:
    network = SimulatedNetwork(loss=0.3, jitter_s=0.004, latency_s=0.001)
    stream = edge(BEST_EFFORT, BEST_EFFORT, network)
    sent = published(500, 2)
    early, late = stream.arrivals(sent[:300]), stream.arrivals(sent)
    known_by = int(sent[290])  # a sample that comes later than the last one known may still be overtaken
    settled = late[:300] <= known_by
    assert (early[settled] == late[:300][settled]).all()
    assert (early[~settled] > known_by).all()


@pytest.mark.parametrize(("seed", "same"), [(0, True), (1, False)])
def test_seed_decides(seed: int, same: bool) -> None:
    network = SimulatedNetwork(loss=0.3)
    first, second = (edge(BEST_EFFORT, BEST_EFFORT, network, seed=each) for each in (0, seed))
    assert (first.arrivals(published(500, 2)) == second.arrivals(published(500, 2))).all() == same


def test_outage_of_seconds_is_computed_at_once() -> None:
    stream = edge(qos(depth=1), qos(), outage_ms=(1000, 4000))
    arrivals = stream.arrivals(published(5000, 2))
    assert np.sum(arrivals == NEVER_NS) == pytest.approx(1500, abs=2)
