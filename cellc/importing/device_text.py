"""``device.yaml`` of a robot: what its description says, UNKNOWN with its question where it does not."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from cellc.description.model import Description, HardwareComponent, Joint
from cellc.formats.numbers import shortest
from cellc.importing.chain import Chain, actuated, home_of
from cellc.importing.merge import Facts, dumped
from cellc.importing.source import Robot

DESCRIPTION = "robot.urdf"
"""Name of the description beside ``device.yaml``."""
_ASSUMED = {False: ("2 rad/s^2", "20 rad/s^3"), True: ("0.5 m/s^2", "5 m/s^3")}
_UNKNOWN = "UNKNOWN, assumed by cellc import: URDF has no place for it"
_MOCK = "mock_components/GenericSystem"

Pairs = Mapping[tuple[str, str], str]
"""Two links → why their contact is not looked for."""


@dataclass(frozen=True, slots=True)
class Judged:
    """What was found once the description was checked: pairs that may touch, and codes that are excused, with why."""

    allowed: Pairs = field(default_factory=dict)
    excused: Mapping[str, str] = field(default_factory=dict)


def model_name(robot: Robot) -> str:
    """Return the robot's own name as a name of a model."""
    name = re.sub(r"[^a-z0-9]+", "_", robot.description.name.lower()).strip("_")
    return name if name[:1].isalpha() else f"robot_{name}".rstrip("_")


def device_text(robot: Robot, judged: Judged, facts: Facts) -> str:
    """Write the file; the questions stand at its head."""
    head = [
        "# Made by `cellc import`; a second import keeps what a person wrote.",
        "# Open questions:",
    ]
    asked = [f"#   {number}. {question}" for number, question in enumerate(questions(robot, judged), 1)]
    return "\n".join((*head, *asked)) + "\n" + dumped(facts)


def questions(robot: Robot, judged: Judged) -> Iterator[str]:
    """Yield what the files do not say and a person has to find out."""
    yield "acceleration and jerk of each joint are assumed: what does the vendor allow?"
    if not robot.license:
        yield "no license was found: may the description be kept and passed on?"
    hardware = robot.description.hardware
    if not hardware:
        yield "there is no `<ros2_control>` in the description: which plugin drives the robot, with which parameters?"
    yield from (f"`{code}` is excused: {because}" for code, because in judged.excused.items())
    asked = [pair for pair, because in judged.allowed.items() if because.startswith("UNKNOWN")]
    if asked:
        shown = ", ".join(f"{first} and {second}" for first, second in asked[:3])
        yield f"{len(asked)} pairs of links touch at home, {shown} among them: may they?"
    if robot.missing:
        yield f"{len(robot.missing)} meshes of collision shapes, {robot.missing[0]} first, are missing: where are they?"


def device_facts(robot: Robot, chain: Chain, judged: Judged, day: str) -> Facts:
    """Return what the files say of the robot, and what was found once they were checked."""
    description, joints = robot.description, actuated(robot.description)
    facts: Facts = {
        "format": 1,
        "model": model_name(robot),
        "vendor": "UNKNOWN",
        "summary": f"{description.name}, {len(joints)} joints",
        "kind": "arm",
        "as_of": day,
        "sources": [f"{robot.file.name}, license {robot.license or 'UNKNOWN'}"],
        "description": {"file": DESCRIPTION},
        "base": description.roots()[0],
        "frames": {name: name for name in dict.fromkeys((description.roots()[0], chain.base, chain.tip))},
        "tool_frame": chain.tip,
    }
    homes = {joint.name: f"{shortest(home_of(joint))} {_unit(joint)}" for joint in joints if home_of(joint)}
    if homes:
        facts["home"] = homes
    if judged.allowed:
        facts["allowed_collisions"] = [
            {"links": list(pair), "because": because} for pair, because in sorted(judged.allowed.items())
        ]
    if judged.excused:
        facts["excused"] = dict(judged.excused)
    facts["limits"] = {"acceleration": _limits(joints, 0), "jerk": _limits(joints, 1)}
    facts["packages"] = {"driver": None, "sdk": None, "description": None}
    facts["control"] = _control(description)
    return facts


def _unit(joint: Joint) -> str:
    return "m" if joint.slides else "rad"


def _limits(joints: tuple[Joint, ...], which: int) -> dict[str, object]:
    """Return one figure for all that turn, and one for each that slides."""
    turns: dict[str, object] = {"*": {"value": _ASSUMED[False][which], "source": _UNKNOWN}}
    return turns | {one.name: {"value": _ASSUMED[True][which], "source": _UNKNOWN} for one in joints if one.slides}


def _control(description: Description) -> dict[str, object]:
    found = next((one for one in description.hardware if one.type == "system"), None)
    mock = {"plugin": _MOCK, "source": "mock hardware of ros2_control"}
    hardware: dict[str, object] = {} if found is None or _pretends(found) else {"real": _real(found)}
    joints: dict[str, object] = {"*": {"command": ["position"], "state": ["position", "velocity"]}}
    named = {joint.name for joint in description.joints}
    for part in found.joints if found is not None else ():
        command = [one.name for one in part.command_interfaces]
        if part.name in named and "position" in command:
            joints[part.name] = {"command": command, "state": [one.name for one in part.state_interfaces]}
    return {"component": "{device}_hardware", "hardware": {**hardware, "mock": mock}, "joints": joints}


def _pretends(component: HardwareComponent) -> bool:
    return component.plugin.startswith(("mock_components/", "fake_components/"))


def _real(component: HardwareComponent) -> dict[str, object]:
    parameters = {name: value or "UNKNOWN" for name, value in component.parameters.items()}
    return {"plugin": component.plugin, "parameters": parameters, "source": "<ros2_control> of the description"}


def disabled_by_srdf(text: str, links: set[str], name: str) -> Pairs:
    """Return the pairs of links of the robot that an SRDF disables, with its reason."""
    from cellc.description.xml_tree import read_xml

    root = read_xml(text, name).value
    found: dict[tuple[str, str], str] = {}
    for one in () if root is None else root.all("disable_collisions"):
        first, second = (one.attributes.get(key, "") for key in ("link1", "link2"))
        if first != second and {first, second} <= links:
            reason = one.attributes.get("reason", "") or "no reason"
            found[min(first, second), max(first, second)] = f"{Path(name).name} says {reason}"
    return found
