"""What the spec tells the robot's own controller, who starts its program, and what that changes of its driver."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Literal

from cellc.compiler.catalog import robot_facts as catalog
from cellc.compiler.catalog.device_laws import LawFacts
from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.robot_facts import StartMode
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.hardware import CommandLaw, Drives
from cellc.compiler.cell.interface import ParameterValue
from cellc.compiler.cell.robot import (
    CartesianImpedance,
    CollisionThresholds,
    Impedance,
    ImpedanceFacts,
    Load,
    Moments6,
    Payload,
    RobotController,
    RobotFacts,
    Thresholds,
)
from cellc.compiler.link.frames import FrameNames
from cellc.compiler.link.quantities import vector
from cellc.compiler.link.tool import plug, tool_conditions, tool_connector, tool_facts
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.devices import DeviceSpec
from cellc.compiler.spec.quantity import QuantityVector
from cellc.compiler.spec.robot import CollisionSpec, ImpedanceSpec, PayloadSpec
from cellc.contract.diagnostics import Diagnostic, Outcome
from cellc.contract.stated import RobotProgram

DRIVER = "driver"
"""The word of a spec for a program that the driver of the robot sends and starts."""


def robot_controller(facts: DeviceModel, written: DeviceSpec) -> RobotController:
    """Return what a robot's own controller gets; the frame of its TCP is bound once all devices are known."""
    return RobotController(
        payload=_payload(written),
        program=written.program,
        collision=None if written.collision is None else _collision(written.collision),
        impedance=None if written.impedance is None else _impedance(written.impedance),
        tool_connector=tool_connector(facts, written),
        plug=plug(facts.plug),
        accepts=_accepted(facts),
    )


def program_parameters(facts: DeviceModel, written: DeviceSpec) -> Mapping[str, str]:
    """Return what the real plugin gets of the start mode of the program, and of the impedance."""
    start = chosen_start_mode(facts, written)
    return {**({} if start is None else start.parameters), **dict(_springs(facts, written))}


def command_laws(facts: DeviceModel) -> tuple[CommandLaw, ...]:
    """Return how the joints of the real device follow commands."""
    return tuple(map(_command_law, facts.laws))


def drives(facts: DeviceModel) -> Drives | None:
    """Return what the drives of the real device add to its joints."""
    known = facts.drives
    if known is None:
        return None
    return Drives(*(() if stated is None else stated.si for stated in (known.armature, known.damping, known.friction)))


def _command_law(facts: LawFacts) -> CommandLaw:
    return CommandLaw(
        commands=facts.commands,
        loop=facts.loop,
        gains=facts.gains,
        stiffness=facts.stiffness,
        damping=facts.damping,
        lags=facts.damps == "motion",
        gravity=facts.gravity,
        held=facts.held,
        because=facts.because or "",
    )


def _springs(facts: DeviceModel, written: DeviceSpec) -> Iterator[tuple[str, str]]:
    """Yield the parameters of the real plugin that the impedance of the spec sets."""
    stated = written.impedance
    for law in facts.laws if stated is not None else ():
        assert stated is not None  # the loop has no turn otherwise
        for names, figures in ((law.stiffness, stated.joint), (law.damping, stated.damping)):
            yield from zip(names, map(repr, () if figures is None else figures.si), strict=False)


def link_centers(spec: CellSpec, devices: tuple[Device, ...], names: FrameNames) -> Outcome[tuple[Device, ...]]:
    """Bind the frame at which each robot holds its TCP; a frame that there is not is reported."""
    bound: list[Device] = []
    problems: list[Diagnostic] = []
    for device in devices:
        reference = spec.devices[device.name].tcp
        frame: Outcome[str] = Outcome(None) if reference is None else names.bind(reference, (*device.path, "tcp"))
        problems += frame.diagnostics
        bound.append(replace(device, robot=replace(device.robot, tcp=frame.value)))
    return Outcome(tuple(bound), tuple(problems))


def chosen_start_mode(facts: DeviceModel, written: DeviceSpec) -> StartMode | None:
    """Return the start mode of the program that the spec names, else the first of the catalog, or None."""
    program = facts.robot.program
    if program is None:
        return None
    if written.program is None:
        return program.start_modes[0]
    return program.start_mode(_starter(written.program), written.program.mode)


def set_by(written: DeviceSpec) -> Literal["installation", "service"]:
    """Return how a robot gets its payload: by what is saved on it where the spec does not say."""
    return "installation" if written.payload is None else written.payload.set_by


def conditions(facts: DeviceModel, written: DeviceSpec) -> frozenset[str]:
    """Return the conditions that a device meets, of those that a step of its vendor's procedure may depend on."""
    start = chosen_start_mode(facts, written)
    thresholds = "open" if written.collision is None else "stated"
    name = "" if start is None else start.name
    impedance = written.impedance
    stated = {
        "load_stated": written.payload is not None and written.payload.load is not None,
        "joint_impedance_stated": impedance is not None and impedance.joint is not None,
        "cartesian_impedance_stated": impedance is not None and impedance.cartesian is not None,
    }
    more = (name for name, so in stated.items() if so)
    names = (name, *more, f"payload_by_{set_by(written)}", f"thresholds_{thresholds}", *tool_conditions(written, name))
    return frozenset(names)


