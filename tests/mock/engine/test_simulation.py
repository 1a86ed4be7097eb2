"""The clock: order of events, waits with a bound, and blocks that give what single events give."""

from __future__ import annotations

from functools import partial

import pytest

from cellc.mock import MockCell, to_json_lines
from cellc.mock.engine.control_stack import ControlStack
from cellc.mock.engine.process import EventQueue, Process, Signal, Wait, Waiting
from cellc.mock.engine.simulation import Simulation


@pytest.fixture
def simulation() -> Simulation:
    """A clock with no controller manager behind it."""
    return Simulation(ControlStack({}, {}, 1.0))


def test_events_of_one_instant_run_in_the_order_of_scheduling() -> None:
    queue = EventQueue()
    ran: list[str] = []
    for at_ns, name in ((20, "c"), (10, "a"), (20, "d"), (10, "b")):
        queue.at(at_ns, partial(ran.append, name))
    while (event := queue.pop_due(20)) is not None:
        event.run()
    assert ran == ["a", "b", "c", "d"]


def test_wait_ends_at_its_bound_when_nothing_is_signalled(simulation: Simulation) -> None:
    woken = []

    def body() -> Waiting[None]:
        yield Wait(500, (Signal(),))
        woken.append(simulation.now_ns)

    simulation.run_process(body())
    assert woken == [500]


def test_signal_wakes_before_the_bound_and_the_bound_does_not_wake_again(simulation: Simulation) -> None:
    signal, woken = Signal(), []
    simulation.at(100, lambda: signal.fire(simulation.now_ns))

    def body() -> Waiting[None]:
        yield Wait(500, (signal,))
        woken.append(simulation.now_ns)
        yield Wait(900)
        woken.append(simulation.now_ns)

    simulation.run_process(body())
    assert woken == [100, 900]


def test_loop_that_lets_no_time_pass_is_an_error_and_no_hang(simulation: Simulation) -> None:
    def body() -> Waiting[None]:
        while True:
            yield Wait(simulation.now_ns)

    with pytest.raises(RuntimeError, match="the clock does not advance at 0 ns"):
        simulation.run_process(body())


def test_background_event_is_seen_at_its_own_time_by_who_waits_for_it(simulation: Simulation) -> None:
    arrived, woken = Signal(from_background=True), []
    simulation.every(50, 1e9 / 100, lambda _: arrived.fire(simulation.now_ns))  # at 50, 150, 250 …

    def body() -> Waiting[None]:
        yield Wait(40)
        for _ in range(2):
            yield Wait(1000, (arrived,))
            woken.append(simulation.now_ns)

    simulation.run_process(body())
    assert woken == [50, 150]


def test_background_is_up_to_date_whenever_the_foreground_runs(simulation: Simulation) -> None:
    ticks: list[int] = []
    simulation.every(0, 1e9 / 100, lambda _: ticks.append(simulation.now_ns))

    def body() -> Waiting[None]:
        yield Wait(250)
        assert ticks == [0, 100, 200]
        yield Wait(300)
        assert ticks == [0, 100, 200, 300]

    simulation.run_process(body())


def test_rate_does_not_drift(simulation: Simulation) -> None:
    ticks: list[int] = []
    simulation.every(0, 30.0, lambda _: ticks.append(simulation.now_ns))

    def body() -> Waiting[None]:
        yield Wait(10_000_000_000)

    simulation.run_process(body())
    assert ticks[300] == 10_000_000_000  # the 300th period of 1/30 s ends after exactly 10 s


@pytest.mark.parametrize("rehearsal", ["pick_and_place", "stale_camera", "canceled"])
def test_long_blocks_give_the_same_records_as_a_stop_at_every_event(
    cell: MockCell, rehearsal: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    in_blocks = to_json_lines(cell.run(rehearsal).attempts)
    at_event = Simulation._next_ns

    def at_every_event(self: Simulation, process: Process) -> int:
        background_ns = self._background.next_ns()
        target_ns = at_event(self, process)
        return target_ns if background_ns is None else min(target_ns, background_ns)

    monkeypatch.setattr(Simulation, "_next_ns", at_every_event)
    assert to_json_lines(cell.run(rehearsal).attempts) == in_blocks
