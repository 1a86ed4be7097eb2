"""Gripper action controllers: parallel_gripper_action_controller and the older gripper_controllers.

Success and stall are looked at in each update before the command is written. A goal that is replaced ends as canceled
immediately; a goal that runs while the controller is deactivated never gets a result.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from cellc.contract.frozen import dataclass
from cellc.mock.control.controllers.base import Context, Cycle, GoalMonitor, QuietController
from cellc.mock.control.interfaces import Block
from cellc.mock.control.journal import Cause
from cellc.mock.control.messages import GoalStatus, GripperEnded, GripperGoal
from cellc.mock.control.parameters import Parameter
from cellc.mock.control.parameters.declaration import at_least, not_empty


@dataclass(frozen=True, slots=True)
class GripperKind:
    """What tells the gripper controllers apart.

    Attributes:
        single_position: whether a goal must have exactly one position.
        max_effort: default of the parameter of that name (N).
    """

    single_position: bool
    max_effort: float


PARALLEL = GripperKind(True, 10.0)
POSITION = GripperKind(False, 0.0)


def _parameters(kind: GripperKind) -> tuple[Parameter, ...]:
    positive = (at_least(0.0),)
    joint = Parameter("joint", "string", None, (not_empty,), True) if kind.single_position else None
    return (
        Parameter("action_monitor_rate", "double", 20.0, (at_least(0.1),), True),
        joint or Parameter("joint", "string", ""),
        Parameter("state_interfaces", "string_array", ["position", "velocity"]),
        Parameter("goal_tolerance", "double", 0.01, positive),
        Parameter("allow_stalling", "bool", False),
        Parameter("stall_velocity_threshold", "double", 0.001),
        Parameter("stall_timeout", "double", 1.0, positive),
        Parameter("max_effort_interface", "string", ""),
        Parameter("max_effort", "double", kind.max_effort, positive),
        Parameter("max_velocity_interface", "string", ""),
        Parameter("max_velocity", "double", 0.1, positive),
    )


class GripperController(QuietController):
    """A gripper action controller.

    Args:
        context: what the manager gives.
        kind: which of the controllers it is.

    Raises:
        ParameterError: from the declaration of the parameters.
    """

    def __init__(self, context: Context, kind: GripperKind) -> None:
        super().__init__(context)
        context.parameters.declare(_parameters(kind))
        self._kind = kind
        self._goal: GoalMonitor | None = None
        self._waiting: list[GoalMonitor] = []
        self.active = False

    @property
    def releases_itself(self) -> bool:
        """Done by the controller."""
        return True

    def configure(self) -> None:
        """Read the parameters."""
        parameters = self.context.parameters
        self._joint = parameters.text("joint")
        self._monitor_ns = parameters.period_ns("action_monitor_rate")

    def command_interfaces(self) -> tuple[str, ...]:
        """The joint's command, and those of largest effort and velocity where they are configured."""
        return (f"{self._joint}/position", *self._extra().values())

    def _extra(self) -> dict[str, str]:
        parameters = self.context.parameters
        named = {kind: parameters.text(f"max_{kind}_interface") for kind in ("effort", "velocity")}
        return {kind: name for kind, name in named.items() if name}

    def state_interfaces(self) -> tuple[str, ...]:
        """Position and velocity of the joint."""
        return tuple(f"{self._joint}/{kind}" for kind in self.context.parameters.texts("state_interfaces"))

    def activate(self, now_ns: int) -> None:
        """Hold the measured position."""
        table, parameters = self.context.table, self.context.parameters
        self._column = table.command_column(f"{self._joint}/position")
        self._position_column = table.state_column(f"{self._joint}/position")
        self._velocity_column = table.state_column(f"{self._joint}/velocity")
        self._extra_columns = {kind: table.command_column(name) for kind, name in self._extra().items()}
        self._hold(now_ns)
        self._limits = {kind: parameters.number(f"max_{kind}") for kind in ("effort", "velocity")}
        self._goal, self._waiting = None, []
        self._moved_ns = now_ns
        self.active = True

    def deactivate(self, now_ns: int) -> None:
        """Leave a goal without a result."""
        self._goal, self._waiting = None, []
        self.active = False

    # -- goals -------------------------------------------------------------------------------------------------------

    def refusal(self, goal: GripperGoal) -> str:
        """Why a goal is refused, empty where it is accepted."""
        if self._kind.single_position and len(goal.position) != 1:
            return f"Received action goal with wrong number of position values, expects 1, got {len(goal.position)}"
        return ""

    def accept(self, goal_id: int, goal: GripperGoal, now_ns: int) -> None:
        """Make a goal the running one; one that runs ends canceled immediately."""
        if self._goal is not None:
            self.context.events.append(self._ended(self._goal.goal_id, now_ns, now_ns, GoalStatus.CANCELED))
        self._position = goal.position[0]
        parameters = self.context.parameters
        for kind, given in (("effort", goal.effort), ("velocity", goal.velocity)):
            usable = given and kind in self._extra_columns
            self._limits[kind] = given[0] if usable else parameters.number(f"max_{kind}")
        self._moved_ns = now_ns
        self._goal = GoalMonitor(goal_id, now_ns, self._monitor_ns, listened=False)

    @property
    def running_id(self) -> int:
        """Number of the running goal, 0 for none."""
        return 0 if self._goal is None else self._goal.goal_id

    def cancel(self, now_ns: int) -> None:
        """Cancel the running goal and hold the measured position."""
        self._hold(now_ns)
        assert self._goal is not None, "only a running goal is canceled"
        goal_id = self._goal.goal_id
        self._decide(now_ns, lambda stamp_ns: self._ended(goal_id, stamp_ns, now_ns, GoalStatus.CANCELED))

    def _hold(self, now_ns: int) -> None:
        """Command the measured position from the next update on."""
        table = self.context.table
        self._position = float(table.state[self._position_column])
        table.journal.note(now_ns + 1, self.context.name, Cause.HOLD)

    def is_waiting(self, goal_id: int) -> bool:
        """Whether a goal is decided and its result not delivered yet."""
        return any(monitor.goal_id == goal_id for monitor in self._waiting)

    def _decide(self, now_ns: int, result: Callable[[int], GripperEnded]) -> None:
        monitor = self._goal
        assert monitor is not None, "only a running goal is decided"
        monitor.decide(now_ns, result)
        self._waiting.append(monitor)
        self._goal = None

    def _ended(self, goal_id: int, stamp_ns: int, decided_ns: int, status: GoalStatus) -> GripperEnded:
        return GripperEnded(stamp_ns, decided_ns, self.context.name, goal_id, status, (), (), False, False)

    def _finish(self, now_ns: int, position: float, stalled: bool) -> None:
        allowed = self.context.parameters.flag("allow_stalling")
        status = GoalStatus.SUCCEEDED if not stalled or allowed else GoalStatus.ABORTED
        name, goal_id = self.context.name, self.running_id
        self._decide(
            now_ns,
            lambda stamp_ns: GripperEnded(
                stamp_ns, now_ns, name, goal_id, status, (position,), (0.0,), stalled, not stalled
            ),
        )

    # -- cycles ------------------------------------------------------------------------------------------------------

    def update(self, cycle: Cycle) -> None:
        """Look for success or stall, then command."""
        state = self.context.table.state
        position = float(state[self._position_column])
        if self._goal is not None:
            self._check(cycle.time_ns, position, float(state[self._velocity_column]))
        self.context.command(self._column, self._position)
        for kind, column in self._extra_columns.items():
            self.context.command(column, self._limits[kind])

    def _check(self, now_ns: int, position: float, velocity: float) -> None:
        parameters = self.context.parameters
        if abs(self._position - position) < parameters.number("goal_tolerance"):
            self._finish(now_ns, position, stalled=False)
        elif abs(velocity) > parameters.number("stall_velocity_threshold"):
            self._moved_ns = now_ns
        elif (now_ns - self._moved_ns) / 1e9 > parameters.number("stall_timeout"):
            self._finish(now_ns, position, stalled=True)

    def preview(self, block: Block) -> int:
        """The command stays the same in all cycles."""
        block.command[:, self._column] = self._position
        for kind, column in self._extra_columns.items():
            block.command[:, column] = self._limits[kind]
        return len(block)

    def regular(self, block: Block) -> int:
        """Cycles before success or stall."""
        if self._goal is None:
            return len(block)
        parameters = self.context.parameters
        reached = np.abs(self._position - block.state[:, self._position_column]) < parameters.number("goal_tolerance")
        still = (block.times_ns - self._moved_before(block)) / 1e9 > parameters.number("stall_timeout")
        decided = reached | (still & ~self._moving(block))
        index = int(decided.argmax())
        return index if decided[index] else len(block)

    def _moving(self, block: Block) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        threshold = self.context.parameters.number("stall_velocity_threshold")
        return np.abs(block.state[:, self._velocity_column]) > threshold

    def _moved_before(self, block: Block) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
        """For each cycle the time of the last movement up to it."""
        moved = np.where(self._moving(block), block.times_ns, self._moved_ns)
        return np.maximum.accumulate(moved)

    def commit(self, block: Block, start: int) -> None:
        """Remember the last movement."""
        if self._goal is not None:
            self._moved_ns = int(self._moved_before(block)[-1])

    def next_monitor_ns(self) -> int | None:
        """The next tick on which a result is pending."""
        due = [time for monitor in self._waiting if (time := monitor.next_ns()) is not None]
        return min(due, default=None)

    def monitor(self, now_ns: int) -> None:
        """Deliver results."""
        for monitor in [m for m in self._waiting if m.next_ns() == now_ns]:
            event = monitor.tick(now_ns)
            self._waiting.remove(monitor)
            if event is not None:
                self.context.events.append(event)
