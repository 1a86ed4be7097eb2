"""Faults of joints and hardware, asked for from outside, effective with the next update cycle."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from cellc.contract.frozen import dataclass
from cellc.mock.control.hardware.joint_motion import Noise, rate_limit
from cellc.mock.control.interfaces import Array


@dataclass(frozen=True, slots=True)
class JointFault:
    """How a joint differs from one that follows its command immediately.

    Attributes:
        stuck: the joint does not move at all.
        max_velocity: rad/s or m/s that the joint cannot exceed.
        time_constant_s: of a first-order lag behind the command; 0 for none.
        offset: rad or m added to the position.
        lower: the joint is blocked below this position.
        upper: the joint is blocked above this position.
    """

    stuck: bool = False
    max_velocity: float = math.inf
    time_constant_s: float = 0.0
    offset: float = 0.0
    lower: float = -math.inf
    upper: float = math.inf

    def follow(self, wanted: Array, previous: float, period_s: float) -> Array:
        """Positions that the joint really takes.

        Args:
            wanted: positions that it would take in successive cycles.
            previous: its position before.
            period_s: time between two cycles.

        Returns:
            Positions of the same cycles.
        """
        if self.stuck:
            return np.full_like(wanted, previous)
        if len(wanted) > 1 and self.time_constant_s > 0.0 and self._is_bounded:
            return self._follow_singly(wanted, previous, period_s)
        moved = wanted + self.offset
        if self.time_constant_s > 0.0:
            moved = _lag(moved, previous, period_s / (self.time_constant_s + period_s))
        if math.isfinite(self.max_velocity):
            moved, _ = rate_limit(moved, previous, self.max_velocity * period_s, self.lower, self.upper)
        return np.minimum(np.maximum(moved, self.lower), self.upper)

    @property
    def _is_bounded(self) -> bool:
        return math.isfinite(self.max_velocity) or math.isfinite(self.lower) or math.isfinite(self.upper)

    def _follow_singly(self, wanted: Array, previous: float, period_s: float) -> Array:
        """Follow cycle by cycle: the lag of each begins where a bound left the joint in the one before."""
        moved = np.empty_like(wanted)
        for cycle in range(len(wanted)):
            moved[cycle : cycle + 1] = self.follow(wanted[cycle : cycle + 1], previous, period_s)
            previous = float(moved[cycle])
        return moved


def _lag(wanted: Array, previous: float, share: float) -> Array:
    """First-order lag, each value a `share` of the way nearer to the wanted one."""
    lagged = wanted.tolist()
    for index, value in enumerate(lagged):
        previous = previous + share * (value - previous)
        lagged[index] = previous
    return np.array(lagged)


class Disturbances:
    """Switches faults on and off.

    Attributes:
        refused: why claims were refused that somebody asked for.

    Args:
        changed: called before each change.
        skip: called with the number of update cycles that the manager misses.
        set_state: called with component and lifecycle state.
        stand: called with a component whose commands shall be where its joints are.
        place: called with a joint and the position that it is moved to from outside.
        rest: called with a component whose joints shall stand still.
    """

    def __init__(
        self,
        changed: Callable[[], None],
        skip: Callable[[int], None],
        set_state: Callable[[str, str], object],
        stand: Callable[[str], None],
        place: Callable[[str, float], None],
        rest: Callable[[str], None],
    ) -> None:
        self._changed = changed
        self._skip = skip
        self._set_state = set_state
        self._stand = stand
        self._place = place
        self._rest = rest
        self._joints: dict[str, JointFault] = {}
        self._nature: dict[str, JointFault] = {}
        self._met: dict[str, tuple[float, float]] = {}
        self._noise: dict[str, Noise] = {}
        self._deaf: set[str] = set()
        self._failing_read: set[str] = set()
        self._failing_write: set[str] = set()
        self._lost: set[str] = set()
        self._refusing: dict[str, str] = {}
        self.refused: list[str] = []

    @property
    def disturbs_joints(self) -> bool:
        """Whether any joint differs from one that follows its command immediately."""
        return bool(self._joints or self._nature or self._met)

    def fault_of(self, joint: str) -> JointFault | None:
        """How a joint differs from one that follows its command immediately, None where it does not."""
        fault = self._joints.get(joint) or self._nature.get(joint)
        if joint not in self._met:
            return fault
        (lower, upper), alone = self._met[joint], fault or JointFault()
        return replace(alone, lower=max(lower, alone.lower), upper=min(upper, alone.upper))

    def noise_of(self, joint: str) -> Noise | None:
        """The noise of a joint's measured position, or None."""
        return self._noise.get(joint)

    @property
    def has_noise(self) -> bool:
        """Whether any joint has noise."""
        return bool(self._noise)

    def nature(self, joint: str, nature: JointFault, noise: Noise | None) -> None:
        """Say how a joint is when it is healthy; faults come on top and go."""
        self._changed()
        self._nature[joint] = nature
        if noise is not None:
            self._noise[joint] = noise

    def ignores_commands(self, component: str) -> bool:
        """Whether a component ignores its commands."""
        return component in self._deaf

    def take_read_failure(self, component: str) -> bool:
        """Whether the component's read fails in this cycle; asked once."""
        failing = component in self._failing_read
        self._failing_read.discard(component)
        return failing

    def take_write_failure(self, component: str) -> bool:
        """Whether the component's write fails in this cycle; asked once."""
        failing = component in self._failing_write
        self._failing_write.discard(component)
        return failing

    def is_lost(self, component: str) -> bool:
        """Whether the driver of a component has lost its device, and has handled that error itself."""
        return component in self._lost

    def pending(self) -> bool:
        """Whether a read or write is to fail."""
        return bool(self._failing_read or self._failing_write)

    def _present(self, joint: str) -> JointFault:
        return self._joints.get(joint) or self._nature.get(joint) or JointFault()

    def _change(self, joint: str, fault: JointFault) -> None:
        self._changed()
        self._joints[joint] = fault

    def stick(self, joint: str) -> None:
        """Let a joint stand still whatever is commanded."""
        self._change(joint, replace(self._present(joint), stuck=True))

    def slow(self, joint: str, max_velocity: float) -> None:
        """Let a joint not exceed a velocity (rad/s or m/s)."""
        self._change(joint, replace(self._present(joint), max_velocity=max_velocity))

    def lag(self, joint: str, time_constant_s: float) -> None:
        """Let a joint lag behind its command."""
        self._change(joint, replace(self._present(joint), time_constant_s=time_constant_s))

    def offset(self, joint: str, offset: float) -> None:
        """Let a joint stand beside its command by a constant (rad or m)."""
        self._change(joint, replace(self._present(joint), offset=offset))

    def block(self, joint: str, lower: float = -math.inf, upper: float = math.inf) -> None:
        """Block a joint's way, as an object between the fingers does."""
        self._change(joint, replace(self._present(joint), lower=lower, upper=upper))

    def meet(self, joint: str, lower: float, upper: float) -> None:
        """Let fingers meet a part that they cannot pass, whatever faults come and go; infinite bounds are of none."""
        self._changed()
        self._met.pop(joint, None)
        if math.isfinite(lower) or math.isfinite(upper):
            self._met[joint] = (lower, upper)

    def clear(self, joint: str) -> None:
        """Let a joint be healthy again."""
        self._changed()
        self._joints.pop(joint, None)

    def ignore_commands(self, component: str) -> None:
        """Let a component no longer follow its commands."""
        self._changed()
        self._deaf.add(component)

    def accept_commands(self, component: str) -> None:
        """Let a component follow its commands again."""
        self._changed()
        self._deaf.discard(component)

    def stand(self, component: str) -> None:
        """Let the commands of a component be where its joints stand."""
        self._changed()
        self._stand(component)

    def place(self, joint: str, position: float) -> None:
        """Let somebody move a joint of a component that ignores its commands."""
        self._changed()
        self._place(joint, position)

    def rest(self, component: str) -> None:
        """Let the joints of a component stand still."""
        self._changed()
        self._rest(component)

    def refuse_claims(self, component: str, reason: str) -> None:
        """Let a component refuse every claim of its interfaces."""
        self._refusing[component] = reason

    def accept_claims(self, component: str) -> None:
        """Let a component accept claims again."""
        self._refusing.pop(component, None)

    def take_refusal(self, component: str) -> str:
        """Why a component refuses the claim that is asked for now; empty where it does not."""
        reason = self._refusing.get(component, "")
        if reason and reason not in self.refused:
            self.refused.append(reason)
        return reason

    def fail_read(self, component: str) -> None:
        """Let the next read of a component return an error."""
        self._changed()
        self._failing_read.add(component)

    def fail_write(self, component: str) -> None:
        """Let the next write of a component return an error."""
        self._changed()
        self._failing_write.add(component)

    def skip_cycles(self, cycles: int) -> None:
        """Let the manager miss its next update cycles; the one after them sees the longer period."""
        self._changed()
        self._skip(cycles)

    def protective_stop(self, component: str) -> None:
        """Stop a component: it becomes inactive and ignores commands until it is released."""
        self._changed()
        self._deaf.add(component)
        self._set_state(component, "inactive")

    def release(self, component: str) -> None:
        """End a protective stop: the component is active again and follows commands."""
        self._changed()
        self._deaf.discard(component)
        self._set_state(component, "active")

    def lose(self, component: str) -> None:
        """Let a driver lose its device: its next read fails, its error handler leaves it unconfigured."""
        self._changed()
        self._deaf.add(component)
        self._lost.add(component)
        self._failing_read.add(component)

    def recover(self, component: str) -> None:
        """Let a stopped or lost component be active again; like any driver it begins from where its joints stand."""
        self._changed()
        self._deaf.discard(component)
        self._lost.discard(component)
        self._failing_read.discard(component)
        self._stand(component)
        self._set_state(component, "active")
