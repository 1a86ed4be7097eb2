#!/usr/bin/env python3
"""Moves one joint slightly to both sides with a trajectory controller, while all others keep their position.

    first_goal --action NAME --states TOPIC --joint NAME --by RAD --seconds S --timeout S [--absent NODE]... \
        [--then end|cancel] [--evidence DIR] [--package DIR] JOINT:LOWER:UPPER...

It starts only when the states of all joints are fresh and all joints are at standstill, with no motion client running.
`end` moves the joint by BY, back, to the other side and back, and skips a side beyond a limit. `cancel` moves it by BY,
cancels halfway, prints the time from the request to standstill, and moves it back. A joint that leaves its path, or
states that stop arriving, cancel the goal; so does Ctrl-C. The exit status is 0 when every goal ended as requested.
With --evidence it writes the result as JSON, command, state and error of each joint as CSV, and the plot of the moving
joint as SVG. goal.launch.xml starts it, with a person's authorization, while the claims hold.
"""

from __future__ import annotations

import argparse
import csv
import html
import json
import math
import signal
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

WAIT_S = 10.0  # for states, for the server, and for standstill
FRESH_S = 0.5  # age of the newest states, by their arrival and by their stamp
STILL = 5e-4  # rad or m; a joint that stays within it is at standstill, however slow its goals are
STILL_S = 0.5  # for so long
SLACK = 0.2  # share of BY by which a joint may leave its way
SUCCEEDED, CANCELED = 4, 5  # action_msgs/msg/GoalStatus


class Sample(NamedTuple):
    """One joint at one time: command and error where the controller's feedback has them, else NaN."""

    time_s: float
    goal: str
    joint: str
    command: float
    state: float
    error: float


class MotionError(Exception):
    """No motion, or an end of it; the text says why."""


class Robot:
    """The controller's action, and the newest state of each joint."""

    def __init__(self, action: str, states: str) -> None:
        import rclpy
        from control_msgs.action import FollowJointTrajectory
        from rclpy.action import ActionClient
        from rclpy.qos import qos_profile_sensor_data
        from rclpy.signals import SignalHandlerOptions
        from sensor_msgs.msg import JointState

        # Ctrl-C must cancel the goal, for which the context has to live on.
        rclpy.init(args=sys.argv, signal_handler_options=SignalHandlerOptions.NO)
        self._rclpy, self._type = rclpy, FollowJointTrajectory
        self._node = rclpy.create_node("first_goal", start_parameter_services=False)
        self._client = ActionClient(self._node, FollowJointTrajectory, action)
        self.positions: dict[str, float] = {}
        self.arrived: dict[str, float] = {}
        self.moved: dict[str, float] = {}
        self._held: dict[str, float] = {}
        self.stamp_age_s = math.inf
        self.samples: list[Sample] = []
        self.goal = ""
        self._node.create_subscription(JointState, states, self._take, qos_profile_sensor_data)

    def _take(self, message: Any) -> None:
        now = time.monotonic()
        stamp = message.header.stamp
        self.stamp_age_s = self._node.get_clock().now().nanoseconds * 1e-9 - stamp.sec - stamp.nanosec * 1e-9
        for name, position in zip(message.name, message.position, strict=False):
            if not abs(position - self._held.get(name, math.nan)) <= STILL:
                self._held[name], self.moved[name] = position, now
            self.positions[name], self.arrived[name] = position, now
            if self.goal:
                self.samples.append(Sample(now, self.goal, name, math.nan, position, math.nan))

    def _follow(self, message: Any) -> None:
        now, feedback = time.monotonic(), message.feedback
        columns = (feedback.desired.positions, feedback.actual.positions, feedback.error.positions)
        for name, command, state, error in zip(feedback.joint_names, *columns, strict=False):
            self.samples.append(Sample(now, self.goal, name, command, state, error))

    def spin(self, seconds: float) -> None:
        self._rclpy.spin_once(self._node, timeout_sec=seconds)

    def nodes(self) -> list[str]:
        return [f"{space.rstrip('/')}/{name}" for name, space in self._node.get_node_names_and_namespaces()]

    def serves(self) -> bool:
        return bool(self._client.server_is_ready())

    def send(self, joints: Sequence[str], positions: Sequence[float], seconds: float) -> Any:
        from builtin_interfaces.msg import Duration
        from trajectory_msgs.msg import JointTrajectoryPoint

        goal = self._type.Goal()
        goal.trajectory.joint_names = [*joints]
        whole = int(seconds)
        when = Duration(sec=whole, nanosec=round((seconds - whole) * 1e9))
        point = JointTrajectoryPoint(positions=[*positions], velocities=[0.0] * len(positions), time_from_start=when)
        goal.trajectory.points = [point]
        return self._client.send_goal_async(goal, feedback_callback=self._follow)

    def leave(self) -> None:
        self._node.destroy_node()
        self._rclpy.try_shutdown()


