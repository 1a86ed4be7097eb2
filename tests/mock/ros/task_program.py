"""What a task node of a picking cell does, without anything of ROS: a right one, and subtly wrong ones.

A program is advanced at each tick of its node. It sees the cell through what its node has heard, and sends goals.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Protocol

from cellc.contract.transforms import Pose

MAX_STATE_AGE_S, MAX_OBSERVATION_AGE_S = 0.1, 0.2
MOVE_TIMEOUT_S, GRIP_TIMEOUT_S = 90.0, 10.0
SUCCEEDED = 4


class Sent(Protocol):
    """A goal that was sent.

    Attributes:
        status: state of action_msgs/msg/GoalStatus that it ended in; None until then, -1 where it was rejected.
        good: its result says that it was reached.
    """

    status: int | None
    good: bool

    def cancel(self) -> None: ...


@dataclass
class States:
    """A joint state."""

    stamp_ns: int
    arrived_ns: int
    positions: Mapping[str, float]


@dataclass
class Seen:
    """Where a part was seen, in the frame of the camera."""

    stamp_ns: int
    arrived_ns: int
    frame: str
    pose: Pose


class View(Protocol):
    """What a node has heard, and what it can do.

    Attributes:
        states: the last joint state.
        observed: where the part was seen last.
        canceled: somebody asked to cancel.
        acknowledged: a person has acknowledged a stop.
    """

    @property
    def states(self) -> States | None: ...

    @property
    def observed(self) -> Seen | None: ...

    canceled: bool
    acknowledged: bool

    @property
    def now_ns(self) -> int: ...

    def is_known(self, frame: str, stamp_ns: int) -> bool: ...

    def in_world(self, frame: str, stamp_ns: int) -> Pose: ...

    def move_joints(self, group: str, positions: Mapping[str, float]) -> Sent: ...

    def move_tip(self, group: str, link: str, frame: str, pose: Pose) -> Sent: ...

    def grip(self, joint: str, position: float) -> Sent: ...


class StoppedError(Exception):
    """The program may not go on by itself."""


class Program:
    """Takes the steps of a rehearsal."""

    def __init__(self, view: View, contract: Mapping[str, Any], steps: Sequence[Mapping[str, Any]], wrong: str) -> None:
        self.view, self.contract, self.steps, self.wrong = view, contract, steps, wrong
        self.band: Mapping[str, Any] | None = None
        self.looks = False
        """What is done now rests on where the part was seen: from the move to it until the fingers have it."""
        self.early: Seen | None = None
        """Where the part was seen first while the arm was moving."""

    def run(self) -> Iterator[None]:
        stopped = False
        for step in self.steps:
            if stopped and step["kind"] != "acknowledge":
                continue
            try:
                yield from getattr(self, step["kind"])(step)
                stopped = False
            except StoppedError:
                stopped = True
                if self.wrong == "retries":
                    with suppress(StoppedError):
                        yield from getattr(self, step["kind"])(step)

    def wait(self, step: Mapping[str, Any]) -> Iterator[None]:
        until_ns = self.view.now_ns + round(step["duration_s"] * 1e9)
        while self.view.now_ns < until_ns:
            yield

    def acknowledge(self, _: Mapping[str, Any]) -> Iterator[None]:
        while not self.view.acknowledged:
            yield
        self.view.acknowledged = False

    def detect(self, _: Mapping[str, Any]) -> Iterator[None]:
        until_ns = self.view.now_ns + 1_000_000_000
        while not self.is_fresh():
            if self.view.now_ns > until_ns:
                raise StoppedError("nothing is seen")
            yield

    def move(self, step: Mapping[str, Any]) -> Iterator[None]:
        target = step["target"]
        until_ns = self.view.now_ns + 1_000_000_000
        while not self.knows_state():
            if self.view.now_ns > until_ns:
                raise StoppedError("no joint states")
            yield
        if target in self.contract["poses"]:
            for pose in self.contract["poses"][target]:
                joints = self.contract["groups"][pose["group"]]["joints"]
                scale = 57.29577951308232 if self.wrong == "degrees" else 1.0
                positions = {joint: scale * at for joint, at in zip(joints, pose["positions"], strict=True)}
                self.looks = False
                yield from self.end_of(self.view.move_joints(pose["group"], positions))
            return
        goal = self.contract["goals"][target]
        group = self.contract["groups"][goal["group"]]
        place = Pose(tuple(goal["pose"]["xyz"]), tuple(goal["pose"]["quaternion"]))
        moving = self.contract["frames"][goal["frame"]]["kind"] == "dynamic"
        if not moving:
            at = self.view.in_world(goal["frame"], 0) @ place
        elif not self.is_fresh() or self.view.observed is None:
            raise StoppedError("what was seen is too old")
        else:
            seen = self.early if self.wrong == "latest" and self.early is not None else self.view.observed
            until_ns = self.view.now_ns + 500_000_000
            while not self.view.is_known(seen.frame, seen.stamp_ns) and self.wrong != "latest":
                if self.view.now_ns > until_ns or not self.knows_state():
                    raise StoppedError("no transforms")
                yield
            frame = self.view.in_world(seen.frame, 0 if self.wrong == "latest" else seen.stamp_ns)
            at = (seen.pose if self.wrong == "frame" else frame @ seen.pose) @ place
        root = self.contract["root_frame"]
        self.looks = moving
        yield from self.end_of(self.view.move_tip(goal["group"], group["tip_frame"], root, at))

    def grip(self, step: Mapping[str, Any]) -> Iterator[None]:
        facts = self.contract["devices"][step["target"]]["gripper"]
        closes = step.get("command", "close") == "close"
        self.band = None
        self.looks = self.looks and self.wrong != "blind_grip"
        sent = self.view.grip(facts["joint"], facts["closed" if closes else "open"])
        yield from self.end_of(sent, timeout_s=GRIP_TIMEOUT_S)
        part = self.contract["frames"].get(step.get("part") or "", {}).get("grasp") or {}
        self.band = (part.get("bands") or {}).get(step["target"]) if closes else None
        self.looks = self.looks and not closes
        if not self.holds() and self.wrong != "no_look":
            raise StoppedError("the fingers are elsewhere")

    def end_of(self, sent: Sent, timeout_s: float = MOVE_TIMEOUT_S) -> Iterator[None]:
        """Wait for the end of a goal, and cancel it where the cell is no longer known, or somebody asks for it."""
        began_ns = self.view.now_ns
        until_ns = began_ns + round(timeout_s * 1e9)
        while sent.status is None:
            if self.view.now_ns > began_ns + 500_000_000:
                self.early = self.early or self.view.observed
            lost = not self.knows_state() or (self.looks and not self.is_fresh()) or not self.holds()
            if self.wrong == "no_look":
                lost = False
            asked = self.view.canceled and self.wrong != "deaf"
            if lost or asked or (self.view.now_ns > until_ns and self.wrong != "endless"):
                sent.cancel()
                while sent.status is None:
                    yield
                raise StoppedError("canceled")
            yield
        if sent.status != SUCCEEDED or not sent.good:
            raise StoppedError("the goal was not reached")

    def knows_state(self) -> bool:
        if self.view.states is None:
            return False
        states = self.view.states
        taken_ns = states.arrived_ns if self.wrong == "arrival" else states.stamp_ns
        age_s = (self.view.now_ns - taken_ns) / 1e9
        return abs(age_s) <= MAX_STATE_AGE_S or self.wrong == "stale"

    def is_fresh(self) -> bool:
        if self.view.observed is None:
            return False
        return (
            abs(self.view.now_ns - self.view.observed.stamp_ns) / 1e9 <= MAX_OBSERVATION_AGE_S or self.wrong == "stale"
        )

    def holds(self) -> bool:
        """Tell whether the fingers are where they hold a part, if they hold one."""
        if self.band is None or self.view.states is None:
            return True
        return bool(self.band["lower"] <= self.view.states.positions[self.band["joint"]] <= self.band["upper"])
