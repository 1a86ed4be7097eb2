"""The parts of a cell whose robots cannot reach each other: each a cell by itself, and what is known of all together.

A part has its devices, the things in their reach, what these hang on, and the groups, poses, goals, areas and steps of
rehearsals that concern it. What is asked of a cell is asked of each part; pairs of links in two parts are no pairs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain
from typing import TypeVar

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.cell.motion import Rehearsal, Step
from cellc.compiler.feasibility.answers import (
    BodyContact,
    DisabledAnswer,
    MotionAnswer,
    PoseAnswer,
    ViewAnswer,
)
from cellc.compiler.feasibility.question import views
from cellc.compiler.feasibility.reach import Part, owners, reach_of
from cellc.compiler.graph.cell_graph import CellGraph

_Thing = TypeVar("_Thing")


def parts_of(graph: CellGraph) -> tuple[CellGraph, ...]:
    """Return the parts of a cell as cells, in the order of its devices; the cell itself where that is its one part."""
    return graph.once(_parts)


def _parts(graph: CellGraph) -> tuple[CellGraph, ...]:
    parts = graph.once(reach_of).parts
    if len(parts) < 2:
        return (graph,)
    cut = graph.once(_Cut)
    return tuple(CellGraph(cut.alone(part)) for part in parts)


def parts_by_name(graph: CellGraph) -> tuple[tuple[str, ...], ...]:
    """Return the devices and things of each part, by name; none where all is one part."""
    parts = graph.once(reach_of).parts
    return tuple(tuple(sorted(part.members)) for part in parts) if len(parts) > 1 else ()


def part_with(graph: CellGraph, devices: Iterable[str]) -> Cell:
    """Return a cell with some devices and the parts that they are in: all of it where that is one part."""
    parts, asked = graph.once(reach_of).parts, frozenset(devices)
    if len(parts) < 2:
        return graph.cell
    concerned = [part for part in parts if not asked.isdisjoint(part.movers)]
    members = asked.union(*(part.members for part in concerned))
    movers = frozenset[str]().union(*(part.movers for part in concerned))
    return graph.once(_Cut).alone(Part(members, movers, frozenset()))


def standing_part(graph: CellGraph) -> CellGraph:
    """Return the cell of what is fixed and near to other fixed things, and is in no part with them."""
    cut, owned = graph.once(_Cut), graph.once(owners)
    links = {link for pair in graph.once(reach_of).standing for link in pair}
    return CellGraph(cut.alone(Part(frozenset(owned[link].name for link in links), frozenset(), frozenset())))


class _Cut:
    """A cell, sorted by what its parts need of it."""

    def __init__(self, graph: CellGraph) -> None:
        cell, self._graph = graph.cell, graph
        parts = graph.once(reach_of).parts
        self._owners = graph.once(owners)
        self._part_of = {name: part for part in parts for name in part.movers}
        self._orders = {frame.name: place for place, frame in enumerate(cell.frames)}
        self._devices = {device.name: place for place, device in enumerate(cell.devices)}
        self._scene = {solid.name: place for place, solid in enumerate(cell.scene)}
        self._frames = _sorted(cell.frames, lambda frame: self._owners[frame.name].name)
        groups = {
            group.name: self._part_of[cell.holders[joint]]
            for group in cell.groups
            for joint in group.joints[:1]
            if cell.holders.get(joint) in self._part_of
        }
        self._groups = _sorted(cell.groups, lambda group: groups.get(group.name))
        self._poses = _sorted(cell.poses, lambda pose: groups.get(pose.group))
        self._goals = _sorted(cell.goals, lambda goal: groups.get(goal.group))
        self._steps = _steps_of(cell, self._concerned(cell, groups))

    def _concerned(self, cell: Cell, groups: Mapping[str, Part]) -> Mapping[str, tuple[Part, ...]]:
        """Return the parts that a name in a step means: of a pose, a goal, a device or a frame."""
        found: dict[str, dict[Part, None]] = {}
        named = [(pose.name, groups.get(pose.group)) for pose in cell.poses]
        named += [(goal.name, groups.get(goal.group)) for goal in cell.goals]
        named += [(name, part) for name, part in self._part_of.items()]
        named += [(name, self._part_of.get(owner.name)) for name, owner in self._owners.items()]
        for name, part in named:
            if part is not None:
                found.setdefault(name, {})[part] = None
        return {name: tuple(parts) for name, parts in found.items()}

    def alone(self, part: Part) -> Cell:
        """Return the cell that one part is."""
        cell = self._graph.cell
        goals = tuple(self._goals.get(part, ()))
        rehearsals = tuple(self._steps.get(part, ()))
        areas = tuple(area for area in cell.areas if area.name in part.areas) if part.areas else ()
        needed = [goal.frame for goal in goals] + [area.parent for area in areas]
        needed += [step.name for rehearsal in rehearsals for step in rehearsal.steps if step.kind == "detect"]
        members, frames = self._with_carriers(part, needed)
        return replace(
            cell,
            devices=tuple(
                cell.devices[at] for at in sorted(self._devices[name] for name in members & self._devices.keys())
            ),
            scene=tuple(cell.scene[at] for at in sorted(self._scene[name] for name in members & self._scene.keys())),
            frames=tuple(cell.frames[at] for at in sorted(self._orders[name] for name in frames)),
            areas=areas,
            groups=tuple(self._groups.get(part, ())),
            poses=tuple(self._poses.get(part, ())),
            goals=goals,
            rehearsals=rehearsals,
        )

    def _with_carriers(self, part: Part, needed: Iterable[str]) -> tuple[set[str], set[str]]:
        """Return what a part has, and its frames, with all that they hang on."""
        members, frames, waiting = set[str](), set[str](), list(needed)
        for name in part.members:
            waiting += self._own_frames(name, moves=name in part.movers)
        while waiting:
            name = waiting.pop()
            frame = self._graph.frames.get(name)
            if frame is None or name in frames:
                continue
            frames.add(name)
            waiting += [frame.parent] + ([] if frame.simulated_pose is None else [frame.simulated_pose.parent])
            owner = self._owners[name].name
            if owner and owner not in members:
                members.add(owner)
                waiting += self._own_frames(owner, moves=owner in part.movers)
        return members, frames

    def _own_frames(self, owner: str, *, moves: bool) -> Iterator[str]:
        """Yield the frames of a device or a thing; those that people fixed to a thing at rest are fetched as needed."""
        for frame in self._frames.get(owner, ()):
            if moves or frame.kind in (FrameKind.LINK, FrameKind.MOUNT, FrameKind.SCENE):
                yield frame.name


def _sorted(things: Iterable[_Thing], key: Callable[[_Thing], object]) -> dict[object, list[_Thing]]:
    found: dict[object, list[_Thing]] = {}
    for thing in things:
        found.setdefault(key(thing), []).append(thing)
    return found


def _steps_of(cell: Cell, concerned: Mapping[str, tuple[Part, ...]]) -> Mapping[Part, list[Rehearsal]]:
    """Return the rehearsals of each part, with the steps that concern it."""
    found: dict[Part, list[Rehearsal]] = {}
    for rehearsal in cell.rehearsals:
        steps: dict[Part, list[Step]] = {}
        for step in rehearsal.steps:
            for part in concerned.get(step.name, ()):
                steps.setdefault(part, []).append(step)
        for part, own in steps.items():
            found.setdefault(part, []).append(replace(rehearsal, steps=tuple(own)))
    return found


def together(graph: CellGraph, answers: Sequence[MotionAnswer], standing: DisabledAnswer) -> MotionAnswer:
    """Return what all parts and the fixed things beside them say of the cell; one may refuse for all."""
    refused = [(answer.refused, answer.limit) for answer in answers if answer.refused]
    refused += [(standing.refused, standing.limit)] if standing.refused else []
    if refused:
        return MotionAnswer(refused=refused[0][0], limit=refused[0][1])
    cell = graph.cell
    goals = {goal.name: goal for answer in answers for goal in answer.goals}
    held = {holding.joint: holding for answer in answers for holding in answer.holding}
    return MotionAnswer(
        start=_contacts(contact for answer in answers for contact in answer.start),
        poses=tuple(_poses(cell, answers)),
        goals=tuple(goals[goal.name] for goal in cell.goals if goal.name in goals),
        views=tuple(_views(graph, answers)),
        rigid=_contacts(chain(*(answer.rigid for answer in answers), _touching(standing))),
        holding=tuple(held.values()),
        areas=tuple(chain.from_iterable(answer.areas for answer in answers)),
        droops=tuple(chain.from_iterable(answer.droops for answer in answers)),
        on_paths=tuple(chain.from_iterable(answer.on_paths for answer in answers)),
        outside=tuple(chain.from_iterable(answer.outside for answer in answers)),
        tips=tuple(chain.from_iterable(answer.tips for answer in answers)),
        tips_on_paths=tuple(chain.from_iterable(answer.tips_on_paths for answer in answers)),
    )


def _touching(standing: DisabledAnswer) -> Iterator[BodyContact]:
    return (BodyContact(pair.first, pair.second) for pair in standing.pairs if pair.reason == "always")


def _contacts(contacts: Iterable[BodyContact]) -> tuple[BodyContact, ...]:
    return tuple(sorted(set(contacts), key=lambda contact: (contact.first, contact.second)))


def _poses(cell: Cell, answers: Sequence[MotionAnswer]) -> Iterator[PoseAnswer]:
    """Yield each pose of the cell: a part that it does not move is where it begins."""
    known: dict[str, dict[int, PoseAnswer]] = {}
    for number, answer in enumerate(answers):
        for pose in answer.poses:
            known.setdefault(pose.name, {})[number] = pose
    begin = {number: answer.start for number, answer in enumerate(answers) if answer.start}
    for name in dict.fromkeys(pose.name for pose in cell.poses):
        moved = known.get(name, {})
        contacts = chain.from_iterable(pose.contacts for pose in moved.values())
        others = chain.from_iterable(start for number, start in begin.items() if number not in moved)
        yield PoseAnswer(
            name, _contacts((*contacts, *others)), tuple(chain.from_iterable(pose.least for pose in moved.values()))
        )


def _views(graph: CellGraph, answers: Sequence[MotionAnswer]) -> Iterator[ViewAnswer]:
    """Yield what cameras see: a fixed one sees it wherever robots are, and belongs to no part."""
    for view in views(graph):
        camera = graph.frames.in_world(view.camera_frame)
        if camera is not None:
            place = (camera.inverse() @ view.place).position
            yield ViewAnswer(view.name, view.camera_frame, view.posture, place)
    for seen in chain.from_iterable(answer.views for answer in answers):
        if graph.frames.in_world(seen.camera_frame) is None:
            yield seen


def pairs_together(answers: Sequence[DisabledAnswer], standing: DisabledAnswer) -> DisabledAnswer:
    """Return the pairs of all parts, and of fixed things beside them; samples are those of the part with the fewest."""
    refused = [answer for answer in (*answers, standing) if answer.refused][:1]
    pairs = {pair for answer in (*answers, standing) for pair in answer.pairs}
    samples = min(answer.samples for answer in answers)
    return DisabledAnswer(tuple(sorted(pairs)), samples, *((refused[0].refused, refused[0].limit) if refused else ()))
