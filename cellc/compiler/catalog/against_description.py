"""A device.yaml held against the description beside it as that is written: limits, interfaces, plugin and tool frame.

What a `device.yaml` states replaces what its description has, so that the greater of two figures is believed. Where
the description is the one that is wrong, the finding is excused with its reason.
"""

from __future__ import annotations

from collections.abc import Container, Iterator, Set

from cellc.compiler.catalog.device_interfaces import JointInterfaces
from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.limit_facts import EVERY_JOINT
from cellc.compiler.source.document import SourceDocument
from cellc.contract.diagnostics import Diagnostic, Related, Severity, Span, YamlPath
from cellc.contract.frozen import dataclass
from cellc.robot.description.model import (
    Description,
    HardwareComponent,
    HardwareInterface,
    HardwarePart,
    Joint,
    as_number,
)

CODE = "device-against-description"
_SHARE = 0.01
_ROUNDING = 1e-3
"""By which figures may differ that were rounded, or turned from degrees into radians."""


@dataclass(frozen=True, slots=True)
class _Differs:
    """What differs: its place in the device.yaml, and its place in the description."""

    path: YamlPath
    message: str
    place: Span | None = None


def description_faults(
    model: DeviceModel, written: Description, document: SourceDocument, harmless: Set[str]
) -> Iterator[Diagnostic]:
    """Yield what the figures and names of a device say other than its description.

    Args:
        written: without the limits of the model.
        harmless: plugins that touch no hardware.
    """
    for each in (*_limits(model, written), *_interfaces(model, written), *_plugins(model, written, harmless)):
        yield _found(each, document)
    yield from (_found(each, document) for each in (*_root(model, written), *_tool_frame(model, written)))
    for component in written.hardware:
        for part in component.joints:
            yield from (_found(each, document) for each in _bounds(part, written.joint(part.name)))


def _found(differs: _Differs, document: SourceDocument) -> Diagnostic:
    advice = "write the same in both files, or correct the wrong one"
    span = document.locate(differs.path)
    related = () if differs.place is None else (Related("the description has it here", differs.place),)
    return Diagnostic(CODE, Severity.WARNING, differs.message, span, differs.path, advice, related)


def _limits(model: DeviceModel, written: Description) -> Iterator[_Differs]:
    """Yield limits that are wider than those of their joints, one for a key."""
    seen = set[YamlPath]()
    for joint in written.joints:
        if joint.limit is None or not joint.movable or joint.mimic is not None:
            continue
        for path, message in (*_range(model, joint), *_figures(model, joint)):
            if path not in seen:
                seen.add(path)
                yield _Differs(path, message, joint.limit.span or joint.span)


def _range(model: DeviceModel, joint: Joint) -> Iterator[tuple[YamlPath, str]]:
    limit, key = joint.limit, _key(joint, model.limits.position)
    ends = model.limits.position.get(key)
    if ends is None or limit is None or limit.lower is None or limit.upper is None or limit.lower >= limit.upper:
        return
    slack = max(_ROUNDING, _SHARE * (limit.upper - limit.lower))
    unit = _unit(joint)
    if joint.type == "continuous" or joint.slides != ends.lower.linear:
        return
    for end, beyond, has, stated in (
        ("lower", limit.lower - ends.lower.si, limit.lower, ends.lower),
        ("upper", ends.upper.si - limit.upper, limit.upper, ends.upper),
    ):
        if beyond > slack:
            what = "least" if end == "lower" else "most"
            message = f"`{end}` of `{joint.name}` must be at {what} that of its description, {has:.5g} {unit},"
            yield ("limits", "position", key, end), f"{message} got {stated.text}"


def _figures(model: DeviceModel, joint: Joint) -> Iterator[tuple[YamlPath, str]]:
    for kind, facts, unit in (
        ("velocity", model.limits.velocity, f"{_unit(joint)}/s"),
        ("effort", model.limits.effort, "N" if joint.slides else "N m"),
    ):
        key = _key(joint, facts)
        fact, most = facts.get(key), None if joint.limit is None else getattr(joint.limit, kind)
        if fact is not None and most and fact.value.linear == joint.slides and fact.value.si > most * (1.0 + _SHARE):
            message = f"the {kind} of `{joint.name}` must be at most that of its description, {most:.5g} {unit},"
            yield ("limits", kind, key, "value"), f"{message} got {fact.value.text}"


def _key(joint: Joint, facts: Container[str]) -> str:
    return joint.name if joint.name in facts else EVERY_JOINT


def _unit(joint: Joint) -> str:
    return "m" if joint.slides else "rad"


def _interfaces(model: DeviceModel, written: Description) -> Iterator[_Differs]:
    """Yield interfaces of joints that `<ros2_control>` of the description does not have, one for a key and a kind."""
    stated = {} if model.control is None else model.control.joints
    parts = {part.name: (component, part) for component in written.hardware for part in component.joints}
    seen = set[YamlPath]()
    for joint in written.joints if parts else ():
        key = _key(joint, stated)
        if key not in stated or not joint.movable or (joint.mimic is not None and key == EVERY_JOINT):
            continue
        path: YamlPath = ("control", "joints", key)
        if joint.name not in parts:
            if any(written.joint(name) is None for name in parts):
                continue  # which is reported as what it is, a name that is misspelled
            message = f"`{joint.name}` must be a joint of `<ros2_control>` in the description"
            yield _Differs(path, message, written.hardware[0].span)
            continue
        component, part = parts[joint.name]
        for place, message in _not_exported(stated[key], part):
            if (*path, *place) not in seen:
                seen.add((*path, *place))
                yield _Differs((*path, *place), message, part.span or component.span)


