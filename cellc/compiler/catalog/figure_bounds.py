"""Bounds of the figures in a device.yaml: what machines of a kind are, and what its own figures leave.

One table; ``tests/catalog/test_figure_bounds.py`` walks the schema of ``device.yaml`` and fails for a key with a number
that neither the table, nor the shape of the file, nor the list of free keys knows.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from pydantic import BaseModel

from cellc.compiler.catalog.camera_figures import camera_faults
from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.limit_facts import EVERY_JOINT
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.quantity import Quantity, QuantityVector
from cellc.contract.diagnostics import Diagnostic, Related, Severity, YamlPath
from cellc.contract.frozen import dataclass
from cellc.robot.description.model import Description

CODE = "implausible-fact"


@dataclass(frozen=True, slots=True)
class Range:
    """What a figure of a device can be, in SI; ``linear`` where it is one of a joint that slides, if that differs."""

    least: float
    most: float
    linear: tuple[float, float] | None = None


_FORCE, _VOLTAGE, _STIFFNESS = Range(1e-3, 1e5), Range(0.0, 60.0), Range(0.0, 1e6)
_VELOCITY = Range(1e-3, 50.0, (1e-4, 15.0))
_STEP, _DEPTH, _TIMEOUT = Range(1e-5, 1.6, (1e-6, 1.0)), Range(1, 10_000), Range(1e-3, 10.0)
RANGES = {
    "camera.exposure": Range(1e-6, 1.0),
    "camera.streams.*.image.bytes_per_pixel": Range(1, 32),
    "camera.streams.*.image.height": Range(8, 20_000),
    "camera.streams.*.image.width": Range(8, 20_000),
    "camera.streams.*.rate": Range(0.01, 2000.0),
    "camera.streams.*.view.farthest": Range(0.01, 1000.0),
    "camera.streams.*.view.nearest": Range(0.0, 50.0),
    "camera.streams.*.view.horizontal": Range(math.radians(0.5), 6.3),
    "camera.streams.*.view.vertical": Range(math.radians(0.5), 6.3),
    "camera.streams.*.qos.depth": _DEPTH,
    "camera.streams.*.info_qos.depth": _DEPTH,
    "control.hardware.*.command_timeout": _TIMEOUT,
    "control.update_rates.*": Range(1.0, 20_000.0),
    "controllers.*.topics.*.qos.depth": _DEPTH,
    "drives.armature": Range(0.0, 1e3),
    "drives.damping": Range(0.0, 1e4),
    "drives.friction": Range(0.0, 1e4),
    "gripper.max_force": _FORCE,
    "gripper.min_force": _FORCE,
    "gripper.max_speed": Range(1e-4, 5.0),
    "gripper.stroke": Range(1e-4, 2.0),
    "gripper.swing": Range(-6.3, 6.3),
    "limits.acceleration.*.value": Range(0.01, 2000.0, (1e-3, 500.0)),
    "limits.jerk.*.value": Range(0.1, 1e6, (1e-2, 1e6)),
    "limits.effort.*.value": _FORCE,
    "limits.velocity.*.value": _VELOCITY,
    "limits.velocity_everywhere.*.value": _VELOCITY,
    "limits.payload.value": Range(0.01, 3000.0),
    "limits.reach.value": Range(0.05, 10.0),
    "limits.repeatability.value": Range(1e-6, 5e-3),
    "limits.tilt.value": Range(0.0, math.pi),
    "mounts.*.xyz": Range(-2.0, 2.0),
    "plug.voltage": _VOLTAGE,
    "robot.tool_connector.voltages.*": _VOLTAGE,
    **{f"robot.impedance.{kind}.most": _STIFFNESS for kind in ("joint", "damping", "translation", "rotation")},
    **{f"robot.impedance.{kind}.least": _STIFFNESS for kind in ("joint", "damping", "translation", "rotation")},
    "speed_control.low": Range(1e-3, 1.0),
    "topics.*.qos.depth": _DEPTH,
    "topics.*.rate": Range(0.01, 5000.0),
    **{
        f"{place}.largest_step": _STEP
        for place in (
            *("actions.*.effect", "services.*.effect", "nodes.*.effect", "controllers.*.effect"),
            *("controllers.*.services.*.effect", "control.hardware.*.effects.*"),
        )
    },
}
"""Key, ``*`` for a name or a number → what it can be: far beyond the machines of the catalog on both sides."""


def implausible_figures(model: DeviceModel, description: Description, document: SourceDocument) -> Iterator[Diagnostic]:
    """Yield a warning for each figure that no machine has, and for those that do not fit each other."""
    for path, number, linear in _numbers(model, ()):
        span = RANGES.get(_key(path))
        if span is not None:
            least, most = span.linear if linear and span.linear is not None else (span.least, span.most)
            if not least <= number <= most:
                bounds = f"from {least:.3g} to {most:.3g} in SI units"
                yield _found(f"`{'.'.join(map(str, path))}` must be {bounds}, got {number:.3g}", path, document)
    of_joints = _of_joints(model, description)
    for path, message in (*of_joints, *_pairs(model), *_reach(model, description)):
        yield _found(message, path, document)
    for path, message, other in camera_faults(model):
        yield _found(message, path, document, other)


_START_S = 10.0
"""Arms and axes are at full speed within two seconds, turntables of tonnes within ten."""


def _found(message: str, path: YamlPath, document: SourceDocument, other: YamlPath = ()) -> Diagnostic:
    advice = "correct the figure, or its unit"
    related = (Related("the other one", document.locate(other)),) if other else ()
    return Diagnostic(CODE, Severity.WARNING, message, document.locate(path), path, advice, related)


def _numbers(value: object, path: YamlPath) -> Iterator[tuple[YamlPath, float, bool]]:
    """Yield every number of a model with its place, in SI, and whether it is a length or what a length does."""
    if isinstance(value, BaseModel):
        for name in type(value).model_fields:
            yield from _numbers(getattr(value, name), (*path, name))
    elif isinstance(value, dict):
        for name, inner in value.items():
            yield from _numbers(inner, (*path, name))
    elif isinstance(value, (tuple, list)):
        for index, inner in enumerate(value):
            yield from _numbers(inner, (*path, index))
    elif isinstance(value, Quantity):
        yield path, value.si, value.linear
    elif isinstance(value, QuantityVector):
        yield from ((path, number, True) for number in value.si)
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield path, float(value), False


def _key(path: YamlPath) -> str:
    """Return the key of the table that a place is, the place itself where the table has no such key."""
    for key in RANGES:
        pattern = key.split(".")
        if len(pattern) == len(path) and all(want in ("*", str(got)) for want, got in zip(pattern, path, strict=True)):
            return key
    return ".".join(map(str, path))


def _of_joints(model: DeviceModel, description: Description) -> Iterator[tuple[YamlPath, str]]:
    """Yield accelerations and jerks with which joints need less than a millisecond, or longer than drives do."""
    limits = model.limits
    for name, fact in limits.acceleration.items():
        own = [joint for joint in description.joints if name in (joint.name, EVERY_JOINT) and joint.limit is not None]
        speeds = [
            joint.limit.velocity for joint in own if joint.limit is not None and joint.slides == fact.value.linear
        ]
        velocity = max(filter(None, speeds), default=0.0)
        if velocity > 0.0 and fact.value.si > 0.0 and not 1e-3 <= velocity / fact.value.si <= _START_S:
            yield ("limits", "acceleration", name, "value"), _slow(name, "speed", velocity / fact.value.si)
    for name, jerk in limits.jerk.items():
        acceleration = limits.acceleration.get(name)
        if acceleration is not None and acceleration.value.linear == jerk.value.linear and jerk.value.si > 0.0:
            seconds = acceleration.value.si / jerk.value.si
            if not 1e-4 <= seconds <= _START_S:
                yield ("limits", "jerk", name, "value"), _slow(name, "acceleration", seconds)


def _slow(name: str, what: str, seconds: float) -> str:
    return f"`{name}` must reach its {what} within a millisecond to {_START_S:g} s, got {seconds:.3g} s"


def _pairs(model: DeviceModel) -> Iterator[tuple[YamlPath, str]]:
    """Yield the greater of two figures where it is the lesser: minima and maxima that were swapped."""
    for name, stream in ({} if model.camera is None else model.camera.streams).items():
        if stream.view is not None and stream.view.nearest.si >= stream.view.farthest.si:
            path: YamlPath = ("camera", "streams", name, "view", "nearest")
            yield (
                path,
                f"`nearest` must be below `farthest` {stream.view.farthest.text}, got {stream.view.nearest.text}",
            )
    gripper = model.gripper
    if gripper is not None and gripper.min_force is not None and gripper.min_force.si > gripper.max_force.si:
        got = gripper.min_force.text
        yield ("gripper", "min_force"), f"`min_force` must be at most `max_force` {gripper.max_force.text}, got {got}"


def _reach(model: DeviceModel, description: Description) -> Iterator[tuple[YamlPath, str]]:
    """Yield a reach that the description, straightened, does not have, or only a tenth of it."""
    if model.limits.reach is None:
        return
    length = sum(math.hypot(*joint.pose.position) for joint in description.joints)
    reach = model.limits.reach.value
    if length > 0.0 and not 0.05 * length <= reach.si <= 1.5 * length:
        message = f"`reach` must fit the description, which is {length:.3g} m long, got {reach.text}"
        yield ("limits", "reach", "value"), message
