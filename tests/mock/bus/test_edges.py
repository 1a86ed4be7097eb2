"""What a network does to samples, and what reliable and best-effort pairs make of it.

A reliable reader sees a change when it has seen all before it, a best-effort one when it has seen none after it
(DDSI-RTPS 2.5, 8.4.1.1). Times are by hand: a sample that is lost is sent again after both ways and 5 ms + 5 ms.
"""

from __future__ import annotations

import hashlib
from random import Random

import pytest

from cellc.contract.entities import Qos, SimulatedNetwork
from cellc.mock.bus.network import SEVERED, EdgeBehavior, QosEventKind, edge_random
from tests.mock.bus.bench import MS, TOPIC, Bench, qos

BEST_EFFORT = qos(reliability="best_effort")


def outage(bench: Bench, from_ms: float, until_ms: float) -> None:
    """Lose every sample that is sent in a span of time."""
    bench.clock.at_background(round(from_ms * MS), lambda: bench.network.disturb(TOPIC, SEVERED))
    bench.clock.at_background(round(until_ms * MS), lambda: bench.network.restore_topic(TOPIC))


def test_latency_is_added_to_every_sample() -> None:
    bench = Bench(qos(), qos(), network=SimulatedNetwork(latency_s=0.004))
    bench.listen()
    bench.publish_every(10, count=3)
    bench.clock.run_until(100)
    assert bench.received == [(4.0, 1), (14.0, 2), (24.0, 3)]


def test_jitter_is_at_most_what_is_stated_and_spread_evenly() -> None:
    bench = Bench(BEST_EFFORT, BEST_EFFORT, network=SimulatedNetwork(latency_s=0.002, jitter_s=0.004))
    bench.listen()
    bench.publish_every(10, count=2000)
    bench.clock.run_until(30_000)
    delays = [at - 10.0 * (sample - 1) for at, sample in bench.received]
    assert len(delays) == 2000
    assert min(delays) >= 2.0
    assert max(delays) <= 6.0
    # The mean of 2000 even draws over 4 ms has a standard error of 4 / sqrt(12 * 2000) = 0.026 ms.
    assert sum(delays) / 2000 == pytest.approx(4.0, abs=0.1)


def test_best_effort_sample_that_is_lost_stays_lost_and_the_reader_is_told() -> None:
    bench = Bench(BEST_EFFORT, BEST_EFFORT)
    subscription = bench.listen()
    outage(bench, 15, 35)
    bench.publish_every(10, count=5)
    assert [sample for _, sample in bench.received] == [1, 2, 5]
    assert subscription.lost == 2
    assert bench.events("listener") == [(40.0, QosEventKind.MESSAGE_LOST)] * 2


def test_reliable_sample_that_is_lost_comes_later_and_those_after_it_wait() -> None:
    bench = Bench(qos(), qos())
    subscription = bench.listen()
    outage(bench, 15, 25)
    bench.publish_every(10, count=5)
    bench.clock.run_until(100)
    # Number 3 is sent at 20 ms into nothing and again at 30 ms, together with number 4.
    assert bench.received == [(0.0, 1), (10.0, 2), (30.0, 3), (30.0, 4), (40.0, 5)]
    assert subscription.lost == 0


def test_reliable_sample_is_sent_again_until_it_arrives() -> None:
    bench = Bench(qos(), qos(), network=SimulatedNetwork(latency_s=0.001))
    bench.listen()
    outage(bench, -1, 30)
    bench.clock.run_until(0)
    bench.topic.publish("talker", 1)
    bench.clock.run_until(200)
    # Severed the way takes no time, so it is tried at 10, 20 and 30 ms; the last one finds the network mended.
    assert bench.received == [(31.0, 1)]


def test_reliable_sample_is_lost_where_the_writer_no_longer_keeps_it() -> None:
    shallow = qos(depth=1)
    bench = Bench(shallow, qos())
    subscription = bench.listen()
    outage(bench, 15, 25)
    bench.publish_every(4, count=10)
    bench.clock.run_until(100)
    # Numbers 5, 6 and 7 are sent at 16, 20 and 24 ms; when they are to be sent again later ones have replaced them.
    assert [sample for _, sample in bench.received] == [1, 2, 3, 4, 8, 9, 10]
    assert subscription.lost == 3


