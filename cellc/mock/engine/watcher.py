"""What an onlooker of the control stack is told; it may listen, and must not change anything."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from cellc.mock.control import GoalResponse, GripperGoal, JointStateBlock, TrajectoryGoal


@dataclass(frozen=True, slots=True)
class GoalSent:
    """A goal that was sent to the action of a controller, and the answer."""

    stamp_ns: int
    controller: str
    goal: TrajectoryGoal | GripperGoal
    response: GoalResponse


class ControlWatcher(Protocol):
    """Listens to the control stack of one run."""

    def configured(self) -> None:
        """Take note that all controllers are configured and none has published anything."""
        ...

    def joint_states(self, manager: str, controller: str, block: JointStateBlock) -> None:
        """Take joint states that a broadcaster of a manager published."""
        ...

    def goal_sent(self, sent: GoalSent) -> None:
        """Take note of a goal."""
        ...
