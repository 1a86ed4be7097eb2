"""What the controller manager asks of a controller, with defaults, and the monitor that delivers results of goals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

from cellc.contract.errors import ReasonError
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import Distro
from cellc.mock.control.hardware import CommandLimiter
from cellc.mock.control.interfaces import Block, InterfaceTable
from cellc.mock.control.log import Log
from cellc.mock.control.messages import ControlEvent
from cellc.mock.control.parameters import ParameterSet, ParameterValue
from cellc.mock.control.robot_description import RobotDescription


@dataclass(frozen=True, slots=True)
class Cycle:
    """One update of one controller; `period_ns` is the time since its last one."""

    time_ns: int
    period_ns: int


@dataclass(frozen=True, slots=True)
class DeclaredInterfaces:
    """Full names of what a vendor's passive controller claims and reads: they stand in its code alone."""

    command: tuple[str, ...] = ()
    state: tuple[str, ...] = ()


@dataclass(slots=True)
class Context:
    """What a controller node is given by the manager.

    Attributes:
        name: name of the controller.
        parameters: its parameters.
        distro: ROS distribution.
        period_ns: period of the manager.
        update_rate: rate of the controller, filled in when it is configured (Hz).
        description: the robot description.
        table: the interfaces.
        limiter: limits commands as they are set; None where limits are not enforced.
        log: the log.
        events: where events for the outside are put.
        declared: what a controller takes of which nothing else tells it.
    """

    name: str
    parameters: ParameterSet
    distro: Distro
    period_ns: int
    update_rate: int
    description: RobotDescription
    table: InterfaceTable
    limiter: CommandLimiter | None
    log: Log
    events: list[ControlEvent]
    declared: DeclaredInterfaces = DeclaredInterfaces()

    def command(self, column: int, value: float) -> None:
        """Set a command interface, limited where limits are enforced."""
        self.table.command[column] = value if self.limiter is None else self.limiter.limit(column, value)


class ConfigureError(ReasonError):
    """A transition of a controller failed.

    Args:
        reason: what the controller logs.
    """


class Controller(Protocol):
    """A controller between its transitions.

    The manager runs it either cycle by cycle (`update`) or in blocks: `preview` writes the commands of coming cycles
    as they will be if nothing happens, `regular` tells how many of them nothing happened in, `commit` adopts those.
    Both methods must agree bit by bit, so `preview` and `update` share their arithmetic.
    """

    @property
    def releases_itself(self) -> bool:
        """Whether it releases its interfaces in its own deactivation, not only when the manager does it."""

    def configure(self) -> None:
        """Read and check parameters. Raises ConfigureError or ParameterError."""

    def command_interfaces(self) -> tuple[str, ...]:
        """Command interfaces that it claims while active."""

    def state_interfaces(self) -> tuple[str, ...]:
        """State interfaces that it needs."""

    def reference_interfaces(self) -> tuple[str, ...]:
        """Command interfaces that it offers to a preceding controller, with its own name in front."""

    def activation_error(self) -> str:
        """Why `on_activate` would return an error now, which leaves the controller unconfigured; empty otherwise."""

    def activate(self, now_ns: int) -> None:
        """Start, with interfaces claimed."""

    def deactivate(self, now_ns: int) -> None:
        """Stop; interfaces are released afterwards."""

    def update(self, cycle: Cycle) -> None:
        """Do one cycle. Raises UpdateError."""

    @property
    def decides_next(self) -> bool:
        """Whether its next update is known to be part of no block."""

    def expected_updates(self) -> int | None:
        """Number of updates up to the next one that is likely to decide something; None without one, or unknown."""

    def preview(self, block: Block) -> int:
        """Write the commands of a block of this controller's cycles; return how many leading cycles are regular."""

    def regular(self, block: Block) -> int:
        """Tell, with the states known, how many leading cycles of the previewed block are regular."""

    def commit(self, block: Block, start: int) -> None:
        """Adopt the cycles of the previewed block from `start` on, all of them regular; those before were adopted."""

    def next_monitor_ns(self) -> int | None:
        """The time at which it has to tell the outside something, None for never."""

    def monitor(self, now_ns: int) -> None:
        """Tell the outside what is pending."""

    def parameter_changed(self, name: str, value: ParameterValue) -> None:
        """React to a parameter that was set at run time."""


