"""Binds planning groups to their joint chains, poses to joints, and goals to frames."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.compiler.cell.control import Controller
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.frame import Frame
from cellc.compiler.cell.motion import CartesianGoal, NamedPose, PlanningGroup
from cellc.compiler.link.frames import FrameNames
from cellc.compiler.link.hopeless import until_hopeless
from cellc.compiler.link.names import unknown_name
from cellc.compiler.link.planners import link_solver
from cellc.compiler.link.quantities import pose, vector
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, YamlPath
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import Distro


@dataclass(frozen=True, slots=True)
class Machine:
    """What motion refers to: the devices and controllers of the cell, and its frames by name.

    ``placed``: all devices and frames have their parent; otherwise the cause of a broken chain is already reported.
    """

    devices: tuple[Device, ...]
    controllers: tuple[Controller, ...]
    frames: tuple[Frame, ...]
    names: FrameNames
    placed: bool


def link_groups(
    spec: CellSpec, document: SourceDocument, distro: Distro, machine: Machine
) -> Outcome[tuple[PlanningGroup, ...]]:
    """Bind each group to the movable joints between its base link and its tip, base first."""
    names, frames = machine.names, machine.frames
    groups: list[PlanningGroup] = []
    problems: list[Diagnostic] = []
    joint_of_link = {
        joint.child: joint for device in machine.devices for joint in device.body.description.joints if joint.movable
    }
    parents = {frame.name: frame.parent for frame in frames}
    for name, group in until_hopeless(spec.motion.groups.items(), problems):
        path = ("motion", "groups", name)
        base, tip = names.bind(group.base, (*path, "base")), names.bind(group.tip, (*path, "tip"))
        solver = link_solver(name, group, document, distro)
        problems += [*base.diagnostics, *tip.diagnostics, *solver.diagnostics]
        if base.value is None or tip.value is None or solver.value is None:
            continue
        links = _chain(parents, base.value, tip.value)
        if links is None:
            circle = _circle(frames, tip.value)
            if machine.placed or circle is not None:
                problems.append(_not_a_chain(name, group.base, group.tip, document, circle))
            continue
        joints = tuple(joint_of_link[link].name for link in links if link in joint_of_link)
        groups.append(
            PlanningGroup(
                name=name,
                path=path,
                span=document.locate(path),
                base_link=base.value,
                tip_frame=tip.value,
                joints=joints,
                controllers=tuple(c.label for c in machine.controllers if c.action and set(c.joints) & set(joints)),
                solver=solver.value,
                planner=group.planner,
            )
        )
    return Outcome(tuple(groups), tuple(problems))


def link_poses(
    spec: CellSpec, document: SourceDocument, groups: tuple[PlanningGroup, ...]
) -> Outcome[tuple[NamedPose, ...]]:
    """Bind named poses to the joints of their groups; a wrong number of values is left to a rule."""
    poses: list[NamedPose] = []
    problems: list[Diagnostic] = []
    joints = {group.name: group.joints for group in groups}
    for name, by_group in until_hopeless(spec.motion.poses.items(), problems):
        for group, positions in by_group.items():
            path = ("motion", "poses", name, group)
            if group not in spec.motion.groups:
                problems.append(_unknown_group(group, spec, document, path))
            elif group in joints:
                poses.append(
                    NamedPose(
                        name=name,
                        path=path,
                        span=document.locate(path),
                        group=group,
                        joints=joints[group],
                        positions=positions.si,
                        linear=positions.linear,
                    )
                )
    return Outcome(tuple(poses), tuple(problems))


def link_goals(
    spec: CellSpec, document: SourceDocument, groups: tuple[PlanningGroup, ...], names: FrameNames
) -> Outcome[tuple[CartesianGoal, ...]]:
    """Bind goals to their frame and group; the only group of a cell is the default."""
    goals: list[CartesianGoal] = []
    problems: list[Diagnostic] = []
    for name, goal in until_hopeless(spec.motion.goals.items(), problems):
        path = ("motion", "goals", name)
        frame = names.bind(goal.frame, (*path, "frame"))
        problems += frame.diagnostics
        group = goal.group or (next(iter(spec.motion.groups)) if len(spec.motion.groups) == 1 else None)
        if group is None:
            problems.append(_without_group(name, spec, document, path))
        elif group not in spec.motion.groups:
            problems.append(_unknown_group(group, spec, document, (*path, "group")))
        elif frame.value is not None:
            goals.append(
                CartesianGoal(
                    name=name,
                    path=path,
                    span=document.locate(path),
                    group=group,
                    frame=frame.value,
                    transform_tip_to_frame=pose(goal.xyz, goal.rpy),
                    approach=None if goal.approach is None else vector(goal.approach),
                    transform_at=goal.transform_at,
                )
            )
    return Outcome(tuple(goals), tuple(problems))


def _chain(parents: Mapping[str, str], base: str, tip: str) -> tuple[str, ...] | None:
    """Return the frames after ``base`` up to ``tip``, or None where ``tip`` does not hang on ``base``."""
    links: list[str] = []
    frame = tip
    while frame != base:
        if frame not in parents or frame in links:
            return None
        links.append(frame)
        frame = parents[frame]
    return tuple(reversed(links))


def _circle(frames: tuple[Frame, ...], tip: str) -> Frame | None:
    """Return the frame at which the way up from a tip comes round again, or None where it ends."""
    by_name = {frame.name: frame for frame in frames}
    seen: set[str] = set()
    frame = by_name.get(tip)
    while frame is not None and frame.name not in seen:
        seen.add(frame.name)
        frame = by_name.get(frame.parent)
    return frame


def _not_a_chain(name: str, base: str, tip: str, document: SourceDocument, circle: Frame | None) -> Diagnostic:
    """Report the tip, or the frame on its way that hangs on itself, which is then the cause."""
    path: YamlPath = ("motion", "groups", name, "tip") if circle is None else (*circle.path, "parent")
    reason = f"`{tip}` is not attached to `{base}`" if circle is None else f"`{circle.name}` is its own ancestor"
    return Diagnostic(
        code="not-a-chain",
        severity=Severity.ERROR,
        message=f"{reason}: group `{name}` has no chain of joints",
        span=document.locate(path),
        yaml_path=path,
        help="name a tip whose parents lead to the base link" if circle is None else "name another parent",
    )


def _unknown_group(name: str, spec: CellSpec, document: SourceDocument, path: tuple[str, ...]) -> Diagnostic:
    return unknown_name("unknown-group", name, "group", spec.motion.groups, document, path)


def _without_group(goal: str, spec: CellSpec, document: SourceDocument, path: tuple[str, ...]) -> Diagnostic:
    groups, declare = list(spec.motion.groups), "declare one in `motion.groups`"
    return Diagnostic(
        code="unknown-group",
        severity=Severity.ERROR,
        message=f"goal `{goal}` must name its group: the cell has {len(groups) or 'none'}",
        span=document.locate(path),
        yaml_path=path,
        help=f"write `group:` with one of {', '.join(f'`{group}`' for group in groups)}" if groups else declare,
    )
