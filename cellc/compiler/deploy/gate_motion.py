"""Lines of the gates about motion: the first one of a joint, what is released, who could move it, and cancels."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller
from cellc.compiler.cell.site import FirstMotion
from cellc.compiler.cell.vendor import SpeedControl
from cellc.compiler.deploy.bringup import phases, planned, releases
from cellc.compiler.deploy.enabling import enabled_early
from cellc.compiler.deploy.files import stage_files
from cellc.compiler.deploy.first_goal import first_goals
from cellc.compiler.deploy.processes import motion_clients, past_controllers
from cellc.compiler.deploy.releases import GOAL, Release, move_real, moved_by_activation, release_once, restart_of
from cellc.compiler.formats.escape import shell_word
from cellc.compiler.formats.numbers import decimal, shortest
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.vocabulary import BringUpPhase, Feature, InterfaceKind, features

Values = tuple[str, ...]


def sentences(does: str) -> str:
    """Return what a vendor's text separates by semicolons as sentences, without the last full stop."""
    first, *others = does.split("; ")
    return ". ".join((first, *(other[:1].upper() + other[1:] for other in others)))


def first_motion(graph: CellGraph) -> Iterator[Values]:
    """Yield the first motions as the spec has them."""
    return (_first_motion(graph, first) for first in graph.cell.bringup.first_motions)


def jogged(graph: CellGraph) -> Iterator[Values]:
    """Yield the first motions of robots whose driver reads on while a person moves them."""
    firsts = graph.cell.bringup.first_motions
    return (_first_motion(graph, first) for first in firsts if graph.cell.device(first.device).procedures.driver_runs)


def jogging(graph: CellGraph) -> Iterator[Values]:
    """Yield one empty row where any robot is recorded while a person moves it."""
    return iter(((),) if any(jogged(graph)) else ())


def guided(graph: CellGraph) -> Iterator[Values]:
    """Yield the first motions of robots whose driver or adapter cannot run meanwhile, with how people move them."""
    for first in _guided(graph):
        yield *_first_motion(graph, first), graph.cell.device(first.device).procedures.jog or ""


def guiding(graph: CellGraph) -> Iterator[Values]:
    """Yield what people do before and after they move such robots, all in one stop of the cell."""
    procedures = [graph.cell.device(first.device).procedures for first in _guided(graph)]
    if procedures:
        begins = dict.fromkeys(each.jog_begins for each in procedures if each.jog_begins)
        ends = dict.fromkeys(each.jog_ends for each in procedures if each.jog_ends)
        yield " ".join(begins), " ".join((*ends, f"Start the cell again {restart_of(graph.cell)}."))


def guided_back(graph: CellGraph) -> Iterator[Values]:
    """Yield the guided joints that are still where people left them once the driver has started again."""
    activated = {name for name, _ in moved_by_activation(graph.cell)}
    return (_first_motion(graph, first) for first in _guided(graph) if first.device not in activated)


def driven_back(graph: CellGraph) -> Iterator[Values]:
    """Yield the guided joints that the activation of their hardware has moved since."""
    activated = {name for name, _ in moved_by_activation(graph.cell)}
    return (_first_motion(graph, first) for first in _guided(graph) if first.device in activated)


def _guided(graph: CellGraph) -> Iterator[FirstMotion]:
    for first in graph.cell.bringup.first_motions:
        procedures = graph.cell.device(first.device).procedures
        if procedures.jog is not None and not procedures.driver_runs:
            yield first


def stated_jogs(graph: CellGraph) -> Iterator[Values]:
    """Yield how the vendors have people jog the robots whose driver reads on."""
    for first in graph.cell.bringup.first_motions:
        procedures = graph.cell.device(first.device).procedures
        if procedures.jog is not None and procedures.driver_runs:
            yield first.device, procedures.jog


def unstated_jogs(graph: CellGraph) -> Iterator[Values]:
    """Yield the robots of first motions of which no source says how people jog them."""
    firsts = graph.cell.bringup.first_motions
    return ((first.device,) for first in firsts if graph.cell.device(first.device).procedures.jog is None)