class Trial:
    """One joint from its start: out and back to both sides, or out, canceled halfway and back."""

    def __init__(self, robot: Any, arguments: argparse.Namespace) -> None:
        self._robot, self._arguments = robot, arguments
        self._limits = dict(map(limits_of, arguments.joints))
        self._joints = (*self._limits,)
        self._start: dict[str, float] = {}
        self._interrupted = False

    def interrupt(self, *_signal: object) -> None:
        self._interrupted = True

    def run(self) -> str:
        """Check, then send the goals; return why that failed, or an empty text."""
        try:
            self._check()
            self._start = {name: self._robot.positions[name] for name in self._joints}
            for name, offset, cancels in self._goals(self._sides()):
                self._send(name, offset, cancels)
        except MotionError as error:
            return str(error)
        return ""

    def _goals(self, sides: Sequence[float]) -> Iterator[tuple[str, float, bool]]:
        canceled = self._arguments.then == "cancel"
        yield ("canceled" if canceled else "out"), sides[0], canceled
        yield "back", 0.0, False
        if not canceled and len(sides) > 1:
            yield "other side", sides[1], False
            yield "back again", 0.0, False

    def _sides(self) -> list[float]:
        """Return the motions to the sides that are open, rad or m.

        Raises:
            MotionError: a limit is nearer to both sides.
        """
        joint, by = self._arguments.joint, self._arguments.by
        lower, upper = self._limits[joint]
        position = self._start[joint]
        sides = [side for side in (by, -by) if lower <= position + side <= upper]
        near = f"{joint} at {position:.4f} is closer than {abs(by):.4f} to one of its limits {lower:g} and {upper:g}"
        if not sides:
            raise MotionError(near)
        if len(sides) == 1:
            print(f"{near}: moving only to the {'+' if sides[0] > 0.0 else '-'} side", flush=True)
        return sides

    def _check(self) -> None:
        """Return when everything is ready.

        Raises:
            MotionError: no goal may be sent.
        """
        robot, arguments = self._robot, self._arguments
        if arguments.joint not in self._limits:
            raise MotionError(f"{arguments.joint} is not a joint of {arguments.action}")
        if not self._wait(robot.serves, WAIT_S):
            raise MotionError(f"no server for {arguments.action}")
        if not self._wait(lambda: set(self._joints) <= set(robot.positions), WAIT_S):
            missing = ", ".join(sorted(set(self._joints) - set(robot.positions)))
            raise MotionError(f"no state of {missing} on {arguments.states}")
        if running := ", ".join(name for name in arguments.absent if name in robot.nodes()):
            raise MotionError(f"stop {running} first: no motion client may run")
        if not self._wait(lambda: not self._stale() and not self._moving(STILL_S), WAIT_S):
            raise MotionError(
                self._stale() or f"{', '.join(self._moving(STILL_S))} not at standstill for {STILL_S:g} s"
            )

    def _stale(self) -> str:
        robot = self._robot
        oldest = time.monotonic() - min(robot.arrived[name] for name in self._joints)
        if oldest > FRESH_S:
            return f"states on {self._arguments.states} stopped arriving {oldest:.2f} s ago"
        if abs(robot.stamp_age_s) > FRESH_S:
            return (
                f"stamps on {self._arguments.states} are {robot.stamp_age_s:.2f} s old, at most {FRESH_S:g} s allowed"
            )
        return ""

    def _moving(self, seconds: float) -> list[str]:
        """Return the joints that moved in the last so many seconds."""
        since = time.monotonic() - seconds
        return [name for name in self._joints if self._robot.moved[name] > since]

    def _wait(self, holds: Callable[[], bool], seconds: float) -> bool:
        """Spin until a condition holds; return whether it does.

        Raises:
            MotionError: a person pressed Ctrl-C, or the launch ends.
        """
        until = time.monotonic() + seconds
        while not holds() and time.monotonic() < until:
            self._robot.spin(0.05)
            if self._interrupted:
                self._interrupted = False  # what follows is the cancel, which may be waited for
                raise MotionError("interrupted")
        return holds()

    def _send(self, name: str, offset: float, cancels: bool) -> None:
        """Send one goal and see it end as requested.

        Raises:
            MotionError: it was canceled, or ended otherwise.
        """
        robot, arguments = self._robot, self._arguments
        before = self._places()
        target = {joint: self._start[joint] + (offset if joint == arguments.joint else 0.0) for joint in self._joints}
        robot.goal = name
        sent = robot.send([*target], [*target.values()], arguments.seconds)
        try:
            if not self._wait(sent.done, WAIT_S) or not sent.result().accepted:
                raise MotionError(f"{arguments.action} did not accept the goal")
            ended = sent.result().get_result_async()
            if cancels:
                if not self._watch(lambda: self._is_halfway(before, target), arguments.timeout, before, target):
                    raise MotionError(f"{arguments.joint} was not halfway within {arguments.timeout:g} s")
                self._cancel(sent.result())
            if not self._watch(ended.done, arguments.timeout, before, target):
                raise MotionError(f"the goal did not end within {arguments.timeout:g} s and was canceled")
        except MotionError as error:
            self._end(sent)
            raise MotionError(f"{name}: {error}") from None
        self._report(name, ended.result(), CANCELED if cancels else SUCCEEDED, before)
        wanted, moved = (place[arguments.joint] - before[arguments.joint] for place in (target, self._places()))
        if not cancels and moved * math.copysign(1.0, wanted) < abs(wanted) / 2.0:
            raise MotionError(
                f"{name}: {arguments.joint} moved {moved:+.4f} of {wanted:+.4f}, which a wide tolerance hides"
            )

    def _watch(
        self, holds: Callable[[], bool], seconds: float, before: dict[str, float], target: dict[str, float]
    ) -> bool:
        """Spin until a condition holds, with every joint on its way from ``before`` to ``target``."""
        slack = SLACK * abs(self._arguments.by)

        def ends() -> bool:
            for name in self._joints:
                first, last = sorted((before[name], target[name]))
                position = self._near(name)
                if not first - slack <= position <= last + slack:
                    raise MotionError(f"{name} at {position:.4f} left its path from {first:.4f} to {last:.4f}")
            if stale := self._stale():
                raise MotionError(stale)
            return holds()

        return self._wait(ends, seconds)

    def _is_halfway(self, before: dict[str, float], target: dict[str, float]) -> bool:
        joint = self._arguments.joint
        return bool(abs(self._near(joint) - before[joint]) >= abs(target[joint] - before[joint]) / 2.0)

    def _places(self) -> dict[str, float]:
        return {joint: self._near(joint) for joint in self._joints}

    def _near(self, name: str) -> float:
        """Return where a joint is; without limits it may be reported a turn away from its start, rad."""
        position, start = self._robot.positions[name], self._start[name]
        turns = all(map(math.isinf, self._limits[name]))
        return float(start + math.remainder(position - start, math.tau) if turns else position)

    def _end(self, sent: Any) -> None:
        """Cancel a goal, also one that is accepted only now, and wait for its end."""
        if self._wait(sent.done, WAIT_S) and sent.result().accepted:
            sent.result().cancel_goal_async()
            self._wait(sent.result().get_result_async().done, self._arguments.timeout)

    def _cancel(self, handle: Any) -> None:
        """Cancel, and print the time from the request to standstill."""
        requested = last = time.monotonic()
        handle.cancel_goal_async()
        while time.monotonic() < min(requested + self._arguments.timeout, last + STILL_S):
            self._robot.spin(0.02)
            last = max(last, *(self._robot.moved[name] for name in self._joints))
        print(f"canceled: standstill {last - requested:.3f} s after the request", flush=True)

    def _report(self, name: str, answer: Any, expected: int, before: dict[str, float]) -> None:
        for joint in self._joints:
            after = self._near(joint)
            moved = after - before[joint]
            print(f"{name}: {joint} {before[joint]:.4f} before, {after:.4f} after, {moved:+.4f}", flush=True)
        result = f"status {answer.status}, error_code {answer.result.error_code} {answer.result.error_string}".rstrip()
        print(f"{name}: {result}", flush=True)
        if answer.status != expected:
            raise MotionError(f"{name}: unexpected result: {result}")


