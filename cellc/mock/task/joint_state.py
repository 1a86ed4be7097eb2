"""The joint state that a plan starts from, with its age checked."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.mock.plant import Plant
from cellc.mock.task.bounds import joint_state_age_s
from cellc.mock.task.outcome import AttemptError, Outcome


@dataclass(frozen=True, slots=True)
class CurrentState:
    """Positions of all joints as the task knows them; the stamp is the oldest of those that were put together.

    Attributes:
        stamp_ns: on the clock of the broadcaster.
        taken_ns: the same in simulated time.
        age_s: on the clock of the task.
    """

    stamp_ns: int
    taken_ns: int
    age_s: float
    positions: dict[str, float]


def current_state(plant: Plant) -> CurrentState:
    """Return the newest joint state that has arrived.

    Raises:
        AttemptError: stale_state, where none has arrived, it is older than its interface allows, or it is stamped as
            far in the future: a clock was set back.
    """
    stamps: list[tuple[int, int]] = []
    positions: dict[str, float] = {}
    for feed in plant.feeds:
        history, newest = feed.history, feed.newest(plant.now_ns)
        if newest is None:
            raise AttemptError(Outcome.STALE_STATE, "no joint state has arrived")
        taken_ns = int(history.stamps[newest])
        stamps.append((plant.clocks.of(history.broadcaster).read(taken_ns), taken_ns))
        positions |= dict(zip(history.names, history.positions[newest].tolist(), strict=True))
    if not stamps:
        raise AttemptError(Outcome.STALE_STATE, "no joint states reach the task")
    stamp_ns, taken_ns = min(stamps)
    age_s = plant.clocks.age_ns(plant.task, stamp_ns) / 1e9
    allowed_s = joint_state_age_s(plant.contract)
    if age_s > allowed_s:
        raise AttemptError(Outcome.STALE_STATE, f"joint state is {age_s:.3f} s old, {allowed_s:g} s allowed")
    if age_s < -allowed_s:
        raise AttemptError(Outcome.STALE_STATE, f"joint state is stamped {-age_s:.3f} s in the future")
    return CurrentState(stamp_ns, taken_ns, age_s, positions)
