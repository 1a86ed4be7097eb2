"""Deadlines and liveliness: DDS 1.4, 2.2.3.7 and 2.2.3.11, and the status structures of rmw."""

from __future__ import annotations

import pytest

from cellc.mock.bus.network import EdgeBehavior, QosEventKind
from cellc.mock.bus.qos import ZENOH
from cellc.mock.bus.timers import StreamDeadline
from tests.mock.bus.bench import MS, TOPIC, Bench, StepClock, qos

OFFERED = QosEventKind.OFFERED_DEADLINE_MISSED
REQUESTED = QosEventKind.REQUESTED_DEADLINE_MISSED
LOST = QosEventKind.LIVELINESS_LOST
CHANGED = QosEventKind.LIVELINESS_CHANGED
DEADLINE = qos(deadline_s=0.1)
MANUAL = qos(liveliness="manual_by_topic", lease_duration_s=0.1)


def test_every_period_without_a_sample_is_one_miss_on_either_side() -> None:
    # rmw: "each deadline period the total_count will be incremented by one".
    bench = Bench(DEADLINE, DEADLINE)
    bench.listen()
    bench.topic.publish("talker", 1)
    bench.clock.run_until(350)
    due = [100.000001, 200.000001, 300.000001]  # one nanosecond after the period has passed
    assert bench.events("talker") == [(at, OFFERED) for at in due]
    assert bench.events("listener") == [(at, REQUESTED) for at in due]
    assert bench.network.events.total(REQUESTED, TOPIC, "listener") == 3


def test_sample_at_the_very_end_of_its_period_is_in_time() -> None:
    bench = Bench(DEADLINE, DEADLINE)
    bench.listen()
    bench.publish_every(100, count=10)
    assert bench.network.events.log == []


def test_sample_starts_the_period_anew() -> None:
    bench = Bench(DEADLINE, qos())
    bench.listen()
    bench.publish_every(60, count=3)  # the last at 120 ms
    bench.clock.run_until(230)
    assert bench.events("talker") == [(220.000001, OFFERED)]


def test_publisher_that_never_published_has_missed_nothing() -> None:
    # A deadline is one of an instance, and there is none before the first sample.
    bench = Bench(DEADLINE, DEADLINE)
    bench.listen()
    bench.clock.run_until(1000)
    assert bench.network.events.log == []


def test_lost_samples_are_missed_by_the_reader_alone() -> None:
    bench = Bench(qos(reliability="best_effort", deadline_s=0.1), qos(reliability="best_effort", deadline_s=0.1))
    bench.listen()
    bench.topic.publish("talker", 1)
    bench.network.disturb(TOPIC, EdgeBehavior(loss=1.0))
    bench.clock.run_until(50)
    bench.publish_every(50, count=4, first=2)  # up to 200 ms
    assert bench.events("talker") == []
    assert bench.events("listener") == [(100.000001, REQUESTED)]
    bench.clock.run_until(201)
    assert len(bench.events("listener")) == 2


def test_deadline_costs_one_pending_timer_however_many_samples_come() -> None:
    bench = Bench(DEADLINE, qos())
    bench.listen()
    for number in range(1000):
        bench.topic.publish("talker", number)
    assert len(bench.clock._queue._heap) == 1


def test_manual_publisher_that_falls_silent_loses_its_liveliness_once() -> None:
    bench = Bench(MANUAL, MANUAL)
    bench.listen()
    bench.topic.publish("talker", 1)
    bench.clock.run_until(500)
    assert bench.events("talker") == [(100.000001, LOST)]
    assert bench.events("listener") == [(0.0, CHANGED), (100.000001, CHANGED)]
    assert [event.detail for event in bench.network.events.log if event.kind is CHANGED] == [
        "1 alive, 0 not alive",
        "0 alive, 1 not alive",
    ]


def test_manual_publisher_is_kept_alive_by_assertions_without_samples() -> None:
    bench = Bench(MANUAL, MANUAL)
    bench.listen()
    for at_ms in (0, 80, 160):
        bench.clock.run_until(at_ms)
        bench.topic.assert_liveliness("talker")
    bench.clock.run_until(250)
    assert bench.events("talker") == []
    bench.clock.run_until(270)
    assert bench.events("talker") == [(260.000001, LOST)]


def test_manual_publisher_comes_alive_again_with_its_next_sample() -> None:
    bench = Bench(MANUAL, MANUAL)
    bench.listen()
    bench.publish_every(300, count=2)
    assert [event.detail for event in bench.network.events.log if event.kind is CHANGED][-1] == "1 alive, 0 not alive"