def limits_of(text: str) -> tuple[str, tuple[float, float]]:
    """Return a joint with its limits, rad or m; infinite where it has none."""
    name, lower, upper = text.split(":")
    return name, (float(lower or "-inf"), float(upper or "inf"))


def write_evidence(samples: Sequence[Sample], arguments: argparse.Namespace, why: str) -> None:
    """Write how it ended as JSON, samples as CSV, and those of one joint as SVG; nothing that exists is replaced."""
    joint, then, begun = arguments.joint, arguments.then, time.strftime("%Y%m%dT%H%M%SZ", time.gmtime())
    (folder := arguments.evidence).mkdir(parents=True, exist_ok=True)
    stem = f"G7-first-goal-{joint}-{then}-{begun}"
    record = {"attempt_id": begun, **identity(arguments.package), "joint": joint, "then": then, "seen": why}
    with (folder / f"{stem}.json").open("x", encoding="utf-8") as file:
        json.dump({**record, "verdict": "FAILED" if why else "PASSED"}, file, indent=1)
    timed = [sample._replace(time_s=sample.time_s - samples[0].time_s) for sample in samples]
    with (folder / f"{stem}.csv").open("x", encoding="utf-8", newline="") as file:
        (table := csv.writer(file)).writerow(Sample._fields)
        for sample in timed:
            figures = ("" if math.isnan(value) else f"{value:.6f}" for value in sample[3:])
            table.writerow([f"{sample.time_s:.4f}", sample.goal, sample.joint, *figures])
    with (folder / f"{stem}.svg").open("x", encoding="utf-8") as file:
        file.write(plot([sample for sample in timed if sample.joint == joint], joint))
    print(f"wrote {folder / stem}.json, .csv and .svg", flush=True)


