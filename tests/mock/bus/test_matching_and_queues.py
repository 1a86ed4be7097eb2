"""Topics: the offer and request table of ROS 2, and queues with history and depth.

Expected values are the rows of the compatibility table in the ROS 2 page "About Quality of Service settings".
"""

from __future__ import annotations

from typing import Any

import pytest

from cellc.contract.entities import SimulatedNetwork
from cellc.contract.qos import incompatibilities
from cellc.mock.bus.network import QosEventKind
from tests.mock.bus.bench import Bench, qos

TABLE = [
    ("reliability", "best_effort", "best_effort", True),
    ("reliability", "best_effort", "reliable", False),
    ("reliability", "reliable", "best_effort", True),
    ("reliability", "reliable", "reliable", True),
    ("durability", "volatile", "volatile", True),
    ("durability", "volatile", "transient_local", False),
    ("durability", "transient_local", "volatile", True),
    ("durability", "transient_local", "transient_local", True),
    ("deadline_s", None, None, True),
    ("deadline_s", None, 0.1, False),
    ("deadline_s", 0.1, None, True),
    ("deadline_s", 0.1, 0.1, True),
    ("deadline_s", 0.2, 0.1, False),
    ("deadline_s", 0.1, 0.2, True),
    ("liveliness", "automatic", "automatic", True),
    ("liveliness", "automatic", "manual_by_topic", False),
    ("liveliness", "manual_by_topic", "automatic", True),
    ("liveliness", "manual_by_topic", "manual_by_topic", True),
    ("lease_duration_s", None, None, True),
    ("lease_duration_s", None, 0.1, False),
    ("lease_duration_s", 0.1, None, True),
    ("lease_duration_s", 0.2, 0.1, False),
    ("lease_duration_s", 0.1, 0.2, True),
    ("history", "keep_last", "keep_all", True),
    ("depth", 1, 100, True),
    ("lifespan_s", 0.1, None, True),
]


@pytest.mark.parametrize(("policy", "offered", "requested", "connects"), TABLE)
def test_policies_connect_as_in_the_table(policy: str, offered: Any, requested: Any, connects: bool) -> None:
    found = incompatibilities(qos(**{policy: offered}), qos(**{policy: requested}))
    assert (not found) is connects
    bench = Bench(qos(**{policy: offered}), qos(**{policy: requested}))
    subscription = bench.subscribe()
    bench.topic.publish("talker", 1)
    assert bool(bench.drain(subscription)) is connects


def test_mismatch_is_told_on_both_sides_with_its_policies() -> None:
    bench = Bench(qos(reliability="best_effort"), qos(durability="transient_local"))
    bench.subscribe()
    assert bench.topic.mismatches == [
        "`/numbers` from `talker` to `listener` is not connected: reliability: offered best_effort, requested reliable",
        "`/numbers` from `talker` to `listener` is not connected: durability: offered volatile, requested "
        "transient_local",
    ]
    assert [(event.kind, event.node, event.detail) for event in bench.network.events.log] == [
        (QosEventKind.OFFERED_QOS_INCOMPATIBLE, "talker", "reliability, durability"),
        (QosEventKind.REQUESTED_QOS_INCOMPATIBLE, "listener", "reliability, durability"),
    ]


def test_full_queue_drops_the_oldest() -> None:
    bench = Bench(qos(), qos(depth=2))
    subscription = bench.subscribe()
    bench.publish_every(1, count=3)
    assert bench.drain(subscription) == [2, 3]
    assert subscription.dropped == 1


def test_keep_all_drops_nothing() -> None:
    bench = Bench(qos(), qos(history="keep_all", depth=1))
    subscription = bench.subscribe()
    bench.publish_every(1, count=100)
    assert bench.drain(subscription) == list(range(1, 101))


def test_late_joiner_gets_what_is_latched_up_to_the_depth_of_the_publisher() -> None:
    bench = Bench(qos(durability="transient_local", depth=2), qos(durability="transient_local"))
    bench.publish_every(1, count=3)
    assert bench.drain(bench.subscribe()) == [2, 3]


def test_volatile_late_joiner_gets_new_samples_only() -> None:
    bench = Bench(qos(durability="transient_local"), qos())
    bench.publish_every(1, count=1)
    subscription = bench.subscribe()
    bench.publish_every(1, count=1, first=2)
    assert bench.drain(subscription) == [2]


def test_sample_older_than_its_lifespan_is_not_taken_from_the_queue() -> None:
    bench = Bench(qos(lifespan_s=0.1), qos())
    subscription = bench.subscribe()
    bench.publish_every(50, count=2)
    bench.clock.run_until(100)
    assert bench.drain(subscription) == [2]
    assert subscription.expired == 1


def test_sample_whose_lifespan_ends_on_the_way_never_arrives() -> None:
    bench = Bench(qos(lifespan_s=0.1), qos(), network=SimulatedNetwork(latency_s=0.1))
    subscription = bench.listen()
    bench.topic.publish("talker", 1)
    bench.clock.run_until(200)
    assert (bench.received, subscription.expired, subscription.arrived) == ([], 1, 0)


def test_latched_sample_past_its_lifespan_is_not_given_to_a_late_joiner() -> None:
    bench = Bench(qos(durability="transient_local", lifespan_s=0.1), qos(durability="transient_local"))
    bench.publish_every(60, count=2)
    bench.clock.run_until(100)
    assert bench.drain(bench.subscribe()) == [2]


def test_node_that_the_contract_does_not_name_neither_subscribes_nor_is_heard() -> None:
    bench = Bench(qos(), qos())
    subscription = bench.subscribe()
    assert bench.topic.subscribe("stranger") is None
    bench.topic.publish("stranger", 1)
    assert (bench.drain(subscription), bench.topic.published) == ([], 0)
