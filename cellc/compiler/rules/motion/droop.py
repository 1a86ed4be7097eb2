"""Rules on joints that a load moves away from their command: against tolerances, goals, and what is below them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.cell.device import Device
from cellc.compiler.feasibility import BodyContact, DroopAnswer, TipAnswer, motion_answer
from cellc.compiler.graph.control_laws import control_laws
from cellc.compiler.rules.geometry import KNOWN_GOALS, in_the_chain, named
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, enters, found, rule
from cellc.compiler.rules.tolerances import stated
from cellc.contract.control_law import ControlLaw
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import TRAJECTORIES, Gravity, Held, Loop

_WEIGHED = (*KNOWN_GOALS, "negative-mass", "payload-above-limit", "refused-impedance", "unit-of-another-joint")


@dataclass(frozen=True, slots=True)
class _Bound:
    """A tolerance of joints, where it is written, and what has it; ``at_rest`` where it counts at the end alone."""

    path: YamlPath
    owner: str
    joints: Mapping[str, float]
    at_rest: bool


def _bounds(graph: CellGraph) -> Iterator[_Bound]:
    """Yield every tolerance that ends a goal of the real target."""
    for controller in graph.cell.controllers:
        for key, figures in stated(controller) if controller.behavior in TRAJECTORIES else ():
            bounds = {joint: figure.value for joint, figure in (figures or {}).items() if figure.value > 0.0}
            yield _Bound((*controller.path, key), controller.name, bounds, key == "goal_tolerance")
    for adapted in graph.cell.adapters:
        path = (*graph.cell.device(adapted.device).path, "adapter", "path_tolerance")
        yield _Bound(path, adapted.device, dict.fromkeys(adapted.joints, adapted.path_tolerance), False)


def _laws(graph: CellGraph) -> dict[str, tuple[Device, ControlLaw]]:
    """Return the law of each joint behind a spring, with its device."""
    laws = control_laws(graph.cell)
    return {joint: (graph.cell.device(name), law) for name, law in laws.items() for joint in law.joints}


@rule(Severity.ERROR, assumes=_WEIGHED)
def droop_beyond_tolerance(graph: CellGraph) -> Findings:
    """Yield tolerances below what some joint is away from its command at rest, each with the worst joint."""
    answer, laws = motion_answer(graph), _laws(graph)
    for bound in _bounds(graph):
        places = answer.droops if bound.at_rest else (*answer.droops, *answer.on_paths)
        beyond = [place for place in places if abs(place.droop) > bound.joints.get(place.joint, abs(place.droop))]
        if not beyond:
            continue
        worst = max(beyond, key=lambda one: abs(one.droop) / bound.joints[one.joint])
        device, law = laws[worst.joint]
        unit, torque = ("m", "N") if device.joint(worst.joint).slides else ("rad", "Nm")
        figure = f"{abs(worst.droop):.3g} {unit} from `{worst.joint}` {_where(worst)}"
        by = f"{abs(worst.effort):.3g} {torque} at {law.joints[worst.joint].stiffness:g} {torque}/{unit}"
        again = ", and each canceled or aborted goal adds as much" if law.held is Held.MEASURED else ""
        written = graph.cell.text(*bound.path) or f"{bound.joints[worst.joint]:g} {unit}"
        message = f"`{bound.path[-1]}` of `{bound.owner}` must be above the droop of its joints, {figure}, {by}{again};"
        related = (Related("the control law of this device applies", graph.cell.locate(*device.path)),)
        yield found(graph, bound.path, f"{message} got {written}", related=related)


def _where(one: DroopAnswer | TipAnswer) -> str:
    loaded = " with a part" if one.holding else ""
    place = f"at the start and `{one.towards}`" if not one.posture else f"`{one.posture}` and `{one.towards}`"
    return f"between {place}{loaded}" if one.towards else f"in `{one.posture}`{loaded}"


@rule(Severity.ERROR, assumes=(*_WEIGHED, "pose-outside-limits"))
def droop_beyond_limits(graph: CellGraph) -> Findings:
    """Yield places in which a joint droops out of its limits, from where no motion is planned."""
    paths = {pose.name: pose.path for pose in graph.cell.poses}
    paths |= {goal.name: (*goal.path, "frame") for goal in graph.cell.goals}
    for droop in motion_answer(graph).outside:
        device, _ = _laws(graph)[droop.joint]
        unit = "m" if device.joint(droop.joint).slides else "rad"
        where = _where(droop) if droop.posture else "where the cell begins"
        how_far = f"`{droop.joint}` droops by {abs(droop.droop):.3g} {unit} {where}"
        message = f"{how_far}, beyond its limits, so MoveIt plans no motion that begins there"
        related = enters(graph, "its stiffness", (*device.path, "impedance"))
        yield found(graph, paths.get(droop.posture, (*device.path, "model")), message, related=related)


@rule(Severity.ERROR, assumes=_WEIGHED)
def tip_droop_beyond_tolerance(graph: CellGraph) -> Findings:
    """Yield goals at which a tip comes to rest farther from its command than it may be from the goal."""
    uncertainty = graph.cell.uncertainty
    tolerances = {} if uncertainty is None else uncertainty.tolerances_m
    groups = {goal.name: goal.group for goal in graph.cell.goals}
    for name, tolerance_m in tolerances.items():
        tips = [tip for tip in motion_answer(graph).tips if (tip.posture, tip.group) == (name, groups.get(name))]
        worst = max(tips, key=lambda tip: tip.distance_m, default=None)
        if worst is not None and worst.distance_m > tolerance_m:
            path = ("uncertainty", "tolerances", name)
            side = "below" if worst.below_m > 0.0 else "above"
            loaded = "with a part" if worst.holding else "empty"
            message = f"the tip comes to rest {worst.distance_m * 1e3:.3g} mm from goal `{name}`, "
            message += f"{abs(worst.below_m) * 1e3:.3g} mm {side} it, {loaded}, but must be within"
            related = (*in_the_chain(graph, name), *_stiffnesses(graph))
            yield found(graph, path, f"{message} {graph.cell.text(*path)}", related=related)


@rule(
    Severity.ERROR, assumes=(*_WEIGHED, "pose-in-self-collision", "pose-in-collision-with-scene", "goal-in-collision")
)
def droop_into_contact(graph: CellGraph) -> Findings:
    """Yield poses, goals and paths between them where something touches because joints are not where they are led."""
    answer = motion_answer(graph)
    paths = {pose.name: pose.path for pose in graph.cell.poses}
    paths |= {goal.name: (*goal.path, "frame") for goal in graph.cell.goals}
    seen: set[tuple[BodyContact, ...]] = set()
    for tip in (*answer.tips, *answer.tips_on_paths):
        if tip.contacts and tip.contacts not in seen:
            seen.add(tip.contacts)
            message = f"{_where(tip)} the arm droops until {named(tip.contacts)},"
            message += f" with its tip {tip.distance_m * 1e3:.3g} mm off its command"
            yield found(graph, paths[tip.towards or tip.posture], message, related=_stiffnesses(graph))


@rule(Severity.BLOCKER)
def unknown_control_law(graph: CellGraph) -> Findings:
    """Yield devices that move on a path while nothing says how far a load moves their joints."""
    adapted = {driven.device for driven in graph.cell.adapters}
    resting = _resting(graph)
    for owner, law in control_laws(graph.cell).items():
        if law.loop is not Loop.UNKNOWN:
            continue
        device = graph.cell.device(owner)
        names = dict.fromkeys(name for joint in device.joints for name in resting.get(joint.name, ()))
        message = f"it is not known how far a load moves the joints of `{owner}`: {law.because}"
        rests = f"; it affects {', '.join(names)}" if names else ""
        yield found(graph, (*device.path, "adapter" if owner in adapted else "model"), message + rests)


def _resting(graph: CellGraph) -> Mapping[str, list[str]]:
    """Return what rests on where a joint is, joint by joint: tolerances of joints, and those of goals."""
    found: dict[str, list[str]] = {}
    for bound in _bounds(graph):
        for joint in bound.joints:
            found.setdefault(joint, []).append(f"`{bound.path[-1]}` of `{bound.owner}`")
    groups = {group.name: group for group in graph.cell.groups}
    judged = {} if graph.cell.uncertainty is None else graph.cell.uncertainty.tolerances_m
    for goal in graph.cell.goals:
        for joint in groups[goal.group].joints if goal.name in judged and goal.group in groups else ():
            found.setdefault(joint, []).append(f"the tolerance of goal `{goal.name}`")
    return found


@rule(Severity.ERROR)
def load_of_nothing(graph: CellGraph) -> Findings:
    """Yield loads to draw that move no joint: the arm has no springs, holds no part, or compensates nothing."""
    laws, stated = control_laws(graph.cell), graph.cell.uncertainty
    for key, loads in () if stated is None else (("part", stated.parts_kg), ("compensation", stated.compensations)):
        for name in loads:
            law = laws.get(name)
            if law is None or not law.joints:
                why = "a device whose joints follow like springs on the real target"
            elif key == "part" and law.part is None:
                why = "a device whose `payload` states more than its tool weighs"
            elif key == "compensation" and law.gravity is not Gravity.COMPENSATED:
                why = "a device whose controller compensates for gravity"
            else:
                continue
            yield found(graph, ("uncertainty", "loads", name, key), f"`{name}` must be {why}; nothing is drawn for it")
    for name in () if stated is None else stated.payloads_kg:
        if graph.cell.device(name).robot.payload is None:
            why = "a device with a `payload`, which tells its controller what it carries"
            yield found(graph, ("uncertainty", "loads", name, "payload"), f"`{name}` must be {why}")


def _stiffnesses(graph: CellGraph) -> tuple[Related, ...]:
    return enters(graph, "a stiffness", *((*device.path, "impedance") for device in graph.cell.devices))
