"""Binds the kinematics of one very robot: a file of its vendor's tool, and the description that is made with it."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import replace

from cellc.compiler.catalog.device_model import DeviceModel, KinematicsFacts
from cellc.compiler.catalog.load import CatalogDevice
from cellc.compiler.cell.body import KinematicCalibration, Kinematics
from cellc.compiler.link.names import Placeholders
from cellc.compiler.link.side_file import compose_side_file, number, read_side_file
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.devices import DeviceSpec, KinematicsSpec
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, YamlPath
from cellc.contract.transforms import Pose, apart, from_xyz_rpy
from cellc.robot.description.model import Description

_CODE = "invalid-kinematics"
_FIELDS = ("x", "y", "z", "roll", "pitch", "yaw")
_HASH = re.compile(r"[A-Za-z0-9_]{1,100}")
_LARGEST = 100.0
"""m or rad: no joint of a robot arm lies farther from the one before it."""


def link_kinematics(
    name: str, written: DeviceSpec, entry: CatalogDevice, known: Placeholders, document: SourceDocument
) -> Outcome[tuple[CatalogDevice, Kinematics | None]]:
    """Return the entry of a device and whose joints its description has; of a file that does not fit, what is wrong.

    Args:
        known: fills the placeholders of the catalog's texts.
    """
    facts, path = entry.model.kinematics, ("devices", name, "calibration")
    if facts is None:
        problem = None if written.calibration is None else _without_use(entry, document, path)
        return Outcome((entry, None), () if problem is None else (problem,))
    control = entry.model.control
    real = None if control is None else control.hardware.real
    nominal = "" if real is None else real.parameters.get(facts.hash_parameter, "")
    kinematics = Kinematics(
        tool=known.fill(facts.tool),
        command=facts.tool,
        package=facts.package,
        state=facts.state,
        nominal_hash=nominal,
    )
    if written.calibration is None:
        return Outcome((entry, kinematics))
    read = _read(written.calibration, document, path)
    if read.value is None:
        return Outcome((entry, kinematics), read.diagnostics)
    file, sha256, content = read.value
    problems = tuple(_problems(content, facts))
    if problems:
        return Outcome((entry, kinematics), problems)
    poses = {joint: _pose(content, (facts.root, part)) for part, joint in facts.joints.items()}
    calibration = KinematicCalibration(
        name=file,
        path=path,
        span=document.locate((*path, "file")),
        sha256=sha256,
        hash=content.text_at((facts.root, facts.hash)),
        measured=written.calibration.measured,
        owner=written.calibration.owner,
        offset_m=max(_offset(entry.description, joint, pose) for joint, pose in poses.items()),
        turn_rad=max(_turn(entry.description, joint, pose) for joint, pose in poses.items()),
    )
    joints = tuple(replace(joint, pose=poses.get(joint.name, joint.pose)) for joint in entry.description.joints)
    calibrated = CatalogDevice(entry.model, replace(entry.description, joints=joints))
    return Outcome((calibrated, replace(kinematics, calibration=calibration)))


def kinematic_parameters(kinematics: Kinematics | None, facts: DeviceModel) -> dict[str, str]:
    """Return what the real plugin gets of a calibration: the hash of its table."""
    calibration = None if kinematics is None else kinematics.calibration
    return (
        {} if calibration is None or facts.kinematics is None else {facts.kinematics.hash_parameter: calibration.hash}
    )


def _without_use(entry: CatalogDevice, document: SourceDocument, path: YamlPath) -> Diagnostic:
    message = f"the catalog does not say how a calibration of `{entry.model.model}` is read"
    advice = "remove it, or write `kinematics:` in its device.yaml"
    return Diagnostic(_CODE, Severity.ERROR, message, document.locate_key(path), path, advice)


def _read(
    written: KinematicsSpec, document: SourceDocument, path: YamlPath
) -> Outcome[tuple[str, str, SourceDocument]]:
    """Return the path of a file from the root spec's folder, the hash of its bytes, and its data."""
    file = read_side_file(written.file, document, (*path, "file"))
    if file.value is None:
        return Outcome(None, file.diagnostics)
    content = compose_side_file(file.value)
    if content.value is None:
        return Outcome(None, content.diagnostics)
    return Outcome((file.value.path, file.value.sha256, content.value))


def _problems(content: SourceDocument, facts: KinematicsFacts) -> Iterator[Diagnostic]:
    """Yield what a file lacks of the form that the catalog tells, and figures that no robot has."""
    if not content.has((facts.root,)):
        yield _wrong(content, (), f"`{facts.root}` is missing: this is not a file of `{facts.tool.split()[0]}`")
        return
    for part in facts.joints:
        for name in _FIELDS:
            at: YamlPath = (facts.root, part, name)
            named = f"{facts.root}.{part}.{name}"
            if not content.has(at):
                yield _wrong(content, at, f"`{named}` is missing")
            elif math.isnan(_number(content, at)):
                unit = "m" if name in "xyz" else "rad"
                value = content.text_at(at)
                bounds = f"a number between -{_LARGEST:g} and {_LARGEST:g} {unit}"
                yield _wrong(content, at, f"`{named}` must be {bounds}, got `{value}`")
    of_hash: YamlPath = (facts.root, facts.hash)
    hash_text = content.text_at(of_hash)
    if _HASH.fullmatch(hash_text) is None:
        yield _wrong(
            content, of_hash, f"`{facts.root}.{facts.hash}` must be letters, digits and underscores, got `{hash_text}`"
        )


def _wrong(content: SourceDocument, at: YamlPath, message: str) -> Diagnostic:
    return Diagnostic(_CODE, Severity.ERROR, message, content.locate(at), help="read it off the robot again")


def _number(content: SourceDocument, at: YamlPath) -> float:
    return number(content.text_at(at), _LARGEST)


def _pose(content: SourceDocument, at: YamlPath) -> Pose:
    x, y, z, roll, pitch, yaw = (_number(content, (*at, name)) for name in _FIELDS)
    return from_xyz_rpy((x, y, z), (roll, pitch, yaw))


def _offset(description: Description, joint: str, pose: Pose) -> float:
    return math.dist(_nominal(description, joint).position, pose.position)


def _turn(description: Description, joint: str, pose: Pose) -> float:
    """Return the angle between a joint's frame and that of the type, in rad."""
    return apart(_nominal(description, joint), pose)[1]


def _nominal(description: Description, joint: str) -> Pose:
    nominal = description.joint(joint)
    assert nominal is not None  # the names of an entry are held against its description as it is read
    return nominal.pose
