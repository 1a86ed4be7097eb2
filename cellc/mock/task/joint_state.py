"""The joint state that a plan starts from, with its age checked."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.mock.plant import Plant
from cellc.mock.task.outcome import AttemptError, Outcome
from cellc.mock.world.joint_states import JOINT_STATE_TYPE

DEFAULT_MAX_AGE_S = 0.1
"""Where no interface states how old a joint state may be."""


@dataclass(frozen=True, slots=True)
class CurrentState:
    """Positions of all joints as the task knows them; the stamp is the oldest of those that were put together."""

    stamp_ns: int
    age_s: float
    positions: dict[str, float]


def current_state(plant: Plant) -> CurrentState:
    """Return the newest joint state that has arrived.

    Raises:
        AttemptError: stale_state, where none has arrived or it is older than its interface allows.
    """
    stamps: list[int] = []
    positions: dict[str, float] = {}
    for history in plant.heard_histories:
        arrived = history.arrived(plant.now_ns)
        if arrived == 0:
            raise AttemptError(Outcome.STALE_STATE, "no joint state has arrived")
        stamps.append(int(history.stamps[arrived - 1]))
        positions |= dict(zip(history.names, history.positions[arrived - 1].tolist(), strict=True))
    if not stamps:
        raise AttemptError(Outcome.STALE_STATE, "no joint states reach the task")
    age_s = (plant.now_ns - min(stamps)) / 1e9
    allowed_s = _max_age_s(plant)
    if age_s > allowed_s:
        raise AttemptError(Outcome.STALE_STATE, f"joint state is {age_s:.3f} s old, {allowed_s:g} s allowed")
    return CurrentState(min(stamps), age_s, positions)


def _max_age_s(plant: Plant) -> float:
    stated = [
        interface.max_age_s
        for interface in plant.contract.interfaces.values()
        if interface.type == JOINT_STATE_TYPE and interface.max_age_s is not None
    ]
    return min(stated) if stated else DEFAULT_MAX_AGE_S
