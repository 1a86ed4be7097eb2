"""The law by which the joints of each real device follow: of the interface that is commanded, with its figures."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.hardware import Adapter, CommandLaw
from cellc.compiler.graph.frame_tree import build_frame_tree
from cellc.compiler.graph.grips import heaviest_part
from cellc.contract.control_law import ControlLaw, JointLaw, LinkMass
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import TRAJECTORIES, Distro, Feature, Gravity, Held, Loop, features

_ROUNDING_KG = 0.05
"""Masses of descriptions are rounded: a payload that differs from its tool by less has no part in it."""
_EFFORT = "effort"


@dataclass(frozen=True, slots=True)
class _Commands:
    """What moves joints: those that are moved on a path, and the first that commands each, with its interface."""

    on_paths: frozenset[str]
    first: Mapping[str, tuple[Controller, str]]
    adapted: frozenset[str]


def control_laws(cell: Cell) -> Mapping[str, ControlLaw]:
    """Return the law of every device that moves on a path, by its name."""
    commands = _commands(cell)
    laws = ((device.name, _law(cell, device, commands)) for device in cell.devices)
    return {name: law for name, law in laws if law is not None}


def start_outside(cell: Cell) -> float:
    """Return how far outside its limits a joint may be when a motion is planned, rad or m.

    A joint commanded at a limit may come to rest as far outside as its goal tolerance allows, where springs hold it.
    MoveIt plans from the limit then, until it took lists of adapters: none of those does that for joints with limits
    (moveit2@065602a check_start_state_bounds.cpp).
    """
    if Feature.PLUGIN_LISTS in features(cell.distro):
        return 0.0
    springs = {joint for law in control_laws(cell).values() for joint in law.joints}
    figures = (figure for loop in cell.controllers for figure in (loop.goal_tolerance or {}).items())
    return min((figure.value for joint, figure in figures if joint in springs and figure.value > 0.0), default=0.0)


def _commands(cell: Cell) -> _Commands:
    followed = {joint for loop in cell.controllers if loop.behavior in TRAJECTORIES for joint in loop.joints}
    followed |= {joint for group in cell.groups for joint in group.joints}
    followed |= {joint for adapted in cell.adapters for joint in adapted.joints}
    first: dict[str, tuple[Controller, str]] = {}
    for controller in sorted(cell.controllers, key=_rank):
        for claim in controller.claims(controller.targets[-1]):
            joint, _, kind = claim.rpartition("/")
            first.setdefault(joint, (controller, kind))
    return _Commands(frozenset(followed), first, frozenset(adapted.device for adapted in cell.adapters))


def _rank(controller: Controller) -> tuple[bool, bool, bool]:
    """Order what the real target has before the rest, trajectories before others, what is active before what is not."""
    return "real" not in controller.targets, controller.behavior not in TRAJECTORIES, not controller.active


def _law(cell: Cell, device: Device, commands: _Commands) -> ControlLaw | None:
    """Return the law of what commands a device on the real target; None where nothing moves it on a path."""
    joints = tuple(joint.name for joint in device.actuated_joints if not _is_finger(device, joint.name))
    if commands.on_paths.isdisjoint(joints):
        return None
    if device.name in commands.adapted:
        return _adapted(cell, device, joints)
    commanded = [commands.first[joint] for joint in joints if joint in commands.first]
    controller, kind = commanded[0] if commanded else (None, "")
    law = _of_kind(device.control.laws, kind)
    if law is None:
        by = f" for commands by `{kind}`" if device.control.laws else ""
        return _unknown(f"the `device.yaml` of `{device.model}` states no law{by}")
    if law.loop is not Loop.SPRING:
        return ControlLaw(loop=law.loop, because=law.because if law.loop is Loop.UNKNOWN else "", held=law.held)
    springs = _springs(device, joints, law, controller, cell.distro)
    return _unknown(springs) if isinstance(springs, str) else _spring(cell, device, law, springs)


def _is_finger(device: Device, joint: str) -> bool:
    return device.gripper is not None and joint == device.gripper.joint


def _of_kind(laws: Sequence[CommandLaw], kind: str) -> CommandLaw | None:
    return next((law for law in laws if kind in law.commands), next((law for law in laws if not law.commands), None))


def _unknown(because: str) -> ControlLaw:
    return ControlLaw(loop=Loop.UNKNOWN, because=because)


def _springs(
    device: Device, joints: Sequence[str], law: CommandLaw, controller: Controller | None, distro: Distro
) -> dict[str, JointLaw] | str:
    """Return the spring of each joint, or why it is not known."""
    if law.gains == "controller":
        return _by_controller(joints, controller, distro)
    if law.gains == "impedance":
        stated = device.robot.impedance
        if stated is None or stated.joint is None:
            return f"`{device.name}` states no `joint` of its `impedance`, and no public source has the usual one"
        return _by_figures(joints, stated.joint, stated.damping or ())
    real = {} if device.control.hardware is None else device.control.hardware.parameters.get("real", {})
    try:
        stiffness, damping = ([float(real[name]) for name in names] for names in (law.stiffness, law.damping))
    except (KeyError, ValueError):
        return f"the plugin of `{device.name}` gets no figure as {' and '.join(map(str, law.stiffness[:1]))}"
    return _by_figures(joints, stiffness, damping)


def _by_figures(
    joints: Sequence[str], stiffness: Sequence[float], damping: Sequence[float]
) -> dict[str, JointLaw] | str:
    """Return springs by their figures, or which joint has none; fingers beyond them are where they are commanded."""
    brakes = (*damping, *(0.0 for _ in stiffness[len(damping) :]))
    free = [joint for joint, stiff in zip(joints, stiffness, strict=False) if stiff <= 0.0]
    if free:
        return f"`{free[0]}` has a stiffness of zero"
    springs = zip(joints, stiffness, brakes, strict=False)
    return {joint: JointLaw(stiffness=stiff, damping=brake) for joint, stiff, brake in springs}


def _by_controller(joints: Sequence[str], controller: Controller | None, distro: Distro) -> dict[str, JointLaw] | str:
    """Return springs that are gains of a controller, with the bounds of their integrals in the distribution."""
    found: dict[str, JointLaw] = {}
    loaded = {} if controller is None else controller.parameters_on("real")
    kind = None if controller is None else controller.declared
    declared = {} if kind is None else kind.parameters_in(distro)
    bounds = [(key, one.default) for key in ("i_clamp", "i_clamp_max") if (one := declared.get(f"gains.<joint>.{key}"))]
    for joint in joints:
        gain = {key: _number(loaded.get(f"gains.{joint}.{key}")) for key in ("p", "i", "d")}
        if gain["p"] is None or gain["p"] <= 0.0:
            return f"no controller has a gain `gains.{joint}.p` above 0"
        integral = gain["i"] or 0.0
        most = [_number(loaded.get(f"gains.{joint}.{key}", default)) for key, default in bounds if integral]
        least = min((bound for bound in most if bound is not None and bound < math.inf), default=None)
        found[joint] = JointLaw(stiffness=gain["p"], damping=gain["d"] or 0.0, integral=integral, integral_most=least)
    return found


def _number(value: object) -> float | None:
    return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) else None


def _adapted(cell: Cell, device: Device, joints: Sequence[str]) -> ControlLaw:
    """Return the law of a loop on the vendor's library: what the spec states, against the gravity of the device.

    An adapter holds by bringing its set points to a standstill, not by taking what is measured for the next one.
    """
    control = device.control
    stated, always = control.adapter or Adapter(), next((law for law in control.laws if not law.commands), None)
    if stated.stiffness is None:
        if always is not None and always.loop is Loop.POSITION:
            return ControlLaw(loop=Loop.POSITION, held=Held.COMMANDED)
        return _unknown(f"the `adapter` of `{device.name}` states no `stiffness`")
    known = _of_kind(control.laws, _EFFORT)
    if known is None:
        return _unknown(f"the `device.yaml` of `{device.model}` states no law for commands by `{_EFFORT}`")
    springs = _by_figures(joints, stated.stiffness, stated.damping or ())
    law = replace(known, held=Held.COMMANDED)
    return _unknown(springs) if isinstance(springs, str) else _spring(cell, device, law, springs)


def _spring(cell: Cell, device: Device, law: CommandLaw, joints: Mapping[str, JointLaw]) -> ControlLaw:
    return ControlLaw(
        loop=Loop.SPRING,
        held=law.held,
        gravity=law.gravity,
        lags=law.lags,
        joints=dict(joints),
        unaccounted=tuple(_unaccounted(cell, device)) if law.gravity is Gravity.COMPENSATED else (),
        part=_part(cell, device),
    )


def _unaccounted(cell: Cell, device: Device) -> Iterator[LinkMass]:
    """Yield what a device that compensates does not know of: its tools, without the payload that it is set to."""
    for link, inertial in cell.tool_masses(device):
        yield LinkMass(link=link, mass_kg=inertial.mass, center=inertial.pose.position)
    if device.robot.payload is not None and device.body.tool_frame is not None:
        center = device.robot.payload.center_of_mass
        yield LinkMass(link=device.body.tool_frame, mass_kg=-device.robot.payload.mass_kg, center=center)


def _part(cell: Cell, device: Device) -> LinkMass | None:
    """Return what the tool holds, at the tip of the device's group; None where nothing says that it is held."""
    payload, names = device.robot.payload, {joint.name for joint in device.joints}
    group = next((group for group in cell.groups if names & set(group.joints)), None)
    if group is None:
        return None
    stated = None if payload is None else payload.part_kg
    if stated is None:
        stated = heaviest_part(cell, (device.name, *device.mount.carries))
    rest_kg = 0.0 if payload is None else payload.mass_kg - cell.carried_mass_kg(device)
    mass_kg = stated if stated is not None else rest_kg if rest_kg > _ROUNDING_KG else 0.0
    link, pose = build_frame_tree(cell).carrier(group.tip_frame)
    return LinkMass(link=link, mass_kg=round(mass_kg, 9), center=pose.position) if mass_kg > 0.0 else None
