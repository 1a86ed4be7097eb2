"""Readings of a clock, by hand: offset, drift that a discipline bounds, jumps, and a recording."""

from __future__ import annotations

import pytest

from cellc.contract.contract import ContractClock
from cellc.mock.clocks import Clock, Clocks, Segment, TimeJump, build_clocks, clock_from
from tests.properties import given, st

MS = 1_000_000
SECOND = 1_000_000_000


def clock(offset_s: float = 0.0, drift: float = 0.0, max_offset_s: float | None = None) -> Clock:
    return clock_from("pc", ContractClock(domain="ros", offset_s=offset_s, drift=drift, max_offset_s=max_offset_s))


def test_offset_is_added_to_every_reading() -> None:
    assert clock(offset_s=0.002).read(5 * SECOND) == 5 * SECOND + 2 * MS


def test_free_clock_drifts_on() -> None:
    # 20 ppm are 20 us in a second and 72 ms in an hour.
    assert clock(drift=20e-6).read(3600 * SECOND) == 3600 * SECOND + 72 * MS


@pytest.mark.parametrize(("drift", "sign"), [(20e-6, 1), (-20e-6, -1)])
def test_disciplined_clock_drifts_to_its_bound_and_stays_there(drift: float, sign: int) -> None:
    # 1 ms at 20 us a second is reached after 50 s.
    disciplined = clock(drift=drift, max_offset_s=0.001)
    assert disciplined.read(25 * SECOND) == 25 * SECOND + sign * MS // 2
    assert disciplined.read(50 * SECOND) == 50 * SECOND + sign * MS
    assert disciplined.read(500 * SECOND) == 500 * SECOND + sign * MS


def test_offset_beyond_the_bound_stays_as_it_is_stated() -> None:
    failed = clock(offset_s=0.005, drift=20e-6, max_offset_s=0.001)
    assert failed.read(100 * SECOND) == 100 * SECOND + 5 * MS


@pytest.mark.parametrize("delta_ns", [3 * SECOND, -3 * SECOND])
def test_jump_moves_readings_after_it_and_none_before(delta_ns: int) -> None:
    jumped = clock()
    jumped.jump(delta_ns, 10 * SECOND)
    assert jumped.read(10 * SECOND - 1) == 10 * SECOND - 1
    assert jumped.read(10 * SECOND) == 10 * SECOND + delta_ns
    assert jumped.read(20 * SECOND) == 20 * SECOND + delta_ns


def test_jump_before_the_drift_ends_moves_that_end_too() -> None:
    jumped = clock(drift=20e-6, max_offset_s=0.001)
    jumped.jump(SECOND, 10 * SECOND)
    assert jumped.read(100 * SECOND) == 101 * SECOND + MS


def test_jumps_add_up() -> None:
    jumped = clock()
    jumped.jump(2 * SECOND, 10 * SECOND)
    jumped.jump(-5 * SECOND, 11 * SECOND)
    assert jumped.read(10 * SECOND + 1) == 12 * SECOND + 1
    assert jumped.read(12 * SECOND) == 9 * SECOND


def test_reading_that_a_forward_jump_leaps_over_is_reached_at_the_jump() -> None:
    jumped = clock()
    jumped.jump(5 * SECOND, 10 * SECOND)
    assert jumped.when(12 * SECOND, since_ns=0) == 10 * SECOND


def test_reading_that_was_there_before_a_jump_back_comes_again() -> None:
    jumped = clock()
    jumped.jump(-5 * SECOND, 10 * SECOND)
    assert jumped.when(8 * SECOND, since_ns=0) == 8 * SECOND
    assert jumped.when(8 * SECOND, since_ns=10 * SECOND) == 13 * SECOND


@given(
    drift=st.floats(-500e-6, 500e-6),
    reading_ns=st.integers(0, 10**13),
    jumps=st.lists(st.tuples(st.integers(-(10**10), 10**10), st.integers(0, 10**12)), max_size=3),
)
def test_when_is_the_first_instant_of_a_reading(drift: float, reading_ns: int, jumps: list[tuple[int, int]]) -> None:
    moved = Clock("pc", "ros", (Segment(0, 0, 1.0 + drift),))
    for delta_ns, at_ns in sorted(jumps, key=lambda jump: jump[1]):
        moved.jump(delta_ns, at_ns)
    at_ns = moved.when(reading_ns, since_ns=0)
    assert moved.read(at_ns) >= reading_ns
    assert at_ns == 0 or moved.read(at_ns - 1) < reading_ns


class TestClocks:
    """The clocks of a cell with two hosts of one domain and a camera with its own."""

    @pytest.fixture
    def clocks(self) -> Clocks:
        named = {"left": "ros", "right": "ros", "camera": "camera"}
        made = {name: clock_from(name, ContractClock(domain=domain)) for name, domain in named.items()}
        return Clocks(made, {"driver": "left", "task": "right", "camera": "camera"}, lambda: 10 * SECOND)

    def test_age_is_measured_on_the_clock_of_the_consumer(self, clocks: Clocks) -> None:
        clocks.jump("right", 30 * MS)
        stamp_ns = clocks.of("driver").read(9 * SECOND)
        assert clocks.age_ns("task", stamp_ns) == SECOND + 30 * MS
        assert clocks.age_ns("driver", stamp_ns) == SECOND

    def test_stamp_is_stale_one_nanosecond_after_its_greatest_age(self, clocks: Clocks) -> None:
        clocks.jump("right", 30 * MS)
        assert clocks.stale_at_ns("task", 10 * SECOND, 100 * MS) == 10 * SECOND + 70 * MS + 1

    def test_domain_names_all_its_clocks(self, clocks: Clocks) -> None:
        clocks.jump("ros", -SECOND)
        assert [clocks.now_ns(node) for node in ("driver", "task", "camera", "nobody")] == [
            9 * SECOND,
            9 * SECOND,
            10 * SECOND,
            9 * SECOND,
        ]

    def test_clock_that_does_not_exist_cannot_jump(self, clocks: Clocks) -> None:
        with pytest.raises(KeyError, match="moon"):
            clocks.jump("moon", 1)

    def test_replay_puts_everybody_into_the_time_of_the_recording(self, clocks: Clocks) -> None:
        heard: list[TimeJump] = []
        clocks.listen(heard.append)
        clocks.replay(4 * SECOND, rate=2.0)
        for node in ("driver", "task", "camera"):
            assert clocks.of(node).read(10 * SECOND) == 4 * SECOND
            assert clocks.of(node).read(11 * SECOND) == 6 * SECOND
        assert all(jump.source_changed and jump.delta_ns == -6 * SECOND for jump in heard)
        clocks.replay(4 * SECOND)  # the recording is played again: the source stays, time goes back
        assert not heard[-1].source_changed


def test_cell_without_hosts_has_one_perfect_clock() -> None:
    clocks = build_clocks({}, {}, lambda: 7)
    assert clocks.names() == ("ros",)
    assert clocks.now_ns("anybody") == 7