def _first_motion(graph: CellGraph, first: FirstMotion) -> Values:
    texts = (graph.cell.text(*first.path, part) for part in ("max_delta", "velocity", "timeout"))
    figure = f"{shortest(round(first.max_delta.value, 4))} {'m' if first.max_delta.linear else 'rad'}"
    joints = graph.cell.device(first.device).joints
    name = next((joint.name for joint in joints if joint.local_name == first.local_joint), first.local_joint)
    return first.name, first.direction, *texts, name, figure


def small_goal(graph: CellGraph) -> Iterator[Values]:
    """Yield the first motions with the commands that send them as goals, and as one that is canceled halfway."""
    goals = {goal.moves[0]: goal for goal in first_goals(graph.cell)}
    for first in graph.cell.bringup.first_motions:
        about = _first_motion(graph, first)
        goal = goals.get(about[5])
        command = "" if goal is None else f'{release_once(graph.cell, GOAL, goal.release)} evidence:="$E"'
        sent = [] if goal is None else [f"{command} joint:={shell_word(joint)}" for joint in goal.moves]
        control = graph.cell.device(first.device).procedures.speed_control
        slow = f" and the {control.name} at {speed_of(control)}" if control is not None and control.name else ""
        bound = "" if goal is None else _holds_within(graph.cell, goal.action)
        yield *about, slow, bound, "\n".join(sent), "".join(f"{line} then:=cancel" for line in sent[:1])


def _holds_within(cell: Cell, action: str) -> str:
    """Return how soon a cancel of an action must hold, as the spec says; empty where it does not."""
    bounds = (each.cancel_within_s for each in cell.interfaces if each.name == action)
    bound = next((each for each in bounds if each is not None), None)
    return "" if bound is None else f" It must be at most {shortest(bound)} s."


def speed_of(control: SpeedControl) -> str:
    """Return what people set for the first motions."""
    return f"{shortest(100.0 * control.low)} %"


def authorized_motion(graph: CellGraph) -> Iterator[Values]:
    """Yield the commands that start motion clients, and what slows the robots down meanwhile: each said once."""
    controls = ((device.name, device.procedures.speed_control) for device in graph.cell.devices)
    named = (f"the {one.name} of {name} at {speed_of(one)}" for name, one in controls if one is not None and one.name)
    slow = " and ".join(named)
    for number, (where, command) in enumerate(move_real(graph.cell)):
        yield where, command, slow and (", with every robot still at that speed" if number else f", with {slow}")


def gripper_goals(graph: CellGraph) -> Iterator[Values]:
    """Yield goals that close each gripper halfway and open it, with the least force where its action has one.

    Some activations leave the fingers open: a first goal to open them would move nothing.
    """
    for device in graph.cell.devices:
        gripper = device.gripper
        for owner in graph.cell.controllers if gripper is not None else ():
            served = _served(owner)
            if gripper is None or served is None or gripper.joint not in owner.joints:
                continue
            least = gripper.grip_force if gripper.min_force is None else gripper.min_force
            carries = least is not None and "Parallel" not in served[1]
            own = "State no force. The driver then uses its own."
            said = f"Set max_effort to {shortest(least or 0.0)} N." if carries else own
            unit = "m" if device.joint(gripper.joint).slides else "rad"
            stroke = gripper.closed - gripper.open
            half, wide = (round(gripper.open + share * stroke, 6) for share in (0.5, 0.1))
            yield device.name, served[0], f"{decimal(half)} {unit}", f"{decimal(wide)} {unit}", said


def _served(owner: Controller) -> tuple[str, str] | None:
    """Return action and type of what takes the goals of a controller on the real target; None where nothing does."""
    if owner.stand_in is not None:
        return owner.stand_in.action, owner.stand_in.action_type
    return None if owner.action is None or owner.action_type is None else (owner.action, owner.action_type)


def senders(graph: CellGraph) -> Iterator[Values]:
    """Yield who sends goals."""
    return ((node.full_name,) for node in motion_clients(graph.cell))


def missing_first_motion(graph: CellGraph) -> Iterator[Values]:
    """Yield one empty row where no first motion is stated."""
    return iter(() if graph.cell.bringup.first_motions else ((),))


def stop_reasons(graph: CellGraph) -> Iterator[Values]:
    """Yield what ends a first motion."""
    reasons = dict.fromkeys(reason for first in graph.cell.bringup.first_motions for reason in first.stop_if)
    return ((reason,) for reason in reasons)


