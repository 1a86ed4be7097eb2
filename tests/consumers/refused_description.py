"""What the real controller manager refuses in a description, or takes and suffers from; recorded with 5.16."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from xml.etree.ElementTree import Element, ParseError, fromstring

_CHILDREN = {
    "ros2_control": {"hardware", "properties", "joint", "sensor", "gpio", "transmission"},
    "hardware": {"plugin", "group", "param"},
    "joint": {"command_interface", "state_interface", "limits", "param"},
    "sensor": {"command_interface", "state_interface", "param"},
    "gpio": {"command_interface", "state_interface", "param"},
}
_NUMBER = re.compile(r"\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*")
_GENERIC = "mock_components/GenericSystem"


def description_faults(text: str, plugins: set[str]) -> list[str]:
    """Return the recorded classes of refusal and danger that a description falls into.

    Args:
        plugins: hardware plugins that are installed.
    """
    try:
        robot = fromstring(text)
    except ParseError as error:
        return [f"not well formed: {error}"]
    joints = {joint.attrib["name"]: joint for joint in robot.findall("joint")}
    components = robot.findall("ros2_control")
    found = [] if components else ["no ros2_control"]
    found += _names(components)
    for joint in joints.values():
        found += _limits(joint)
    for component in components:
        found += _component(component, plugins)
        for tag in component.findall("joint"):
            found += _joint(tag, joints, component)
    return found


def _names(components: list[Element]) -> Iterator[str]:
    names = Counter(component.get("name", "").lower() for component in components)
    yield from (f"hardware name '{name}' is duplicated" for name, count in names.items() if name and count > 1)
    claimed = Counter(tag.get("name") for component in components for tag in component.findall("joint"))
    yield from (f"joint {name} in two components" for name, count in claimed.items() if count > 1)


def _limits(joint: Element) -> Iterator[str]:
    limit, kind, name = joint.find("limit"), joint.get("type"), joint.get("name")
    needed = {"revolute": 4, "prismatic": 4, "continuous": 2}.get(kind or "", 0)
    stated = [key for key in ("effort", "velocity", "lower", "upper") if limit is not None and key in limit.attrib]
    if kind in ("revolute", "prismatic", "continuous") and stated[:2] != ["effort", "velocity"]:
        yield f"limit of {name} lacks effort or velocity"
    elif len(stated) < needed:
        yield f"limit of {name} lacks lower or upper"
    elif needed == 4 and limit is not None and float(limit.attrib["lower"]) > float(limit.attrib["upper"]):
        yield f"limits of {name} are reversed"


def _component(component: Element, plugins: set[str]) -> Iterator[str]:
    name, kind = component.get("name"), component.get("type")
    plugin = component.findtext("hardware/plugin")
    if not name:
        yield "ros2_control without name"
    if kind not in ("system", "actuator", "sensor"):
        yield f"type {kind} of {name}"
    elif kind != "system" and plugin == _GENERIC:
        yield f"{plugin} is registered for systems alone"
    if not plugin:
        yield f"no plugin in {name}"
    elif plugin not in plugins:
        yield f"plugin {plugin} does not exist"
    if not component.get("rw_rate", "0").isdigit():
        yield f"rw_rate of {name}"
    for tag in component.iter():
        unknown = {child.tag for child in tag} - _CHILDREN.get(tag.tag, {child.tag for child in tag})
        yield from (f"<{child}> in {tag.tag} is ignored" for child in sorted(unknown))
        if tag.tag in ("joint", "gpio", "sensor", "param", "command_interface", "state_interface") and not tag.get(
            "name"
        ):
            yield f"<{tag.tag}> without name in {name}"
        if tag.tag == "param" and not (tag.text or "").strip() and tag not in list(component.find("hardware") or ()):
            yield f"empty {tag.get('name')} in {name}"


def _joint(tag: Element, joints: dict[str, Element], component: Element) -> Iterator[str]:
    name = tag.get("name", "")
    if name not in joints:
        yield f"joint '{name}' not found in URDF"
        return
    joint = joints[name]
    if joint.get("type") == "fixed":
        yield f"fixed joint {name}"
    mimic = joint.find("mimic")
    if mimic is not None and tag.get("mimic") != "false":
        if tag.find("command_interface") is not None:
            yield f"mimic joint {name} with a command interface"
        if mimic.get("joint") not in {other.get("name") for other in component.findall("joint")}:
            yield f"mimicked joint of {name} in no component"
    for kind in ("command_interface", "state_interface"):
        twice = Counter(interface.get("name") for interface in tag.findall(kind))
        yield from (f"{kind} {one} of {name} twice" for one, count in twice.items() if count > 1)
    for interface in (*tag.findall("command_interface"), *tag.findall("state_interface")):
        yield from _values(interface, joint)


def _values(interface: Element, joint: Element) -> Iterator[str]:
    """Yield what is wrong with ``min``, ``max`` and ``initial_value`` of an interface."""
    stated: dict[str, float] = {}
    for param in interface.findall("param"):
        if not _NUMBER.fullmatch(param.text or ""):
            yield f"{param.get('name')} of {joint.get('name')} is no number"
        else:
            stated[param.get("name", "")] = float(param.text or "")
    if stated.get("min", 0.0) > stated.get("max", float("inf")):
        yield f"min above max at {joint.get('name')}"
    limit, start = joint.find("limit"), stated.get("initial_value")
    if interface.get("name") == "position" and limit is not None and start is not None and "lower" in limit.attrib:
        low, high = float(limit.attrib["lower"]), float(limit.attrib["upper"])
        if not max(low, stated.get("min", low)) <= start <= min(high, stated.get("max", high)):
            yield f"initial_value of {joint.get('name')} is outside of its limits"
