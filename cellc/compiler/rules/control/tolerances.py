"""Rules on the tolerances of trajectory controllers, and on how a trajectory ends."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from cellc.compiler.cell.control import Controller
from cellc.compiler.cell.device import DeviceJoint
from cellc.compiler.graph.commissioning import chain_of
from cellc.compiler.rules.bounds import Bound, Figure, outside
from cellc.compiler.rules.described import described
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, enters, found, rule, rules
from cellc.compiler.rules.tolerances import stated
from cellc.contract.vocabulary import TRAJECTORIES


@rule(Severity.WARNING, assumes=("unit-of-another-joint",))
def goal_looser_than_path(graph: CellGraph) -> Findings:
    """Yield controllers whose goal tolerance exceeds the path tolerance."""
    for controller in graph.cell.controllers:
        path = controller.path_tolerance or {}
        looser = (
            (goal.value, path[joint].value)
            for joint, goal in (controller.goal_tolerance or {}).items()
            if joint in path and goal.value > path[joint].value > 0.0
        )
        for goal, way in dict.fromkeys(looser):
            message = f"`goal_tolerance` of `{controller.name}` must be at most its `path_tolerance`"
            related = enters(graph, "the one of the path", (*controller.path, "path_tolerance"))
            yield found(
                graph, (*controller.path, "goal_tolerance"), f"{message} of {way:g}, got {goal:g}", related=related
            )


@rule(Severity.ERROR)
def missing_goal_time(graph: CellGraph) -> Findings:
    """Yield trajectory controllers without the value, and with zero, which switches the check off."""
    for controller in graph.cell.controllers:
        if controller.behavior not in TRAJECTORIES:
            continue
        if not controller.goal_time_s:
            unstated = controller.goal_time_s is None
            path = controller.path if unstated else (*controller.path, "goal_time")
            message = f"`{controller.name}` does not state `goal_time`"
            if not unstated:
                message = f"`goal_time` of `{controller.name}` must be above zero; zero switches the check off"
            yield found(graph, path, message)


def _unwatched_joints(graph: CellGraph, key: str) -> Findings:
    """Yield trajectory controllers that state no tolerance, or none for some joint, or zero, which is no check."""
    for controller in graph.cell.controllers:
        if controller.behavior not in TRAJECTORIES:
            continue
        figures = dict(stated(controller))[key]
        if figures is None:
            yield found(graph, controller.path, f"`{controller.name}` does not state `{key}`")
            continue
        path = (*controller.path, key)
        untold = [joint for joint in controller.joints if joint not in figures]
        if untold:
            yield found(graph, path, f"`{key}` of `{controller.name}` states nothing for `{untold[0]}`")
        elif not all(figure.value for figure in figures.values()):
            message = f"`{key}` of `{controller.name}` must be above zero; zero switches the check off"
            yield found(graph, path, message)


UNWATCHED = rules(
    Severity.ERROR,
    _unwatched_joints,
    {"missing-goal-tolerance": "goal_tolerance", "missing-path-tolerance": "path_tolerance"},
)


_MOVING_END = "allow_nonzero_velocity_at_trajectory_end"


@rule(Severity.WARNING)
def moving_trajectory_end(graph: CellGraph) -> Findings:
    """Yield trajectory controllers that accept such trajectories."""
    for controller in graph.cell.controllers:
        if controller.behavior in TRAJECTORIES and controller.written_parameters.get(_MOVING_END) is True:
            message = f"trajectories of `{controller.name}` must end at rest, but it takes those that do not"
            yield found(graph, (*controller.path, "parameters", _MOVING_END), message)


@rule(Severity.ERROR, assumes=("parameter-out-of-range",))
def negative_tolerance(graph: CellGraph) -> Findings:
    """Yield tolerances and constraints of controllers that are negative."""
    for controller in graph.cell.controllers:
        least: dict[YamlPath, float] = {
            (key,): min(figure.value for figure in figures.values()) for key, figures in stated(controller) if figures
        }
        for name, value in controller.written_parameters.items():
            watched = "tolerance" in name or name.startswith("constraints.")
            if watched and isinstance(value, int | float):
                least["parameters", name] = value
        for at, value in least.items():
            if value < 0:
                path = (*controller.path, *at)
                text = graph.cell.text(*path) or f"{value:g}"
                yield found(graph, path, f"`{at[-1]}` of `{controller.name}` must be above zero, got {text}")


_SHARE_OF_RANGE = 0.5
_WIDEST_RAD = 1.0


@rule(Severity.ERROR, assumes=("unit-of-another-joint",))
def path_tolerance_without_effect(graph: CellGraph) -> Findings:
    """Yield trajectory controllers whose tolerance exceeds half of a joint's range, or 1 rad."""
    joints = graph.cell.joints_by_name
    for controller in graph.cell.controllers:
        if controller.behavior not in TRAJECTORIES or controller.path_tolerance is None:
            continue
        bounds = _bounds(joints, controller)
        wide = [
            (bounds[name], name)
            for name, tolerance in controller.path_tolerance.items()
            if tolerance.value > bounds[name]
        ]
        if wide:
            widest, joint = min(wide)
            path = (*controller.path, "path_tolerance")
            text = graph.cell.text(*path) or f"{controller.path_tolerance[joint].value:g}"
            message = f"`path_tolerance` of `{controller.name}` must be at most {widest:.3g} rad or m, half of"
            message += f" what `{joint}` moves or 1 rad, got {text}"
            yield found(graph, path, message, related=described(graph, [joint]))