def released(graph: CellGraph, release: Release, phase: BringUpPhase) -> Iterator[Values]:
    """Yield the command of a release, where the real target has a step in its phase: one for each of its devices."""
    plan = graph.once(planned)
    if phase in phases(plan, "real"):
        for device in releases(plan, phase) or ("",):
            yield f"{device}: " if device else "", release_once(graph.cell, release, device)


def first_stage(graph: CellGraph) -> Iterator[Values]:
    """Yield the stage of commissioning in which the cell starts on real hardware."""
    return iter(_stages(graph)[:1])


def later_stages(graph: CellGraph) -> Iterator[Values]:
    """Yield the stages after it, with the gate from which they start: a shutdown ends what powers the drives."""
    again = "G3" if enabled_early(graph) else "G4"
    return ((*stage, again) for stage in _stages(graph)[1:])


def _stages(graph: CellGraph) -> list[Values]:
    """Return each stage with its file, the cap of one joint, what slows it no more, and the command that shows it."""
    rows = list[Values]()
    controls = ((device.name, device.procedures.speed_control) for device in graph.cell.devices)
    named = [f"the {control.name} of {name}" for name, control in controls if control is not None and control.name]
    full = f" Set {' and '.join(named)} to 100 %, so that only the cap limits the speed." if named else ""
    for percent, file in stage_files(graph.cell).items():
        joint, node = graph.cell.groups[0].joints[0], graph.cell.planners[0].full_name
        parameter = f"robot_description_planning.joint_limits.{joint}.max_velocity"
        command = f"timeout 30 ros2 param get {shell_word(node)} {shell_word(parameter)}"
        rows.append((percent, file, joint, full, command))
    return rows


def risk_assessment(graph: CellGraph) -> Iterator[Values]:
    """Yield the document of the risk assessment with its figures, where it states one."""
    assessed = graph.cell.safety.risk_assessment
    named = {"velocity": "tool speed", "reach": "reach", "force": "grip force"}
    texts = {word: graph.cell.text("safety", "risk_assessment", name) for name, word in named.items()}
    figures = ", ".join(f"{word} {text}" for word, text in texts.items() if text)
    if assessed is not None and figures:
        yield assessed.document, figures


def cancels(graph: CellGraph) -> Iterator[Values]:
    """Yield the actions that promise how soon a cancel holds, without those of the first goals, which try it.

    A gripper has ended its stroke before a command of people arrives.
    """
    tried = {goal.action for goal in first_goals(graph.cell)} | {action for _, action, *_ in gripper_goals(graph)}
    for interface in graph.cell.interfaces:
        if "real" in interface.targets and interface.cancel_within_s is not None and interface.name not in tried:
            yield interface.name, shortest(interface.cancel_within_s), f"{interface.name}/_action/cancel_goal"


def short_motions(graph: CellGraph) -> Iterator[Values]:
    """Yield the actions of grippers that promise how soon a cancel holds."""
    short = {action for _, action, *_ in gripper_goals(graph)}
    for interface in graph.cell.interfaces:
        if interface.name in short and interface.cancel_within_s is not None:
            yield interface.name, shortest(interface.cancel_within_s)


def real_actions(graph: CellGraph) -> Iterator[Values]:
    """Yield the actions that somebody serves on the real target."""
    for interface in graph.cell.interfaces:
        if interface.kind is InterfaceKind.ACTION and "real" in interface.targets:
            yield (interface.name,)


def unguarded(graph: CellGraph) -> Iterator[Values]:
    """Yield driver interfaces outside the cell that move a device past every controller, and what a call does."""
    for device, offer, does in past_controllers(graph.cell):
        yield device.name, offer.name, offer.type, sentences(does), endpoint_command(graph.cell, offer.kind, offer.name)


def endpoint_command(cell: Cell, kind: InterfaceKind, name: str) -> str:
    """Return what shows who is at an interface; Humble tells no more of a service than its type."""
    if kind is InterfaceKind.TOPIC:
        return f"timeout 30 ros2 topic info -v {shell_word(name)}"
    if kind is InterfaceKind.ACTION:
        return f"timeout 30 ros2 action info {shell_word(name)}"
    verb = "info" if Feature.SERVICE_INFO in features(cell.distro) else "type"
    return f"timeout 30 ros2 service {verb} {shell_word(name)}"