def _not_exported(stated: JointInterfaces, part: HardwarePart) -> Iterator[tuple[YamlPath, str]]:
    for kind, names, has in (
        ("command", stated.command, part.command_interfaces),
        ("state", stated.state, part.state_interfaces),
    ):
        known = [interface.name for interface in has]
        for number, name in enumerate(names):
            if known and name not in known:
                message = f"the {kind} interface `{name}` must be one that `<ros2_control>` has of `{part.name}`:"
                yield (kind, number), f"{message} {', '.join(known)}"


def _plugins(model: DeviceModel, written: Description, harmless: Set[str]) -> Iterator[_Differs]:
    real = None if model.control is None else model.control.hardware.real
    mine = [component for component in written.hardware if _is_of(component, model)]
    if real is None or model.control is None or len(mine) != 1 or not mine[0].plugin:
        return
    mock = model.control.hardware.mock
    known = {real.plugin, *harmless, *(() if mock is None else (mock.plugin,))}
    if mine[0].plugin not in known:
        message = f"the plugin must be that of `<ros2_control>` in the description, `{mine[0].plugin}`,"
        path: YamlPath = ("control", "hardware", "real", "plugin")
        yield _Differs(path, f"{message} got `{real.plugin}`", mine[0].span)


def _is_of(component: HardwareComponent, model: DeviceModel) -> bool:
    named = set() if model.control is None else set(model.control.joints)
    return EVERY_JOINT in named or any(part.name in named for part in component.joints)


def _root(model: DeviceModel, written: Description) -> Iterator[_Differs]:
    """Yield a base that hangs on another link: what is above it would float."""
    joint = next((joint for joint in written.joints if joint.child == model.base), None)
    if joint is not None:
        message = f"`base` must be the link that nothing carries, got `{model.base}`, which hangs on `{joint.parent}`"
        yield _Differs(("base",), message, joint.span)


def _tool_frame(model: DeviceModel, written: Description) -> Iterator[_Differs]:
    """Yield a tool frame that the last joint of its arm does not move."""
    if model.kind != "arm" or model.tool_frame is None:
        return
    above = {joint.child: joint for joint in written.joints}
    name, chain = model.frames.get(model.tool_frame, model.tool_frame), list[Joint]()
    while name in above and above[name] not in chain:
        chain.append(above[name])
        name = chain[-1].parent
    led = {joint.mimic.joint for joint in written.joints if joint.mimic is not None}
    led |= set() if model.gripper is None else {model.gripper.joint}
    moving = [each for each in written.joints if each.movable and each.mimic is None and each.name not in led]
    carrier = next((joint for joint in chain if joint.movable), None)
    last = _last_of_longest(moving, above)
    if carrier is not None and last is not None and carrier in _chain(last, above) and carrier is not last:
        message = f"`tool_frame` must hang on the last joint of the arm, `{last.name}`, got `{model.tool_frame}`,"
        yield _Differs(("tool_frame",), f"{message} which hangs on `{carrier.name}`", chain[0].span)


def _chain(joint: Joint, above: dict[str, Joint]) -> list[Joint]:
    chain = [joint]
    while chain[-1].parent in above and above[chain[-1].parent] not in chain:
        chain.append(above[chain[-1].parent])
    return chain


def _last_of_longest(moving: list[Joint], above: dict[str, Joint]) -> Joint | None:
    """Return the joint with most joints below it, None where two have as many."""
    lengths = {joint.name: sum(each.movable for each in _chain(joint, above)) for joint in moving}
    most = max(lengths.values(), default=0)
    last = [joint for joint in moving if lengths[joint.name] == most]
    return last[0] if len(last) == 1 else None


def _bounds(part: HardwarePart, joint: Joint | None) -> Iterator[_Differs]:
    """Yield bounds of a position command beyond the limits of its joint."""
    limit = None if joint is None else joint.limit
    position = next((has for has in part.command_interfaces if has.name == "position"), None)
    if joint is None or limit is None or position is None or None in (limit.lower, limit.upper):
        return
    if joint.type != "continuous" and _is_wider(position, limit.lower or 0.0, limit.upper or 0.0):
        message = f"`position` of `{part.name}` in `<ros2_control>` must keep within {limit.lower:.5g} to"
        message += f" {limit.upper:.5g} {_unit(joint)} of its joint, got {position.minimum} to {position.maximum}"
        yield _Differs(("description", "file"), message, part.span)


def _is_wider(interface: HardwareInterface, lower: float, upper: float) -> bool:
    least, most = as_number(interface.minimum), as_number(interface.maximum)
    slack = max(_ROUNDING, _SHARE * (upper - lower))
    return (least is not None and least < lower - slack) or (most is not None and most > upper + slack)
