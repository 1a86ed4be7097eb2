"""How soon the watchdogs of a cell end an attempt, put together from what its contract states."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.contract.contract import Contract
from cellc.mock.faults.cell_steps import CellStep
from cellc.mock.nodes.motion_planner import PLANNING_LATENCY_S
from cellc.mock.nodes.observations import DEFAULT_MAX_AGE_S as DEFAULT_OBSERVATION_AGE_S
from cellc.mock.task.bounds import action_timeout_s, cancel_bound_s, joint_state_age_s
from cellc.mock.task.context import WATCH_S
from cellc.mock.task.grip import GRIP_TIMEOUT_S
from cellc.mock.task.move import TF_TIMEOUT_S
from cellc.mock.task.task import DEFAULT_RATE_HZ, PATIENCE_PERIODS

POSE_TYPE = "geometry_msgs/msg/PoseStamped"
MONITOR_S = 0.05
"""Result of an action at the default `action_monitor_rate` of 20 Hz: so much later than it was decided."""
SETTLE_S = 0.02
"""A few update cycles: until a request to a controller manager is carried out and its event has come back."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """Bounds of one cell, each from the effect of a fault to the end of the step that meets it."""

    contract: Contract

    def hold_s(self) -> float:
        """Return the bound of what the control stack reports: the attempt ends at once and its joints are held."""
        return SETTLE_S + MONITOR_S + cancel_bound_s(self.contract)

    def watched_s(self) -> float:
        """Return the bound of what the task has to look for itself."""
        return WATCH_S + self.hold_s()

    def asked_s(self) -> float:
        """Return the bound of a refusal: planning, its transforms, and the answer to a goal."""
        return TF_TIMEOUT_S + PLANNING_LATENCY_S + self.hold_s()

    def joint_state_s(self) -> float:
        """Return the bound of joint states that stay away."""
        return joint_state_age_s(self.contract) + PLANNING_LATENCY_S + self.watched_s()

    def observation_s(self, frame: str) -> float:
        """Return the bound of observations that stay away while somebody waits for them or acts on one."""
        period_s = 1.0 / (self.contract.frames[frame].rate_hz or DEFAULT_RATE_HZ)
        return max(PATIENCE_PERIODS * period_s, self.observation_age_s(frame)) + period_s + self.watched_s()

    def execution_s(self, step: CellStep) -> float | None:
        """Return the bound of a goal that makes no progress; None where no action of the contract states one."""
        timeout_s = GRIP_TIMEOUT_S if step.kind == "grip" else action_timeout_s(self.contract)
        return None if timeout_s is None else timeout_s * max(1, len(step.controllers)) + self.asked_s()

    def dynamic_frames(self) -> tuple[str, ...]:
        """Return the frames that somebody has to observe."""
        return tuple(name for name, frame in self.contract.frames.items() if frame.kind == "dynamic")

    def observation_age_s(self, frame: str) -> float:
        """Return how old an observation may be."""
        stated = [
            interface.max_age_s
            for interface in self.contract.interfaces.values()
            if interface.type == POSE_TYPE and interface.frame == self.contract.frames[frame].parent
        ]
        return max((age for age in stated if age is not None), default=DEFAULT_OBSERVATION_AGE_S)