def identity(package: Path | None) -> dict[str, str]:
    """Return cell and configuration ID of a package; none where it cannot be read: what moved is kept all the same."""
    try:
        contract = json.loads(((package or Path()) / "contract.json").read_text(encoding="utf-8"))
        return {name: contract[name] for name in ("cell", "configuration_id")}
    except (OSError, ValueError, KeyError, TypeError):
        return {}


def plot(samples: Sequence[Sample], joint: str) -> str:
    """Return command and state over time, and the error below, each on a scale of its own."""
    whole = max((sample.time_s for sample in samples), default=0.0) or 1.0
    said = f"{html.escape(joint)}: command (broad gray line) and state (thin blue line), rad or m"
    lines = [f'<title>{said}</title><text x="60" y="20">{said}</text>', '<text x="60" y="268">error, rad or m</text>']
    for columns, top in ((("command", "state"), 40.0), (("error",), 280.0)):
        values = [value for sample in samples for name in columns if math.isfinite(value := getattr(sample, name))]
        low, high = (min(values), max(values)) if values else (0.0, 0.0)
        lines += [f'<text x="2" y="{y:g}">{v:.4g}</text>' for y, v in ((top + 8.0, high), (top + 180.0, low))]
        for name in columns:
            points = " ".join(
                f"{60.0 + 720.0 * sample.time_s / whole:.1f},{top + 180.0 * (high - value) / (high - low or 1.0):.1f}"
                for sample in samples
                if math.isfinite(value := getattr(sample, name))
            )
            stroke = {"command": 'silver" stroke-width="6', "state": "blue", "error": "red"}[name]
            lines.append(f'<polyline fill="none" stroke="{stroke}" points="{points}"/>')
    head = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 800 500" font-family="sans-serif" font-size="12">'
    lines.append(f'<text x="60" y="490">0 to {whole:.2f} s</text>')
    return "\n".join((head, '<rect width="800" height="500" fill="white"/>', *lines, "</svg>", ""))


def arguments_of(words: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--action", required=True)
    parser.add_argument("--states", required=True)
    parser.add_argument("--joint", required=True, help="joint to move")
    parser.add_argument("--by", type=float, required=True, help="rad or m to either side; signed for the first side")
    parser.add_argument("--seconds", type=float, required=True, help="duration of one motion")
    parser.add_argument("--timeout", type=float, required=True, help="seconds until a goal must end")
    parser.add_argument("--absent", action="append", default=[], help="node that must not run")
    parser.add_argument("--then", choices=("end", "cancel"), default="end")
    parser.add_argument("--evidence", type=Path, help="folder of the attempt")
    parser.add_argument("--package", type=Path, help="share folder of this package, whose ID is recorded")
    parser.add_argument("joints", nargs="+", help="all joints of the controller, each with its limits")
    options = [*words[: words.index("--ros-args")]] if "--ros-args" in words else [*words]
    return parser.parse_args(options)


def main(words: Sequence[str]) -> int:
    """Check, send, write the evidence; return the exit status."""
    arguments = arguments_of(words)
    robot = Robot(arguments.action, arguments.states)
    trial = Trial(robot, arguments)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, trial.interrupt)
    try:
        why = trial.run()
    finally:
        robot.leave()
    if arguments.evidence is not None:
        write_evidence(robot.samples, arguments, why)
    if why:
        print(f"first_goal failed: {why}", file=sys.stderr, flush=True)
    return 1 if why else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