def test_automatic_publisher_is_alive_from_the_match_on_though_it_never_speaks() -> None:
    lease = qos(lease_duration_s=0.1)
    bench = Bench(lease, lease)
    bench.listen()
    bench.clock.run_until(1000)
    assert bench.events("talker") == []
    assert bench.events("listener") == [(0.0, CHANGED)]


def test_automatic_publisher_behind_a_cut_is_not_alive_after_its_lease() -> None:
    lease = qos(lease_duration_s=0.1)
    bench = Bench(lease, lease)
    bench.listen()
    bench.clock.run_until(50)
    bench.network.cut(["talker"])
    bench.clock.run_until(400)
    bench.network.undo_cuts()
    assert bench.events("listener") == [(0.0, CHANGED), (150.000001, CHANGED), (400.0, CHANGED)]
    assert bench.events("talker") == []  # its own process is well


def test_two_publishers_are_counted_apart() -> None:
    bench = Bench(MANUAL, MANUAL, talkers=("talker", "second"))
    bench.listen()
    bench.topic.publish("talker", 1)
    bench.clock.run_until(60)
    bench.topic.publish("second", 2)
    bench.clock.run_until(120)
    assert [event.detail for event in bench.network.events.log if event.kind is CHANGED] == [
        "1 alive, 0 not alive",
        "2 alive, 0 not alive",
        "1 alive, 1 not alive",
    ]


def test_events_become_one_line_for_each_endpoint_and_kind() -> None:
    bench = Bench(DEADLINE, DEADLINE)
    bench.listen()
    bench.topic.publish("talker", 1)
    bench.clock.run_until(250)
    assert bench.network.events.lines() == (
        "`/numbers` at `talker`: offered deadline missed, 2 x",
        "`/numbers` at `listener`: requested deadline missed, 2 x",
    )


def test_who_listens_hears_every_event() -> None:
    bench = Bench(DEADLINE, qos())
    heard: list[QosEventKind] = []
    bench.network.events.listen(lambda event: heard.append(event.kind))
    bench.topic.publish("talker", 1)
    bench.clock.run_until(150)
    assert heard == [OFFERED]


@pytest.mark.parametrize("period_ms", [10, 100])
def test_nothing_is_scheduled_where_no_profile_asks_for_it(period_ms: float) -> None:
    bench = Bench(qos(), qos())
    bench.listen()
    bench.publish_every(period_ms, count=5)
    assert bench.clock._queue.next_ns() is None


def test_middleware_without_the_rules_of_dds_connects_and_tells_nothing() -> None:
    # rmw_zenoh: any two endpoints on one key match, and neither deadlines nor leases give events.
    offered = qos(reliability="best_effort", deadline_s=0.2)
    bench = Bench(offered, qos(deadline_s=0.1, lease_duration_s=0.1), middleware=ZENOH)
    subscription = bench.subscribe()
    bench.topic.publish("talker", 1)
    bench.clock.run_until(1000)
    assert bench.topic.mismatches == []
    assert bench.drain(subscription) == [1]
    assert bench.network.events.log == []


class TestStreamDeadline:
    """Deadlines of streams that are looked at when a period is over."""

    def watch(self, stamps_ms: list[float], until_ms: float, period_s: float = 0.1) -> list[float]:
        """Return the milliseconds of the misses of a stream."""
        clock, missed = StepClock(), list[float]()

        def newest_ns(now_ns: int) -> int | None:
            seen = [at for at in stamps_ms if at * MS <= now_ns]
            return round(seen[-1] * MS) if seen else None

        StreamDeadline(period_s, clock, newest_ns, lambda: missed.append(clock.now_ns / MS))
        clock.run_until(until_ms)
        return missed

    def test_stream_in_time_misses_nothing(self) -> None:
        assert self.watch([10.0 * index for index in range(100)], until_ms=990) == []

    def test_stream_that_stops_misses_every_period(self) -> None:
        assert self.watch([0.0, 50.0], until_ms=360) == [150.000001, 250.000001, 350.000001]

    def test_gap_is_as_many_misses_as_periods_pass_in_it(self) -> None:
        assert self.watch([0.0, 90.0, 400.0, 480.0], until_ms=500) == [190.000001, 290.000001, 390.000001]

    def test_stream_of_one_sample_misses_from_that_sample_on(self) -> None:
        assert self.watch([95.0], until_ms=310) == [195.000001, 295.000001]

    def test_stream_that_never_began_misses_nothing(self) -> None:
        assert self.watch([], until_ms=1000) == []
