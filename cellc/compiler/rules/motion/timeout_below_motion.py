"""The timeout of a motion is shorter than the motion.

Every goal is canceled on its way. The bound is computed from the joints alone, at the speed and acceleration that the
cell allows them: the planned motion takes longer.

Example that is reported:

```yaml
interfaces:
  /move_action: {timeout: 300 ms}  # expect at timeout
```

Example that is accepted:

```yaml
interfaces:
  /move_action: {timeout: 20 s}
```

Fix: write a timeout above the longest motion, planning included.

Source: docs/principles.md#failing-closed
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.geometry import KNOWN_GOALS
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_EXECUTING = frozenset({"moveit_msgs/action/MoveGroup", "moveit_msgs/action/ExecuteTrajectory"})


@rule(Severity.ERROR, assumes=KNOWN_GOALS)
def check(graph: CellGraph) -> Findings:
    """Yield actions that execute motion with less time than the longest move of a rehearsal needs at least."""
    longest = max(_moves(graph), default=None)
    for interface in graph.cell.interfaces:
        timeout_s = interface.timeout_s
        if interface.kind is not InterfaceKind.ACTION or interface.type not in _EXECUTING or interface.derived:
            continue
        if longest is not None and timeout_s is not None and timeout_s < longest[0]:
            needed_s, start, end = longest
            message = f"the timeout of `{interface.name}` must be at least {needed_s:.2g} s, which the joints need from"
            path = (*interface.path, "timeout")
            yield found(graph, path, f"{message} `{start}` to `{end}`, got {graph.cell.text(*path)}")


def _moves(graph: CellGraph) -> list[tuple[float, str, str]]:
    """Return the least time of each move of the rehearsals, s, with the names of its ends."""
    places = _postures(graph)
    found_ = []
    for rehearsal in graph.cell.rehearsals:
        names = [step.name for step in rehearsal.steps if step.kind == "move" and step.name in places]
        for start, end in pairwise(names):
            found_.append((_least_s(graph, places[start], places[end]), start, end))
    return found_


def _postures(graph: CellGraph) -> Mapping[str, dict[str, float]]:
    """Return the joint positions of every named pose, and of every goal that has a solution."""
    places: dict[str, dict[str, float]] = {}
    for pose in graph.cell.poses:
        places.setdefault(pose.name, {}).update(zip(pose.joints, pose.positions, strict=False))
    joints = {group.name: group.joints for group in graph.cell.groups}
    groups = {goal.name: goal.group for goal in graph.cell.goals}
    for goal in motion_answer(graph).goals:
        if goal.configuration:
            places[goal.name] = dict(zip(joints[groups[goal.name]], goal.configuration, strict=True))
    return places


def _least_s(graph: CellGraph, start: Mapping[str, float], end: Mapping[str, float]) -> float:
    """Return how long the slowest joint needs from rest to rest, at its full speed and acceleration."""
    slowest = 0.0
    for device in graph.cell.devices:
        for joint in device.joints:
            if joint.name not in start or joint.name not in end or not joint.velocity:
                continue
            way = abs(end[joint.name] - start[joint.name])
            slowest = max(slowest, _alone_s(way, joint.velocity, joint.acceleration))
    return slowest


def _alone_s(way: float, velocity: float, acceleration: float | None) -> float:
    """Return the time of a joint alone: it speeds up and slows down, with a stretch at full speed on a long way."""
    if not acceleration:
        return way / velocity
    ramp = velocity / acceleration
    return 2.0 * math.sqrt(way / acceleration) if way < velocity * ramp else way / velocity + ramp