def test_best_effort_reader_of_a_reliable_writer_loses_too() -> None:
    bench = Bench(qos(), BEST_EFFORT)
    subscription = bench.listen()
    outage(bench, 15, 25)
    bench.publish_every(10, count=5)
    bench.clock.run_until(100)
    assert [sample for _, sample in bench.received] == [1, 2, 4, 5]
    assert subscription.lost == 1


@pytest.mark.parametrize(("profile", "kept"), [(BEST_EFFORT, False), (qos(), True)])
def test_overtaken_samples_reach_a_reliable_reader_in_order_and_no_best_effort_one(profile: Qos, kept: bool) -> None:
    bench = Bench(profile, profile, network=SimulatedNetwork(reordering=0.3))
    subscription = bench.listen()
    bench.publish_every(10, count=500)
    bench.network.restore_topic(TOPIC)
    samples = [sample for _, sample in bench.received]
    assert samples == sorted(samples)
    if kept:
        assert samples[:490] == list(range(1, 491))
    else:
        assert subscription.lost == pytest.approx(150, abs=40)  # four standard deviations of 500 draws at 0.3


def test_share_of_lost_samples_is_what_is_stated() -> None:
    bench = Bench(BEST_EFFORT, BEST_EFFORT, network=SimulatedNetwork(loss=0.1))
    bench.listen()
    bench.publish_every(1, count=5000)
    assert len(bench.received) == pytest.approx(4500, abs=85)  # four standard deviations of 21


def test_edge_draws_from_the_digest_of_seed_topic_source_and_sink() -> None:
    digest = hashlib.sha256(b"7\0/numbers\0talker\0listener").digest()
    expected = Random(int.from_bytes(digest, "big"))
    found = edge_random(7, "/numbers", "talker", "listener")
    assert [found.random() for _ in range(5)] == [expected.random() for _ in range(5)]


def test_what_one_edge_loses_does_not_depend_on_another_talker() -> None:
    network = SimulatedNetwork(loss=0.5)
    alone = Bench(BEST_EFFORT, BEST_EFFORT, network=network)
    alone.listen()
    alone.publish_every(1, count=50)
    alone.clock.run_until(100)
    beside = Bench(BEST_EFFORT, BEST_EFFORT, network=network, talkers=("talker", "second"))
    beside.listen()
    for number in range(1, 51):
        beside.topic.publish("second", -number)
        beside.topic.publish("talker", number)
    beside.clock.run_until(100)
    heard = [sample for _, sample in beside.received if sample > 0]
    assert heard == [sample for _, sample in alone.received]


@pytest.mark.parametrize(("seed", "same"), [(0, True), (1, False)])
def test_seed_decides_what_is_lost(seed: int, same: bool) -> None:
    runs = []
    for each in (0, seed):
        bench = Bench(BEST_EFFORT, BEST_EFFORT, network=SimulatedNetwork(loss=0.5, jitter_s=0.001), seed=each)
        bench.listen()
        bench.publish_every(10, count=100)
        bench.clock.run_until(2000)
        runs.append(bench.received)
    assert (runs[0] == runs[1]) is same


def test_disturbance_of_one_sink_leaves_others_alone() -> None:
    bench = Bench(BEST_EFFORT, BEST_EFFORT)
    bench.listen()
    bench.network.disturb(TOPIC, EdgeBehavior(loss=1.0), sink="somebody_else")
    bench.publish_every(1, count=2)
    assert len(bench.received) == 2


def test_cut_stops_a_node_both_ways_until_it_is_mended() -> None:
    bench = Bench(BEST_EFFORT, BEST_EFFORT)
    bench.listen()
    bench.network.cut(["listener"])
    assert bench.network.is_cut("talker", "listener")
    assert bench.network.is_cut("listener", "talker")
    assert not bench.network.is_cut("talker", "third")
    bench.publish_every(1, count=2)
    bench.network.undo_cuts()
    bench.publish_every(1, count=1, first=3)
    assert [sample for _, sample in bench.received] == [3]


def test_cut_between_two_groups_spares_everybody_else() -> None:
    bench = Bench(BEST_EFFORT, BEST_EFFORT)
    bench.network.cut(["talker"], ["other"])
    assert bench.network.is_cut("other", "talker")
    assert not bench.network.is_cut("talker", "listener")