def _bounds(joints: Mapping[str, DeviceJoint], controller: Controller) -> dict[str, float]:
    """Return the widest tolerance of each joint in rad or m; no bound where a joint has no limits."""
    bounds = dict.fromkeys(controller.joints, math.inf)
    for joint in (joints[name] for name in bounds if name in joints):
        if joint.lower is not None and joint.upper is not None:
            bound = _SHARE_OF_RANGE * (joint.upper - joint.lower)
            bounds[joint.name] = bound if joint.slides else min(bound, _WIDEST_RAD)
    return bounds


_HELD = 1e-4
"""Rad or m: a tenth of a millimeter at a meter, about what industrial arms repeat."""


@rule(Severity.WARNING, assumes=("unit-of-another-joint",))
def unmeetable_tolerance(graph: CellGraph) -> Findings:
    """Yield path tolerances below one update at full speed, and goal tolerances below what arms repeat."""
    speeds = {joint.name: joint.velocity or 0.0 for device in graph.cell.devices for joint in device.joints}
    for manager in graph.cell.managers:
        for controller in manager.controllers:
            if controller.behavior not in TRAJECTORIES:
                continue
            for key, bound, why in _unmet(speeds, controller, manager.update_rate_hz):
                path = (*controller.path, key)
                message = f"`{key}` of `{controller.name}` must be at least {bound:.2g} rad or m, {why},"
                limits = ((*device.path, "limits", "velocity") for device in graph.cell.devices)
                bounds = ((*manager.path, "update_rate"), *limits) if key == "path_tolerance" else ()
                related = enters(graph, "the bound follows from it", *bounds)
                yield found(graph, path, f"{message} got {graph.cell.text(*path) or 'less'}", related=related)


def _unmet(speeds: Mapping[str, float], controller: Controller, rate_hz: float) -> Iterator[tuple[str, float, str]]:
    """Yield each key whose figure is too small for some joint, with the largest bound of those joints, and why."""
    for key, figures in stated(controller):
        bounds = {joint: speeds.get(joint, 0.0) / rate_hz if rate_hz else 0.0 for joint in figures or {}}
        bounds = bounds if key == "path_tolerance" else dict.fromkeys(bounds, _HELD)
        missed = [bounds[joint] for joint, figure in (figures or {}).items() if 0.0 < figure.value < bounds[joint]]
        if missed:
            yield key, max(missed), "one update at full speed" if key == "path_tolerance" else "what arms repeat"


_TIMES_ALLOWED, _MISSED_M = 10.0, 0.3
"""At rest joints are far within their tolerances, and seldom all to one side."""


