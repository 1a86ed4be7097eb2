"""Joint states that arrive late, or not at all."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from cellc.mock.plant import Plant
from cellc.mock.world.joint_states import JointStateHistory, LateArrival

NEVER_NS = 10**15
"""Later than any rehearsal ends."""


def of_broadcasters(plant: Plant, names: Collection[str]) -> list[JointStateHistory]:
    """Return what some broadcasters publish."""
    return [history for (_, name), history in plant.control.histories.items() if name in names]


def of_joints(plant: Plant, joints: Collection[str]) -> list[JointStateHistory]:
    """Return what the broadcasters publish that report one of the joints."""
    histories = plant.control.histories.values()
    return [history for history in histories if any(joint in history.names for joint in joints)]


def delay(history: JointStateHistory, now_ns: int, delay_ns: int = NEVER_NS) -> None:
    """Let what is stamped from now on arrive late."""
    history.late.append(LateArrival(now_ns, None, delay_ns))


def catch_up(history: JointStateHistory, now_ns: int, delay_ns: int = NEVER_NS) -> None:
    """Let what is stamped from now on arrive without a delay that began before."""
    for index, late in enumerate(history.late):
        if late.until_ns is None and late.delay_ns == delay_ns:
            history.late[index] = replace(late, until_ns=now_ns)
            return
