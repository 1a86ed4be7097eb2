"""``device.yaml`` of a robot: what its description says, UNKNOWN with its question where it does not."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from cellc.compiler.formats.numbers import shortest
from cellc.contract.diagnostics import Outcome
from cellc.contract.vocabulary import UNKNOWN
from cellc.robot.description.model import Description, HardwareComponent, Joint
from cellc.robot.description.read_description import text_under
from cellc.robot.description.xml_tree import read_xml
from cellc.tools.importing.chain import actuated, home_of
from cellc.tools.importing.gaps import gap_questions
from cellc.tools.importing.merge import Facts, dumped
from cellc.tools.importing.role import Role
from cellc.tools.importing.source import Robot
from cellc.tools.importing.unread import unread

DESCRIPTION = "robot.urdf"
"""Name of the description beside ``device.yaml``."""
_ASSUMED = {False: ("2 rad/s^2", "20 rad/s^3"), True: ("0.5 m/s^2", "5 m/s^3")}
_UNKNOWN = "UNKNOWN, assumed by cellc import: URDF has no place for it"
_MOCK = "mock_components/GenericSystem"
_PRETEND = ("mock_components/", "fake_components/")

Pairs = Mapping[tuple[str, str], str]
"""Two links → why their contact is not looked for."""


@dataclass(frozen=True, slots=True)
class Judged:
    """What was found once the description was checked: pairs that may touch, and codes that are excused, with why.

    Attributes:
        asked: questions that findings raise.
    """

    allowed: Pairs = field(default_factory=dict)
    excused: Mapping[str, str] = field(default_factory=dict)
    asked: tuple[str, ...] = ()


def model_name(robot: Robot) -> str:
    """Return the robot's own name as a name of a model."""
    name = re.sub(r"[^a-z0-9]+", "_", robot.description.name.lower()).strip("_")
    return name if name[:1].isalpha() else f"robot_{name}".rstrip("_")


def device_text(robot: Robot, role: Role, judged: Judged, facts: Facts) -> str:
    """Write the file; the questions stand at its head."""
    head = [
        "# Made by `cellc import`; a second import keeps what a person wrote.",
        "# Open questions:",
    ]
    asked = [f"#   {number}. {question}" for number, question in enumerate(questions(robot, role, judged), 1)]
    return "\n".join((*head, *asked)) + "\n" + dumped(facts)


def questions(robot: Robot, role: Role, judged: Judged) -> Iterator[str]:
    """Yield what the files do not say and a person has to find out."""
    yield from role.questions()
    yield from gap_questions(robot.assumed)
    yield "acceleration and jerk of each joint are assumed: what does the vendor allow?"
    if not robot.license:
        yield "no license was found: may the description be kept and passed on?"
    yield from _of_hardware(robot.description)
    if left_out := tuple(unread(robot.text)):
        yield f"the description states what the folder does not hold: {', '.join(left_out)}: is any of it needed?"
    yield from judged.asked
    yield from (f"`{code}` is excused: {because}" for code, because in judged.excused.items())
    asked = [pair for pair, because in judged.allowed.items() if because.startswith(UNKNOWN)]
    if asked:
        shown = ", ".join(f"{first} and {second}" for first, second in asked[:3])
        yield f"links touch at home, {shown}{_more(asked[3:])}: may they?"
    if robot.missing:
        more = _more(robot.missing[1:])
        yield f"collision shapes name meshes that are missing, {robot.missing[0]}{more}: where are they?"


def _more(others: Sequence[object]) -> str:
    return f", and {len(others)} more" if others else ""


def device_facts(robot: Robot, role: Role, judged: Judged, day: str) -> Facts:
    """Return what the files say of the robot, and what was found once they were checked."""
    description, joints, chain = robot.description, actuated(robot.description), role.chain
    links = dict.fromkeys((description.roots()[0], chain.base, chain.tip))
    facts: Facts = {
        "format": 1,
        "model": model_name(robot),
        "vendor": UNKNOWN,
        "summary": f"{description.name}, {len(joints)} joints",
        "kind": role.kind.kind,
        "as_of": day,
        "sources": [f"{robot.file.name}, license {robot.license or 'UNKNOWN'}"],
        "description": {"file": DESCRIPTION},
        "base": description.roots()[0],
        "frames": {name: name for name in links} | role.frames,
    }
    if role.tool_frame is not None:
        facts["tool_frame"] = role.tool_frame
    homes = {joint.name: f"{shortest(home_of(joint))} {_unit(joint)}" for joint in joints if home_of(joint)}
    if homes:
        facts["home"] = homes
    if judged.allowed:
        facts["allowed_collisions"] = [
            {"links": list(pair), "because": because} for pair, because in sorted(judged.allowed.items())
        ]
    if judged.excused:
        facts["excused"] = dict(judged.excused)
    facts["limits"] = {**robot.assumed, "acceleration": _limits(joints, 0), "jerk": _limits(joints, 1)}
    facts["packages"] = {"driver": None, "sdk": None, "description": None}
    facts["control"] = _control(description)
    return facts