def node_parameters(facts: DeviceModel, written: DeviceSpec, node: str) -> Mapping[str, ParameterValue]:
    """Return the parameters that the start mode sets on a node of the driver, by its name in the catalog."""
    start = chosen_start_mode(facts, written)
    return {} if start is None else start.node_parameters.get(node, {})


def robot_words(written: DeviceSpec) -> Iterator[tuple[str, str]]:
    """Yield placeholders for what the spec says of the robot's own controller."""
    yield "played_by", "a person" if written.program is None else written.program.played_by
    if written.collision is not None:
        yield "thresholds", _request(_collision(written.collision))
    if written.payload is not None and (load := _load(written.payload)) is not None:
        yield "load", _load_request(load)
    if written.impedance is not None and written.impedance.joint is not None:
        yield "joint_stiffness", _listed(written.impedance.joint.si)
    if written.impedance is not None and (at := written.impedance.cartesian) is not None:
        yield "cartesian_stiffness", _listed((*at.translation.si, *at.rotation.si))


def _starter(program: RobotProgram) -> str:
    return DRIVER if program.played_by == DRIVER else "person"


def _request(collision: CollisionThresholds) -> str:
    """Return the fields of a request: each threshold for phases of acceleration and for those without."""
    values = {
        ("lower", "torque"): collision.torque.lower,
        ("upper", "torque"): collision.torque.upper,
        ("lower", "force"): (*collision.force.lower, *collision.moment.lower),
        ("upper", "force"): (*collision.force.upper, *collision.moment.upper),
    }
    parts = (
        f"{side}_{kind}_thresholds_{phase}: {_listed(numbers)}"
        for (side, kind), numbers in values.items()
        for phase in ("acceleration", "nominal")
    )
    return "{" + ", ".join(parts) + "}"


def _listed(numbers: Iterable[float]) -> str:
    return f"[{', '.join(map(repr, numbers))}]"


def _load_request(load: Load) -> str:
    """Return the fields of a request; of a symmetric matrix rows and columns say the same."""
    xx, yy, zz, xy, xz, yz = load.inertia
    matrix = _listed((xx, xy, xz, xy, yy, yz, xz, yz, zz))
    center = _listed(load.center_of_mass)
    return f"{{mass: {load.mass_kg!r}, center_of_mass: {center}, load_inertia: {matrix}}}"


def _moments(inertia: QuantityVector) -> Moments6:
    xx, yy, zz, xy, xz, yz = inertia.si
    return (xx, yy, zz, xy, xz, yz)


def _payload(written: DeviceSpec) -> Payload | None:
    payload = written.payload
    if payload is None:
        return None
    return Payload(
        mass_kg=payload.mass.si,
        center_of_mass=vector(payload.center_of_mass),
        inertia=None if payload.inertia is None else _moments(payload.inertia),
        set_by=payload.set_by,
        load=_load(payload),
        part_kg=None if payload.part is None else payload.part.si,
    )


def _load(payload: PayloadSpec) -> Load | None:
    load = payload.load
    if load is None:
        return None
    return Load(mass_kg=load.mass.si, center_of_mass=vector(load.center_of_mass), inertia=_moments(load.inertia))


def _impedance(written: ImpedanceSpec) -> Impedance:
    at = written.cartesian
    return Impedance(
        joint=None if written.joint is None else written.joint.si,
        damping=None if written.damping is None else written.damping.si,
        cartesian=None if at is None else CartesianImpedance(translation=at.translation.si, rotation=at.rotation.si),
    )


def _collision(written: CollisionSpec) -> CollisionThresholds:
    def thresholds(lower: QuantityVector, upper: QuantityVector) -> Thresholds:
        return Thresholds(lower=lower.si, upper=upper.si)

    return CollisionThresholds(
        torque=thresholds(written.torque.lower, written.torque.upper),
        force=thresholds(written.force.lower, written.force.upper),
        moment=thresholds(written.moment.lower, written.moment.upper),
    )


def _accepted(facts: DeviceModel) -> RobotFacts:
    controller = facts.robot
    modes = () if controller.program is None else controller.program.start_modes
    return RobotFacts(
        start_modes=tuple((start.by, start.mode) for start in modes),
        thresholds=controller.thresholds is not None,
        payload_service=controller.payload_service is not None,
        load_service=controller.load_service is not None,
        impedance_facts=None if controller.impedance is None else _impedance_facts(controller.impedance, facts),
        tcp_kind=None if controller.tcp is None else controller.tcp.controller,
        tcp_topic=None if controller.tcp is None else controller.tcp.topic,
        tool_facts=tool_facts(controller.tool_connector),
    )


def _impedance_facts(taken: catalog.ImpedanceFacts, facts: DeviceModel) -> ImpedanceFacts:
    def span(one: catalog.StiffnessSpan | None) -> tuple[float, float] | None:
        return None if one is None else (one.least, one.most)

    return ImpedanceFacts(
        joint=(taken.joint.least, taken.joint.most),
        damping=span(taken.damping),
        translation=span(taken.translation),
        rotation=span(taken.rotation),
        acts_on=taken.acts_on,
        joints=next((len(law.stiffness) for law in facts.laws if law.stiffness), None),
    )
