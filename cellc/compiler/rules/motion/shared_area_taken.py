"""Two arms are in one shared area, which is granted to one at a time.

Each planner knows the other arm only at its pose while it plans, and nothing else: two arms of two managers that were
both let in meet there as soon as both move. An area that arms share is held by one at a time; the other waits until it
has left. Where a hand-over needs both, a person writes down under which conditions they may be there together.

What is compared is where the arms stand after each move of a rehearsal, and where the cell begins. The way there is
planned again each time: on the real cell the one that `granted_by` names lets no arm in before the other is out.

Example that is reported:

```yaml
# a cell of two arms
areas:
  middle: {parent: world, xyz: 0 800 1000 mm, box: 1000 500 2000 mm, granted_by: safety_plc}
motion:
  poses:
    out: {side_group: 0 -90 90 -90 -90 0 deg, manipulator: 0 -90 90 -90 -90 0 deg}
    first_in: {manipulator: 90 -45 45 -90 -90 0 deg}
    second_in: {side_group: -90 -45 45 -90 -90 0 deg}
rehearsals:
  both: {steps: [{move: out}, {move: first_in}, {move: second_in}]}  # expect at steps.2.move
```

Example that is accepted:

```yaml
# a cell of two arms
areas:
  middle: {parent: world, xyz: 0 800 1000 mm, box: 1000 500 2000 mm, granted_by: safety_plc}
motion:
  poses:
    out: {side_group: 0 -90 90 -90 -90 0 deg, manipulator: 0 -90 90 -90 -90 0 deg}
    first_in: {manipulator: 90 -45 45 -90 -90 0 deg}
    second_in: {side_group: -90 -45 45 -90 -90 0 deg}
rehearsals:
  both: {steps: [{move: out}, {move: first_in}, {move: out}, {move: second_in}]}
```

Fix: move the one that is in it out before the other comes, or write under `released` why both may be there.

Source: docs/principles.md#one-owner-for-each-volume
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.cell.frame import SharedArea
from cellc.compiler.cell.motion import Rehearsal, Step
from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.geometry import KNOWN_GOALS
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule

_Inside = Mapping[str, frozenset[str]]
"""Posture → arms with a link in the area; the empty posture is where the cell starts."""


@rule(Severity.ERROR, assumes=KNOWN_GOALS)
def check(graph: CellGraph) -> Findings:
    """Yield the first step of each rehearsal after which two arms stand in an area that is not released to both."""
    if not graph.cell.areas:
        return
    arms = _arms(graph)
    answers = motion_answer(graph).areas
    for area in graph.cell.areas:
        inside = {
            answer.posture: frozenset(arms[link] for link in answer.links if link in arms)
            for answer in answers
            if answer.area == area.name
        }
        if not area.released:
            yield from _taken(graph, area, inside, arms)


def _taken(graph: CellGraph, area: SharedArea, inside: _Inside, arms: Mapping[str, str]) -> Findings:
    place = Related("the area is stated here", area.span)
    reported = set()
    if len(inside.get("", ())) > 1:
        yield found(graph, area.path, _message(area, inside[""], "begin in it"))
        return
    for rehearsal in graph.cell.rehearsals:
        for step, standing in _standing(graph, rehearsal, inside, arms):
            if len(standing) > 1:
                if step.path not in reported:
                    reported.add(step.path)
                    message = _message(area, standing, f"stand in it after `move: {step.name}`")
                    yield found(graph, step.path, message, related=(place,))
                break


def _message(area: SharedArea, standing: frozenset[str], do: str) -> str:
    names = " and ".join(f"`{name}`" for name in sorted(standing))
    return f"area `{area.name}` must be held by one arm at a time, {names} {do}"


def _standing(
    graph: CellGraph, rehearsal: Rehearsal, inside: _Inside, arms: Mapping[str, str]
) -> Iterator[tuple[Step, frozenset[str]]]:
    """Yield each move with the arms that stand in the area after it, each where its own last move took it."""
    last: dict[str, str] = {}
    for step in rehearsal.steps:
        if step.kind == "move":
            last |= dict.fromkeys(_moved(graph, step.name, arms), step.name)
            yield step, frozenset(arm for arm in set(arms.values()) if arm in inside.get(last.get(arm, ""), ()))


def _moved(graph: CellGraph, target: str, arms: Mapping[str, str]) -> set[str]:
    """Return the arms that a pose or a goal moves."""
    cell = graph.cell
    groups = {pose.group for pose in cell.poses if pose.name == target}
    groups |= {goal.group for goal in cell.goals if goal.name == target}
    return {arms[group.base_link] for group in cell.groups if group.name in groups and group.base_link in arms}


def _arms(graph: CellGraph) -> dict[str, str]:
    """Return for each link the device that carries it and is mounted on none: an arm with all that hangs on it."""
    carried = {}
    for device in graph.cell.devices:
        for link in device.description.links:
            devices = [frame.device for frame in graph.frames.chain(link.name) if frame.device is not None]
            carried[link.name] = devices[-1] if devices else device.name
    return carried