class QuietController:
    """Defaults of controllers that have nothing of the kind.

    Args:
        context: what the manager gives.
    """

    def __init__(self, context: Context) -> None:
        self.context = context

    @property
    def releases_itself(self) -> bool:
        """Left to the manager."""
        return False

    def command_interfaces(self) -> tuple[str, ...]:
        """No command interface."""
        return ()

    def state_interfaces(self) -> tuple[str, ...]:
        """No state interface."""
        return ()

    def reference_interfaces(self) -> tuple[str, ...]:
        """Not chainable."""
        return ()

    def activation_error(self) -> str:
        """Never an error."""
        return ""

    def configure(self) -> None:
        """Nothing to configure."""

    def activate(self, now_ns: int) -> None:
        """Nothing to start."""

    def deactivate(self, now_ns: int) -> None:
        """Nothing to stop."""

    def update(self, cycle: Cycle) -> None:
        """Nothing to command."""

    @property
    def decides_next(self) -> bool:
        """Never."""
        return False

    def expected_updates(self) -> int | None:
        """None: it decides nothing."""
        return None

    def preview(self, block: Block) -> int:
        """Command nothing in any cycle."""
        return len(block)

    def regular(self, block: Block) -> int:
        """Nothing happens in any cycle."""
        return len(block)

    def commit(self, block: Block, start: int) -> None:
        """Nothing to adopt."""

    def next_monitor_ns(self) -> int | None:
        """Never."""
        return None

    def monitor(self, now_ns: int) -> None:
        """Nothing is pending."""

    def parameter_changed(self, name: str, value: ParameterValue) -> None:
        """No parameter is looked at again."""


def claimed_names(joints: Sequence[str], kinds: Sequence[str]) -> tuple[str, ...]:
    """Full interface names of several kinds, joint by joint."""
    return tuple(f"{joint}/{kind}" for joint in joints for kind in kinds)


class GoalMonitor:
    """Delivers the result of one goal, and its feedback to a listener.

    Args:
        goal_id: number of the goal.
        accepted_ns: when the goal was accepted, from which the timer runs.
        period_ns: period of the timer.
        listened: whether somebody listens to feedback.
    """

    def __init__(self, goal_id: int, accepted_ns: int, period_ns: int, listened: bool) -> None:
        self.goal_id = goal_id
        self.listened = listened
        self.accepted_ns = accepted_ns
        self._period_ns = period_ns
        self._last_tick_ns = accepted_ns
        self._result: Callable[[int], ControlEvent] | None = None
        self._decided_ns = 0
        self.canceling = False

    @property
    def decided(self) -> bool:
        """Whether the result is known and waits for delivery."""
        return self._result is not None

    def decide(self, now_ns: int, result: Callable[[int], ControlEvent]) -> None:
        """Note the result; `result` makes the event for the time of delivery."""
        self._result = result
        self._decided_ns = now_ns

    def next_ns(self) -> int | None:
        """The next tick on which there is something to deliver."""
        if self._result is None and not self.listened:
            return None
        earliest = max(self._decided_ns if self._result is not None else 0, self._last_tick_ns + 1)
        ticks = -((self.accepted_ns - earliest) // self._period_ns)
        return self.accepted_ns + max(ticks, 1) * self._period_ns

    def tick(self, now_ns: int) -> ControlEvent | None:
        """Take the result if it is known."""
        self._last_tick_ns = now_ns
        return None if self._result is None else self._result(now_ns)