def _misses(graph: CellGraph) -> Iterator[Figure]:
    """Yield how far the tip of a group can be from its goal with one joint at its goal tolerance."""
    uncertainty = graph.cell.uncertainty
    allowed = {} if uncertainty is None else uncertainty.tolerances_m
    goals: dict[str, dict[str, float]] = {}
    for goal in graph.cell.goals:
        if goal.name in allowed:
            goals.setdefault(goal.group, {})[goal.name] = allowed[goal.name]
    for group in graph.cell.groups:
        own = goals.get(group.name, {})
        loosest = max(own, key=lambda name: own[name], default="")
        most = _TIMES_ALLOWED * own[loosest] if own else _MISSED_M
        because = f"ten times the tolerance of goal `{loosest}`" if own else ""
        places: list[YamlPath] = [("uncertainty", "tolerances", loosest)] if own else []
        places += [frame.path for frame in graph.frames.chain(group.tip_frame)[:1] if graph.cell.states(*frame.path)]
        related = tuple(Related("the tip may be so far from it", graph.cell.locate(*place)) for place in places)
        arms = chain_of(graph, group).arms
        watching = {place for joint in arms for place in graph.once(_watching).get(joint, ())}
        for controller in (graph.cell.controllers[place] for place in sorted(watching)):
            figures = controller.goal_tolerance or {}
            ways = {name: figures[name].value * arms[name] for name in arms if name in figures}
            if ways:
                path = (*controller.path, "goal_tolerance")
                yield Figure(path, max(ways.values()), most=most, because=because, related=related)


def _watching(graph: CellGraph) -> Mapping[str, Sequence[int]]:
    """Return the trajectory controllers with a goal tolerance for each joint, by their place among all."""
    watching: dict[str, list[int]] = {}
    for place, controller in enumerate(graph.cell.controllers):
        for joint in (controller.goal_tolerance or {}) if controller.behavior in TRAJECTORIES else ():
            watching.setdefault(joint, []).append(place)
    return watching


def _of_adapters(graph: CellGraph) -> Iterator[Figure]:
    for device in graph.cell.devices:
        adapter = device.control.adapter
        if adapter is not None and adapter.path_tolerance is not None:
            tolerance, path = adapter.path_tolerance, (*device.path, "adapter", "path_tolerance")
            yield Figure(path, tolerance.value, _HELD, _WIDEST_RAD, unit="m" if tolerance.linear else "rad")


_LEFT_RAD, _LEFT_M = 0.4, 0.1
"""Twice what vendors allow on the way, and as much for a slide."""


def _departures(graph: CellGraph) -> Iterator[Figure]:
    """Yield by how much a joint may leave its path."""
    joints = graph.cell.joints_by_name
    for controller in graph.cell.controllers:
        if controller.behavior not in TRAJECTORIES:
            continue
        for name, figure in (controller.path_tolerance or {}).items():
            slides = name in joints and joints[name].slides
            path = (*controller.path, "path_tolerance")
            yield Figure(path, figure.value, most=_LEFT_M if slides else _LEFT_RAD, unit="m" if slides else "rad")


_PLACES = ("control.controllers.*", "managers.*.controllers.*")
BOUNDS = (
    Bound(
        tuple(f"{place}.goal_tolerance{by}" for place in _PLACES for by in ("", ".*")),
        "the way of the tip that still counts as its goal",
        "mm",
        "the size of a part",
        _misses,
    ),
    Bound(
        tuple(f"{place}.path_tolerance{by}" for place in _PLACES for by in ("", ".*")),
        "`path_tolerance`",
        "rad",
        "at which an arm is still on its path",
        _departures,
    ),
    Bound(("devices.*.adapter.path_tolerance",), "`path_tolerance`", "rad", "what a path may be left by", _of_adapters),
)


@rule(Severity.WARNING, assumes=("unit-of-another-joint", "group-without-joints", "frame-cycle"), gives_way=True)
def implausible_tolerance(graph: CellGraph) -> Findings:
    """Yield tolerances of joints that let the tip be anywhere."""
    yield from outside(graph, BOUNDS)