def _unit(joint: Joint) -> str:
    return "m" if joint.slides else "rad"


def _limits(joints: tuple[Joint, ...], which: int) -> dict[str, object]:
    """Return one figure for all that turn, and one for each that slides."""
    turns: dict[str, object] = {"*": {"value": _ASSUMED[False][which], "source": _UNKNOWN}}
    return turns | {
        joint.name: {"value": _ASSUMED[True][which], "source": _UNKNOWN} for joint in joints if joint.slides
    }


def _control(description: Description) -> dict[str, object]:
    drivers = _drivers(description)
    mock = {"plugin": _MOCK, "source": "mock hardware of ros2_control"}
    hardware: dict[str, object] = {"real": _real(drivers[0])} if len(drivers) == 1 else {}
    joints: dict[str, object] = {"*": {"command": ["position"], "state": ["position", "velocity"]}}
    named = {joint.name for joint in description.joints}
    for part in (part for component in description.hardware for part in component.joints):
        command = [interface.name for interface in part.command_interfaces]
        if part.name in named and "position" in command:
            joints[part.name] = {"command": command, "state": [interface.name for interface in part.state_interfaces]}
    return {"component": "{device}_hardware", "hardware": {**hardware, "mock": mock}, "joints": joints}


def _drivers(description: Description) -> tuple[HardwareComponent, ...]:
    """Return the components that drive a robot, each plugin with its parameters once.

    Where none commands anything, all do. A system, an actuator and a sensor of ros2_control differ in the kind of
    plugin that it looks for alone.
    """
    real = [component for component in description.hardware if not component.plugin.startswith(_PRETEND)]
    commanding = [
        component
        for component in real
        if any(part.command_interfaces for part in (*component.joints, *component.gpios))
    ]
    drivers: dict[tuple[object, ...], HardwareComponent] = {}
    for component in commanding or real:
        drivers.setdefault((component.type, component.plugin, *sorted(component.parameters.items())), component)
    return tuple(drivers.values())


def _of_hardware(description: Description) -> Iterator[str]:
    """Yield what `<ros2_control>` says that one device with joints in positions does not hold."""
    if description.hardware_error:
        yield f"`<ros2_control>` is refused by ros2_control, which says: {description.hardware_error}: what is meant?"
    elif not description.hardware:
        yield "there is no `<ros2_control>` in the description: which plugin drives the robot, with which parameters?"
    drivers = _drivers(description)
    if len(drivers) > 1:
        named = ", ".join(f"`{driver.name}` with {driver.plugin}" for driver in drivers)
        yield f"{len(drivers)} components of `<ros2_control>` drive it, {named}: which has a device of its own?"
    left = [
        component
        for component in description.hardware
        if not component.plugin.startswith(_PRETEND) and component not in drivers
    ]
    for component in left if drivers else ():
        if (component.plugin, component.parameters) != (drivers[0].plugin, drivers[0].parameters):
            yield (
                f"`{component.name}` of `<ros2_control>` with {component.plugin} is left out. "
                "Describe it as a separate device if it is one."
            )
    for part in (part for component in description.hardware for part in component.joints):
        commands = [interface.name for interface in part.command_interfaces]
        if commands and "position" not in commands:
            yield f"`{part.name}` takes {', '.join(commands)}, and position is assumed: what moves it?"


def _real(component: HardwareComponent) -> dict[str, object]:
    kind = {} if component.type == "system" else {"component": component.type}
    parameters = dict(component.parameters)
    source = "<ros2_control> of the description"
    return {"plugin": component.plugin, **kind, "parameters": parameters, "source": source}


def disabled_by_srdf(file: Path, links: set[str]) -> Outcome[Pairs]:
    """Return the pairs of links of the robot that an SRDF disables, with its reason."""
    text = text_under(file, file.parent)
    read = Outcome(None, text.diagnostics) if text.value is None else read_xml(text.value, file.as_posix())
    if read.value is None:
        return Outcome(None, read.diagnostics)
    pairs: dict[tuple[str, str], str] = {}
    for element in read.value.all("disable_collisions"):
        first, second = (element.attributes.get(key, "") for key in ("link1", "link2"))
        if first != second and {first, second} <= links:
            reason = element.attributes.get("reason", "") or "no reason"
            pairs[min(first, second), max(first, second)] = f"{file.name} says {reason}"
    return Outcome(pairs)
