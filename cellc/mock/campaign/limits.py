"""Whether commands stayed within the limits of the contract: position, velocity, acceleration and jerk.

Commands are sampled once an update. Divided differences of samples x of a smooth motion are weighted means of its
derivatives over the span of the samples (mean value theorem, weights are B-splines). For any spacing, the first lies
within the bounds of the velocity, twice the second within those of the acceleration, six times the third within those
of the jerk. Sampling therefore needs no tolerance; only rounding does. A sample is wrong by a few units in its last
place, 2^-53 |x| each. A difference of order n over steps of h seconds turns an error e into at most 2^n e / h^n: with
16 units, at 2 ms and 6.3 rad, 2e-5 rad/s^3, far below any jerk limit.

A hold sets the command to the measured position immediately, in the mock as in the real controller, so the command
steps; so does every other interruption that the controller records. At these points only the position is compared with
its limit, and the size of the step is reported. A hold requests no motion: where the measured position itself lies
outside the limits, as that of a displaced joint may, the hold does not count as an excess. Nor does a trajectory that
starts from such a position, up to its first point.

Controllers that send positions instead of trajectories, those of grippers, leave speed to their device: only their
positions are checked.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from cellc.contract.contract import Contract, ContractJointLimits
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import TRAJECTORIES
from cellc.mock.control.journal import Cause, CommandSamples, Interruption

QUANTITIES = ("position", "velocity", "acceleration", "jerk")
_ROUNDING = 16 * 2.0**-53
_RELATIVE = 1e-9
"""Of the limit itself, which the planner compares in floating point too."""


@dataclass(frozen=True, slots=True)
class LimitExcess:
    """A command beyond a limit of the contract; rad or m and their derivatives by seconds."""

    controller: str
    joint: str
    quantity: str
    stamp_ns: int
    value: float
    limit: float

    def __str__(self) -> str:
        return (
            f"`{self.controller}` commanded joint `{self.joint}` to {self.quantity} {self.value:.6g} at "
            f"{self.stamp_ns / 1e9:.3f} s; its limit is {self.limit:.6g}"
        )


@dataclass(frozen=True, slots=True)
class CommandStep:
    """How far a command jumped where its controller was interrupted, rad or m."""

    controller: str
    joint: str
    cause: str
    stamp_ns: int
    step: float


@dataclass(frozen=True, slots=True)
class Peak:
    """The largest share of its limit that a quantity reached; 1 is the limit."""

    quantity: str
    share: float


@dataclass(frozen=True, slots=True)
class LimitsReport:
    """Limits of one run or of many.

    Attributes:
        peaks: by quantity, position left out.
        excesses: the worst of each controller and quantity of each run.
        steps: at interruptions, that of the joint which stepped farthest.
        held_outside: holds and starts of a position that was measured outside the limits, as a displaced joint's is.
        unchecked: interfaces or quantities of joints that commands say nothing of.
    """

    peaks: tuple[Peak, ...] = ()
    excesses: tuple[LimitExcess, ...] = ()
    steps: tuple[CommandStep, ...] = ()
    held_outside: tuple[LimitExcess, ...] = ()
    unchecked: tuple[str, ...] = ()

    @property
    def held(self) -> bool:
        """Tell whether no limit was exceeded."""
        return not self.excesses


def merge(reports: Iterable[LimitsReport]) -> LimitsReport:
    """Return what several reports say together."""
    known = tuple(reports)
    shares: dict[str, float] = {}
    for peak in (peak for report in known for peak in report.peaks):
        shares[peak.quantity] = max(shares.get(peak.quantity, 0.0), peak.share)
    return LimitsReport(
        peaks=tuple(Peak(quantity, share) for quantity, share in shares.items()),
        excesses=tuple(excess for report in known for excess in report.excesses),
        steps=tuple(step for report in known for step in report.steps),
        held_outside=tuple(held for report in known for held in report.held_outside),
        unchecked=tuple(sorted({name for report in known for name in report.unchecked})),
    )


Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


def check_limits(
    contract: Contract, samples: Sequence[CommandSamples], interruptions: Sequence[Interruption]
) -> LimitsReport:
    """Compare everything that controllers commanded in one run with the limits of the contract."""
    return merge(_of_controller(contract, each, interruptions) for each in samples)


def _of_controller(contract: Contract, samples: CommandSamples, interruptions: Sequence[Interruption]) -> LimitsReport:
    other = tuple(name for name in samples.interfaces if not name.endswith("/position"))
    columns = [
        (column, joint, contract.joint_limits[joint])
        for column, name in enumerate(samples.interfaces)
        if name.endswith("/position") and (joint := name.removesuffix("/position")) in contract.joint_limits
    ]
    if not columns:
        return LimitsReport(unchecked=other)
    holds = [each for each in interruptions if each.controller == samples.controller]
    trajectories = _sends_trajectories(contract, samples.controller)
    quantities = QUANTITIES if trajectories else QUANTITIES[:1]
    joints = tuple(joint for _, joint, _ in columns)
    limits = tuple(limit for _, _, limit in columns)
    positions = samples.values[:, [column for column, _, _ in columns]]
    commands = _Commands(samples.controller, joints, limits, samples.stamps_ns, positions)
    compared = [_Compared(commands, order, holds) for order in range(len(quantities))]
    unchecked = (*other, *(f"{joint}/{quantity}" for joint in joints for quantity in QUANTITIES[len(quantities) :]))
    return LimitsReport(
        peaks=tuple(each.peak() for each in compared[1:]),
        excesses=tuple(excess for each in compared if (excess := each.worst()) is not None),
        steps=tuple(_steps(commands, holds)) if trajectories else (),
        held_outside=() if (held := _held_outside(commands, holds)) is None else (held,),
        unchecked=unchecked,
    )


def _sends_trajectories(contract: Contract, controller: str) -> bool:
    if controller in contract.adapters:
        return True
    entries = (manager.controllers.get(controller) for manager in contract.managers.values())
    return any(entry is not None and entry.behavior in TRAJECTORIES for entry in entries)


@dataclass(frozen=True, slots=True)
class _Commands:
    """Commanded positions of the joints of one controller, shape (updates, joints)."""

    controller: str
    joints: tuple[str, ...]
    limits: tuple[ContractJointLimits, ...]
    stamps_ns: NDArray[np.int64]
    positions: Array

    def limit(self, order: int, joint: int, value: float) -> float:
        """Return the limit of a derivative of this order; of the position, the bound that ``value`` is beyond."""
        limit = self.limits[joint]
        if order:
            return (limit.velocity, limit.acceleration, limit.jerk)[order - 1]
        upper = math.inf if limit.upper is None else limit.upper
        return upper if value > upper or limit.lower is None else limit.lower


class _Compared:
    """One quantity of all joints with its share of the limit; row i belongs to the samples i to i + order."""

    def __init__(self, commands: _Commands, order: int, interruptions: Sequence[Interruption]) -> None:
        """Compare; rounding is allowed for beforehand, so that a share of more than 1 is an excess."""
        self._commands = commands
        self._order = order
        self._values = _derivative(commands.positions, commands.stamps_ns, order)
        if order == 0:
            self._shares = np.where(_outside(commands) & ~_held(commands, interruptions), 2.0, 0.0)
            return
        self._shares = np.nan_to_num(np.abs(self._values) / self._allowed())
        for interruption in interruptions:
            begin, end = np.searchsorted(commands.stamps_ns, (interruption.stamp_ns, interruption.until_ns))
            self._shares[max(0, int(begin) - order) : int(end)] = 0.0

    def _allowed(self) -> Array:
        commands, order = self._commands, self._order
        limits = np.array([commands.limit(order, joint, 0.0) for joint in range(len(commands.joints))])
        largest = max(1.0, float(np.nanmax(np.abs(commands.positions), initial=0.0)))
        shortest_s = float(np.diff(commands.stamps_ns).min(initial=1_000_000_000)) / 1e9
        return limits * (1.0 + _RELATIVE) + 2.0**order * _ROUNDING * largest / shortest_s**order

    def peak(self) -> Peak:
        """Return the largest share of a limit."""
        return Peak(QUANTITIES[self._order], float(self._shares.max(initial=0.0)))

    def worst(self) -> LimitExcess | None:
        """Return the worst excess; None where no limit is exceeded."""
        if not self._shares.max(initial=0.0) > 1.0:
            return None
        commands = self._commands
        row, joint = divmod(int(self._shares.argmax()), len(commands.joints))
        stamp_ns = int(commands.stamps_ns[row + self._order])
        return _excess(commands, self._order, joint, stamp_ns, float(self._values[row, joint]))


def _derivative(positions: Array, stamps_ns: NDArray[np.int64], order: int) -> Array:
    """Return order! times the divided differences of this order."""
    values = positions
    for n in range(1, order + 1):
        spans_s = (stamps_ns[n:] - stamps_ns[:-n]) / 1e9
        values = n * np.diff(values, axis=0) / spans_s[:, None]
    return values


def _excess(commands: _Commands, order: int, joint: int, stamp_ns: int, value: float) -> LimitExcess:
    limit = commands.limit(order, joint, value)
    return LimitExcess(commands.controller, commands.joints[joint], QUANTITIES[order], stamp_ns, value, limit)


def _outside(commands: _Commands) -> Flags:
    """Tell which positions are outside their limits; one that was never commanded is not."""
    lower = np.array([-math.inf if limit.lower is None else limit.lower for limit in commands.limits])
    upper = np.array([math.inf if limit.upper is None else limit.upper for limit in commands.limits])
    beyond = np.maximum(lower - commands.positions, commands.positions - upper)
    return np.asarray(beyond > _ROUNDING * np.maximum(1.0, np.abs(commands.positions)))


def _held(commands: _Commands, interruptions: Sequence[Interruption]) -> Flags:
    """Tell which commands are measured positions: those of a hold as long as it lasts, and those that leave one."""
    held = np.zeros(commands.positions.shape, dtype=np.bool_)
    for interruption in interruptions:
        begin = int(np.searchsorted(commands.stamps_ns, interruption.stamp_ns))
        if interruption.cause is Cause.HOLD and begin < len(held):
            same = commands.positions[begin:] == commands.positions[begin]
            held[begin:] |= np.logical_and.accumulate(same, axis=0)
        elif interruption.cause is Cause.OFF_COMMAND:
            held[begin : int(np.searchsorted(commands.stamps_ns, interruption.until_ns, side="right"))] = True
    return held


def _held_outside(commands: _Commands, interruptions: Sequence[Interruption]) -> LimitExcess | None:
    """Return the first hold, or start, of a position outside its limits."""
    rows, joints = np.nonzero(_outside(commands) & _held(commands, interruptions))
    if not len(rows):
        return None
    row, joint = int(rows[0]), int(joints[0])
    return _excess(commands, 0, joint, int(commands.stamps_ns[row]), float(commands.positions[row, joint]))


def _steps(commands: _Commands, interruptions: Sequence[Interruption]) -> Iterator[CommandStep]:
    """Yield the largest step that the command of a joint made at each interruption."""
    for interruption in interruptions:
        row = int(np.searchsorted(commands.stamps_ns, interruption.stamp_ns))
        if 0 < row < len(commands.stamps_ns):
            steps = np.nan_to_num(commands.positions[row] - commands.positions[row - 1])
            joint = int(np.abs(steps).argmax())
            name, cause = commands.joints[joint], interruption.cause.value
            if steps[joint] != 0.0:
                yield CommandStep(commands.controller, name, cause, interruption.stamp_ns, float(steps[joint]))
