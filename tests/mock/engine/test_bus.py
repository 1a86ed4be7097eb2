"""Topics: the offer and request table of ROS 2, and queues with history and depth.

Expected values are the rows of the compatibility table in the ROS 2 page "About Quality of Service settings".
"""

from __future__ import annotations

from typing import Any

import pytest

from cellc.contract.contract import ContractInterface, ContractQos
from cellc.mock.bus.qos import incompatibilities
from cellc.mock.bus.subscription import Subscription
from cellc.mock.bus.topic import Topic

PLAIN: dict[str, Any] = {
    "reliability": "reliable",
    "durability": "volatile",
    "history": "keep_last",
    "depth": 10,
    "deadline_s": None,
    "lifespan_s": None,
    "liveliness": "automatic",
    "lease_duration_s": None,
}


def qos(**changes: Any) -> ContractQos:
    return ContractQos.model_validate(PLAIN | changes)


def topic(offered: ContractQos, requested: ContractQos) -> Topic[int]:
    empty = dict.fromkeys(ContractInterface.model_fields)
    entry = empty | {
        "kind": "topic",
        "type": "std_msgs/msg/Int32",
        "sources": [{"node": "talker", "qos": offered}],
        "sinks": [{"node": "listener", "qos": requested}],
    }
    return Topic[int]("/numbers", ContractInterface.model_validate(entry))


def subscribe(numbers: Topic[int], now_ns: int = 0) -> Subscription[int]:
    subscription = numbers.subscribe("listener", now_ns)
    assert subscription is not None
    return subscription


def drain(subscription: Subscription[int], now_ns: int = 0) -> list[int]:
    taken = []
    while (received := subscription.take(now_ns)) is not None:
        taken.append(received.sample)
    return taken


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
    numbers = topic(qos(**{policy: offered}), qos(**{policy: requested}))
    subscription = subscribe(numbers)
    numbers.publish("talker", 1, 0)
    assert bool(drain(subscription)) is connects


def test_mismatch_names_topic_ends_and_policy() -> None:
    numbers = topic(qos(reliability="best_effort"), qos())
    subscribe(numbers)
    assert numbers.mismatches == [
        "`/numbers` from `talker` to `listener` is not connected: reliability: offered best_effort, requested reliable"
    ]


def test_full_queue_drops_the_oldest() -> None:
    numbers = topic(qos(), qos(depth=2))
    subscription = subscribe(numbers)
    for number in (1, 2, 3):
        numbers.publish("talker", number, 0)
    assert drain(subscription) == [2, 3]
    assert subscription.dropped == 1


def test_keep_all_drops_nothing() -> None:
    numbers = topic(qos(), qos(history="keep_all", depth=1))
    subscription = subscribe(numbers)
    for number in range(100):
        numbers.publish("talker", number, 0)
    assert drain(subscription) == list(range(100))


def test_late_joiner_gets_what_is_latched_up_to_the_depth_of_the_publisher() -> None:
    latched = qos(durability="transient_local", depth=2)
    numbers = topic(latched, qos(durability="transient_local"))
    for number in (1, 2, 3):
        numbers.publish("talker", number, 0)
    assert drain(subscribe(numbers)) == [2, 3]


def test_volatile_late_joiner_gets_new_samples_only() -> None:
    numbers = topic(qos(durability="transient_local"), qos())
    numbers.publish("talker", 1, 0)
    subscription = subscribe(numbers)
    numbers.publish("talker", 2, 0)
    assert drain(subscription) == [2]


def test_sample_older_than_its_lifespan_is_not_delivered() -> None:
    numbers = topic(qos(lifespan_s=0.1), qos())
    subscription = subscribe(numbers)
    numbers.publish("talker", 1, 0)
    numbers.publish("talker", 2, 50_000_000)
    assert drain(subscription, now_ns=100_000_000) == [2]
    assert subscription.expired == 1


def test_node_that_the_contract_does_not_name_cannot_subscribe() -> None:
    assert topic(qos(), qos()).subscribe("stranger", 0) is None
