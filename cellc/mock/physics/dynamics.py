"""All bodies of a cell in simulated time: computed ahead with the hardware, adopted or void with it.

A state that was adopted is a row of numbers. What is computed next begins with it, so that it never depends on what
was computed and not adopted, on the length of blocks, or on who copied the cell meanwhile.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, Vector3
from cellc.mock.control.interfaces import Array, Times
from cellc.mock.errors import MockError
from cellc.mock.physics.contacts import Contacts
from cellc.mock.physics.reading import SCENE_FILE
from cellc.robot.physics.scene import Bodies, Scene, SceneError, Touch, Weight


@dataclass(frozen=True, slots=True)
class Seen:
    """Two bodies that pressed on each other at a time."""

    stamp_ns: int
    touch: Touch


@dataclass(frozen=True, slots=True)
class _Block:
    """Cycles that were computed ahead.

    Attributes:
        states: after each cycle, shape (cycles, numbers of a state).
        seen: contacts that are not planned, with the number of the cycle.
        pressing: in each cycle the numbers of two bodies in each contact, and its force in N.
        commands: of all drives in each cycle, shape (cycles, drives).
        followed: command and its step in each cycle, of the drives that are led ahead.
    """

    times_ns: Times
    states: Array
    commands: Array
    seen: tuple[tuple[int, Seen], ...]
    pressing: tuple[tuple[NDArray[np.intp], Array], ...]
    followed: Mapping[int, tuple[Array, Array]]


@dataclass(frozen=True, slots=True)
class Change:
    """How a part differs from the scene.

    Attributes:
        wider_m: by which it is wider.
        friction: of its contacts; None as in the scene.
        seen_at: where it is seen while none is there; None where it is what is seen.
    """

    wider_m: float = 0.0
    friction: float | None = None
    seen_at: Pose | None = None


_UPRIGHT = 0.7
"""Part of a unit normal along the vertical from which on a contact carries more than it clamps."""
_AWAY = Pose((0.0, 0.0, -1000.0), (0.0, 0.0, 0.0, 1.0))
"""Where a part is that is missing: it falls for ever and meets nothing."""


class Dynamics:
    """Joints behind their drives, and parts that lie, are held, slip and fall.

    Attributes:
        scene: that it is made of.
        seen: contacts that are not planned, one for each two bodies and cycle.
        contacts: how hard any two bodies pressed on each other at most.
        shared: joints have several owners.

    Args:
        scene: of the package.
        planned: pairs of bodies that may touch.
        fingers: links by the gripper whose fingers they are.
        owners: managers and adapters that move joints.
        leads_s: joint → how far ahead of its command its drive is led, by the velocity of the command, s. Drives brake
            the motion of their joint: one that brakes the error alone is led by its damping over its stiffness.
    """

    def __init__(
        self,
        scene: Scene,
        planned: frozenset[frozenset[str]],
        fingers: Mapping[str, tuple[str, ...]],
        leads_s: Mapping[str, float],
        owners: int = 1,
    ) -> None:
        self.fingers = fingers
        self.shared = owners > 1
        self.scene = scene
        self.seen: list[Seen] = []
        self.contacts = Contacts(scene.bodies)
        self._planned = planned
        self._watched = scene.watched(planned)
        self._leads_s = {scene.drives[joint]: lead for joint, lead in leads_s.items()}
        self._aims: dict[int, Array] = {}
        self._followed: dict[int, tuple[float, float]] = {}
        self._block: _Block | None = None
        self._adopted = 0
        self._changes: dict[str, Change] = {}
        self._weights: dict[str, Weight] = {}
        self._bodies: Bodies | None = Bodies(scene)
        self._state = self._bodies.state()
        self._held: Array | None = self._state
        self._times: list[int] = [0]
        self._states: list[Array] = [self._state]
        self._commands: list[Array] = [scene.aims(self._state)]

    def __getstate__(self) -> dict[str, Any]:
        """Return what a copy needs: what MuJoCo holds follows from it."""
        return {**self.__dict__, "_bodies": None, "_held": None}

    # -- joints ------------------------------------------------------------------------------------------------------

    def begin(self, positions: Mapping[str, float]) -> None:
        """Let joints be somewhere before anything moves, rad or m."""
        bodies = self._now()
        bodies.place({joint: at for joint, at in positions.items() if joint in self.scene.joints})
        self._change(bodies)

    def place(self, joint: str, position: float) -> None:
        """Let somebody move a joint, which is at rest there."""
        self.begin({joint: position})

    def aim(self, joints: Sequence[str], targets: Array) -> None:
        """Lead joints in the next cycles, rad or m, shape (cycles, joints); others stay led where they were."""
        for column, joint in enumerate(joints):
            if joint in self.scene.drives:
                self._aims[self.scene.drives[joint]] = targets[:, column]

    def advance(self, times_ns: Times) -> None:
        """Compute where everything is at the times of the next cycles, in simulated ns.

        Raises:
            MockError: the scene does not stay in one piece.
        """
        if int(times_ns[-1]) <= self._times[-1]:
            self._recall(times_ns)
            return
        bodies, at_ns = self._now(), self._times[-1]
        states = np.empty((len(times_ns), self.scene.size))
        aims = self._commands[-1].copy()
        columns: NDArray[np.intp] = np.array(list(self._aims), dtype=np.intp)
        followed = {
            drive: self._steps(drive, targets) for drive, targets in self._aims.items() if drive in self._leads_s
        }
        commands = np.tile(self._commands[-1], (len(times_ns), 1))
        if len(columns):
            commands[:, columns] = np.array(list(self._aims.values())).T
        led = np.array([self._led(drive, self._aims[drive], followed, times_ns) for drive in self._aims]).T
        seen: list[tuple[int, Seen]] = []
        pressing: list[tuple[NDArray[np.intp], Array]] = []
        for cycle, time_ns in enumerate(times_ns.tolist()):
            if len(columns):
                aims[columns] = led[cycle]
            bodies.run(time_ns // self.scene.step_ns - at_ns // self.scene.step_ns, aims)
            bodies.state(states[cycle])
            seen += [(cycle, Seen(time_ns, touch)) for touch in bodies.touches(self._watched)]
            pressing.append(bodies.pressing())
            at_ns = time_ns
        self._aims.clear()
        self._block = _Block(times_ns, states, commands, tuple(seen), tuple(pressing), followed)
        self._adopted, self._held = 0, None
        try:
            bodies.refuse_unstable()
        except SceneError as error:
            raise MockError(SCENE_FILE, str(error)) from None

    def _recall(self, times_ns: Times) -> None:
        """Take what was computed for another owner at a time; what is asked of the drives waits for the next one."""
        at = [max(0, bisect_right(self._times, time_ns) - 1) for time_ns in times_ns.tolist()]
        states, commands = (np.array([kept[row] for row in at]) for kept in (self._states, self._commands))
        self._block, self._adopted = _Block(times_ns, states, commands, (), (), {}), len(at)

    def _steps(self, drive: int, targets: Array) -> tuple[Array, Array]:
        """Return the commands of a drive in the next cycles, and how far each is from the one before."""
        before = self._followed.get(drive, (float(targets[0]), 0.0))[0]
        return targets, np.diff(targets, prepend=before)

    def _led(self, drive: int, targets: Array, followed: Mapping[int, tuple[Array, Array]], times_ns: Times) -> Array:
        """Return where a drive is led; a command that jumps once has no velocity: of two steps the smaller counts."""
        if drive not in followed:
            return targets
        steps = followed[drive][1]
        before = np.concatenate(([self._followed.get(drive, (0.0, 0.0))[1]], steps[:-1]))
        smaller = np.where(np.abs(before) < np.abs(steps), before, steps)
        periods_s = np.maximum(np.diff(times_ns, prepend=self._times[-1]), 1) / 1e9
        return targets + self._leads_s[drive] * np.where(steps * before > 0.0, smaller, 0.0) / periods_s

    def positions(self, joints: Sequence[str]) -> Array:
        """Return where joints are in the cycles that were computed last, rad or m, shape (cycles, joints)."""
        return self.scene.positions(self._computed.states, joints)

    def velocities(self, joints: Sequence[str]) -> Array:
        """Return how fast joints are in the cycles that were computed last, rad/s or m/s."""
        return self.scene.velocities(self._computed.states, joints)

    def moving(self, joints: Sequence[str]) -> Array:
        """Return how fast joints are now, rad/s or m/s."""
        return self.scene.velocities(self._state, joints)

    def standing(self, joints: Sequence[str]) -> Array:
        """Return where joints are now, rad or m."""
        return self.scene.positions(self._state, joints)

    def commit(self, cycles: int) -> None:
        """Adopt the first cycles of what was computed last."""
        block, first = self._computed, self._adopted
        if first >= cycles:
            return
        self.seen += [seen for cycle, seen in block.seen if first <= cycle < cycles]
        self.contacts.add(block.times_ns[first:cycles], block.pressing[first:cycles])
        self._times += block.times_ns[first:cycles].tolist()
        self._states.extend(block.states[first:cycles].copy())
        self._commands.extend(block.commands[first:cycles].copy())
        self._state, self._adopted = self._states[-1], cycles
        for drive, (targets, steps) in block.followed.items():
            self._followed[drive] = float(targets[cycles - 1]), float(steps[cycles - 1])

    def since(self, stamp_ns: int, until_ns: int | None = None) -> tuple[Times, Array, Array]:
        """Return the times of cycles after an instant, the states, and the commands of the drives in them."""
        first = bisect_right(self._times, stamp_ns)
        end = len(self._times) if until_ns is None else bisect_right(self._times, until_ns)
        times = np.array(self._times[first:end], dtype=np.int64)
        rows = len(times)
        states = np.array(self._states[first:end]).reshape(rows, self.scene.size)
        return times, states, np.array(self._commands[first:end]).reshape(rows, len(self.scene.drives))

    @property
    def _computed(self) -> _Block:
        assert self._block is not None, "cycles are computed before they are asked about"
        return self._block

    # -- parts -------------------------------------------------------------------------------------------------------

    def moves(self, part: str) -> bool:
        """Return whether a part is a body of the scene."""
        return part in self.scene.parts

    def put(self, part: str, pose: Pose) -> None:
        """Put a part somewhere in the root frame, at rest."""
        bodies = self._now()
        bodies.put(part, pose)
        self._change(bodies)

    def slide(self, part: str, by_m: float) -> None:
        """Slide a part sideways between the fingers that press on it, or down where none does.

        It stays in their pads, and does not get into what it may still stand on.
        """
        pressed = [touch for touch in self.touches() if part in (touch.one, touch.other)]
        sides = [touch for touch in pressed if abs(touch.normal[2]) < _UPRIGHT]
        way: Vector3 = (0.0, 0.0, -1.0)
        if sides:
            x, y, _ = max(sides, key=lambda touch: touch.force_n).normal
            length = math.hypot(x, y)
            way = (-y / length, x / length, 0.0)
        bodies = self._now()
        bodies.shift(part, (way[0] * by_m, way[1] * by_m, way[2] * by_m))
        self._change(bodies)

    def touches(self) -> tuple[Touch, ...]:
        """Return what presses on what now."""
        bodies = self._now()
        bodies.look()
        self._held = None
        return tuple(bodies.touches())

    def reshape(self, part: str, *, wider_m: float | None = None, friction: float | None = None) -> None:
        """Let a part be wider, or smoother, than the scene has it; None keeps what is so by now."""
        before = self._changes.get(part, Change())
        wider_m = before.wider_m if wider_m is None else wider_m
        change = replace(before, wider_m=wider_m, friction=before.friction if friction is None else friction)
        bodies = self._now()
        self._changes[part] = change
        bodies.shape(part, change.wider_m, change.friction)

    def weigh(self, weights: Mapping[str, Weight]) -> None:
        """Let bodies be heavier or lighter than the scene has them, or be held otherwise by who controls them."""
        bodies = self._now()
        self._weights.update(weights)
        bodies.weigh(self._weights)

    def miss(self, part: str, *, missing: bool) -> None:
        """Let a part be seen where it was, and not be there, or be there again."""
        before = self._changes.get(part, Change())
        if missing == (before.seen_at is not None):
            return
        at = self.pose(part, self._times[-1])
        self._changes[part] = replace(before, seen_at=at if missing else None)
        self.put(part, _AWAY if missing else at)

    def weight_n(self, part: str) -> float:
        """Return what a part weighs."""
        return self._now().weight_n(part)

    def friction(self, part: str) -> float:
        """Return the friction of a part's contacts."""
        return self._now().friction(part)

    def pose(self, part: str, stamp_ns: int) -> Pose:
        """Return where a part is seen at a time, in the root frame."""
        change = self._changes.get(part)
        if change is not None and change.seen_at is not None:
            return change.seen_at
        at = max(0, bisect_right(self._times, stamp_ns) - 1)
        return self.scene.pose(self._states[at], part)

    # -- what is computed with ---------------------------------------------------------------------------------------

    def _now(self) -> Bodies:
        """Return the bodies as they were adopted last."""
        if self._bodies is None:
            self._bodies = Bodies(self.scene)
            if self._weights:
                self._bodies.weigh(self._weights)
            for part, change in self._changes.items():
                self._bodies.shape(part, change.wider_m, change.friction)
        if self._held is not self._state:
            self._bodies.restore(self._state)
            self._held = self._state
        return self._bodies

    def _change(self, bodies: Bodies) -> None:
        """Adopt what somebody has moved at this instant."""
        self._state = self._held = bodies.state()
        self._states[-1], self._commands[-1] = self._state, self.scene.aims(self._state)


@dataclass(frozen=True, slots=True)
class Pressed:
    """Two bodies that are not to touch, with the largest force between them."""

    one: str
    other: str
    first_ns: int
    most_n: float

    def __str__(self) -> str:
        names = f"{self.one} and {self.other} press on each other"
        return f"{names} from {self.first_ns / 1e9:.3f} s on, with up to {self.most_n:.3g} N"


def pressed(seen: Iterable[Seen], since_ns: int) -> Iterator[Pressed]:
    """Yield what pressed on what since an instant, in the order of time."""
    found: dict[tuple[str, str], Pressed] = {}
    for each in seen:
        if each.stamp_ns > since_ns:
            one, other = sorted((each.touch.one, each.touch.other))
            before = found.get((one, other))
            first_ns = each.stamp_ns if before is None else before.first_ns
            most_n = max(each.touch.force_n, 0.0 if before is None else before.most_n)
            found[one, other] = Pressed(one, other, first_ns, most_n)
    yield from found.values()
