"""The descriptions and the frames for people, against the description and the frames that are executed."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from cellc.contract.contract import ContractFrame
from cellc.contract.quantities import LARGEST
from cellc.contract.transforms import Pose, from_xyz_rpy
from cellc.mock.agreement.said import Edited, Names, Said, below, differing, plain
from cellc.mock.errors import MockError
from cellc.robot.description.model import Description, Joint, JointLimit
from cellc.robot.description.urdf_reader import read_urdf

_ANGLE = 1e-9
_OF_CALIBRATIONS = ("revision", "owner")


def limits(edited: Edited, _: str) -> Iterator[str]:
    """Compare limits of the executed URDF, which the controller manager reads, with those that the mock plans with."""
    for name, own in edited.contract.joint_limits.items():
        joint = edited.description.joint(name)
        if joint is not None:
            limit = joint.limit or JointLimit(None, None, None, None)
            said = {"velocity": _bounded(limit.velocity)}
            executed: dict[str, Said] = {"velocity": own.velocity}
            if joint.type != "continuous":
                said |= {"lower": _bounded(limit.lower), "upper": _bounded(limit.upper)}
                executed |= {"lower": _bounded(own.lower, -LARGEST), "upper": _bounded(own.upper, LARGEST)}
            yield from differing(said, executed, f"joint {name} limit ")


def _bounded(value: float | None, otherwise: float | None = None) -> Said:
    return otherwise if value is None else max(-LARGEST, min(LARGEST, value))


def other_description(edited: Edited, file: str) -> Iterator[str]:
    """Compare a description that is not executed, of the real target or of one manager, with the one that is."""
    read = read_urdf(edited.texts[file], file)
    if read.value is None:
        found = read.diagnostics[0]
        raise MockError(file, f"line {found.span.line}: {found.message}")
    by = edited.contract.files.urdf_mock
    said, executed = _parts(read.value), _parts(edited.description)
    for name in (*executed, *(text for text in said if text not in executed)):
        if said.get(name) != executed.get(name):
            yield f"{name} must be as in `{by}`"
    components = {component.name: component for component in edited.description.hardware}
    for component in read.value.hardware:
        if component.name not in components:
            yield f'`<ros2_control name="{component.name}">` must be a hardware component of `{by}`'
        else:
            joints = sorted(part.name for part in component.joints)
            wanted = sorted(part.name for part in components[component.name].joints)
            yield from differing({"joints": joints}, {"joints": wanted}, f"ros2_control {component.name} ", by)
    if read.value.hardware_error:
        yield read.value.hardware_error


def _parts(description: Description) -> dict[str, object]:
    """Return links and joints by what messages call them, without their places in the file and their looks."""
    links = {f"link `{link.name}`": replace(link, visuals=(), span=None) for link in description.links}
    return {**links, **{f"joint `{joint.name}`": replace(joint, span=None) for joint in description.joints}}


def frames(edited: Edited, file: str) -> Iterator[str]:
    """Compare the frame tree for people with the contract and the executed URDF."""
    said = plain(file, edited.texts[file])
    contract = edited.contract
    calibrations = {
        f"{name}.{field}": value
        for name, one in contract.calibrations.items()
        for field, value in (("revision", one.revision), ("owner", one.owner))
    }
    of_people = below(said, "calibrations.")
    compared = {name: value for name, value in of_people.items() if name.endswith(_OF_CALIBRATIONS)}
    yield from differing(compared, calibrations, "calibrations.")
    joints = {joint.child: joint for joint in edited.description.joints}
    stated = below(said, "frames.")
    for name, frame in contract.frames.items():
        own = below(stated, f"{name}.")
        executed, pose = _executed(frame), _pose(frame, joints.get(name))
        yield from differing({key: own[key] for key in own if key not in ("xyz", "rpy")}, executed, f"frames.{name}.")
        yield from _transform(name, own, pose)
    known = {name.rpartition(".")[0] for name in stated}
    for name in sorted(known - contract.frames.keys()):
        yield f"`frames.{name}` must be a frame of `contract.json`"


def _executed(frame: ContractFrame) -> Names:
    stated: dict[str, Said] = {
        "parent": frame.parent or None,
        "kind": frame.kind,
        "authority": frame.authority,
        "calibration": frame.calibration,
        "rate_hz": frame.rate_hz,
        "buffer_s": frame.buffer_s,
    }
    return {name: value for name, value in stated.items() if value is not None}


def _pose(frame: ContractFrame, joint: Joint | None) -> Pose | None:
    if joint is not None:
        return joint.pose
    if frame.pose is None:
        return None
    return Pose(frame.pose.xyz, frame.pose.quaternion)


def _transform(name: str, own: Names, pose: Pose | None) -> Iterator[str]:
    said = _read_pose(own)
    if pose is None:
        if said is not None:
            yield f"`frames.{name}` must have no transform: its publisher tells it"
    elif said is None or not _close(said, pose):
        xyz, rpy = (", ".join(f"{value:.9g}" for value in part) for part in (pose.position, pose.rpy()))
        yield f"`frames.{name}` must have xyz ({xyz}) and rpy ({rpy}), as is executed"


def _read_pose(own: Names) -> Pose | None:
    xyz, rpy = _three(own.get("xyz")), _three(own.get("rpy"))
    return None if xyz is None or rpy is None else from_xyz_rpy(xyz, rpy)


def _three(value: Said) -> tuple[float, float, float] | None:
    if not isinstance(value, Sequence) or isinstance(value, str) or len(value) != 3:
        return None
    x, y, z = (part if isinstance(part, (int, float)) else math.nan for part in value)
    return (x, y, z)


def _close(one: Pose, other: Pose) -> bool:
    """Tell whether two poses are the same but for digits; q and -q are one rotation."""
    turned = abs(sum(a * b for a, b in zip(one.quaternion, other.quaternion, strict=True)))
    moved = math.dist(one.position, other.position)
    return moved <= _ANGLE and turned >= 1.0 - 1e-13
