"""How long the task may sleep while nothing can go wrong unseen.

A watchdog that wakes five times a second divides what the control stack computes in one step into small pieces. As long
as no fault has started, joint states come in every update cycle and no clock drifts, whatever the task looks at changes
by an event of the control stack or of the foreground alone, and each of these ends its wait: looking in between is
useless. A wait then ends at the instant of the same raster at which the task would have seen what comes
first, so that nothing is seen earlier or later than by looking all the time. Evidence is written in pieces that these
looks part: the task looks as ever where it is kept.

An observation that a motion rests on may turn stale without an event. Where no fault can begin the task trusts that it
does not, and asks afterwards; a run in which it did is made again, with every look.

11 s of a six-joint arm took 78 looks; with this they take 20, and with blocks as long as the wait half the processor
time.
"""

from __future__ import annotations

from cellc.mock.nodes.robot_state_publisher import JointStateFeed
from cellc.mock.plant import Plant
from cellc.mock.task.bounds import joint_state_age_s

WATCH_S = 0.2
"""The task looks at the state of the cell at least five times a second, whatever it waits for."""
WATCH_NS = round(WATCH_S * 1e9)
CALM_NS = 2_000_000_000
"""The longest sleep: histories and buffers keep ten seconds, and who reads them must come before they are full."""


def next_look_ns(plant: Plant, *, disturbed: bool) -> int:
    """Return when the task must look at the state of the cell again.

    Args:
        disturbed: a fault has started.
    """
    now_ns = plant.now_ns
    if disturbed or plant.control.is_watched or not is_undisturbed(plant):
        return now_ns + WATCH_NS
    event_ns = plant.simulation.next_foreground_ns()
    until_ns = now_ns + CALM_NS if event_ns is None else min(now_ns + CALM_NS, event_ns)
    return now_ns + max(1, -(-(until_ns - now_ns) // WATCH_NS)) * WATCH_NS


def is_undisturbed(plant: Plant) -> bool:
    """Tell whether the joint states that the task relies on can neither stay away nor turn old without an event."""
    if not plant.clocks.steady or not plant.task.feeds:
        return False
    if not all(history.unbroken for history in plant.control.histories.values()):
        return False
    allowed_ns = round(joint_state_age_s(plant.contract) * 1e9)
    return all(feed.undelayed and _oldest_ns(plant, feed) < allowed_ns for feed in plant.task.feeds)


def _oldest_ns(plant: Plant, feed: JointStateFeed) -> int:
    """Return how far from the task's clock a joint state that comes in every cycle is stamped at most."""
    clocks, now_ns = plant.clocks, plant.now_ns
    offset_ns = clocks.of(plant.task.name).read(now_ns) - clocks.of(feed.history.broadcaster).read(now_ns)
    return abs(offset_ns) + 2 * feed.history.period_ns
