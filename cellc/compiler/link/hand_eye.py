"""Poses from a hand-eye calibration file: the file is the only source, and the spec states the same pose or none.

The tool reports the pose of a frame on one side of the mount in a frame on the other side. Each side is rigid, so the
transform of the mount follows whichever frames the tool was configured with.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace

from cellc.compiler.cell.device import Device
from cellc.compiler.cell.frame import WORLD
from cellc.compiler.cell.site import CalibrationFile
from cellc.compiler.link.devices import BoundDevice
from cellc.compiler.link.frames import FrameNames
from cellc.compiler.link.hand_eye_file import CODE, HandEyeFile, read_hand_eye
from cellc.compiler.link.names import unknown_name
from cellc.compiler.link.quantities import pose
from cellc.compiler.link.side_file import read_side_file
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.devices import PlacementSpec
from cellc.compiler.spec.frames import CalibrationSpec, FrameSpec
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, Span, YamlPath, did_you_mean
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, apart, climb, identity

_FRAMES = "hand-eye-of-other-frames"
_DIFFERS = "hand-eye-differs"
_NEAR_M, _NEAR_RAD = 0.1e-3, 0.001
"""What a spec may round off: a tenth of a millimeter, a twentieth of a degree."""


@dataclass(frozen=True, slots=True)
class Measured:
    """Where files put things: the pose of a device's mount by its name, of a frame by its own, and the files."""

    mounts: Mapping[str, Pose]
    frames: Mapping[str, Pose]
    files: Mapping[str, CalibrationFile]


@dataclass(frozen=True, slots=True)
class _Edge:
    parent: str
    pose: Pose
    rigid: bool


@dataclass(frozen=True, slots=True)
class _Placed:
    """What a file measures: the frame that is placed, its parent, where the spec writes it, and what it writes."""

    child: str
    parent: str
    path: YamlPath
    written: PlacementSpec | FrameSpec


@dataclass(frozen=True, slots=True)
class _Read:
    """A file with the entry that names it."""

    name: str
    entry: CalibrationSpec
    said: HandEyeFile


def link_hand_eye(
    spec: CellSpec, document: SourceDocument, bound: tuple[BoundDevice, ...], names: FrameNames
) -> Outcome[Measured]:
    """Read the files of calibrations, and return where they put what rests on them."""
    mounts: dict[str, Pose] = {}
    frames: dict[str, Pose] = {}
    files: dict[str, CalibrationFile] = {}
    problems: list[Diagnostic] = []
    edges = _edges(spec, [device.device for device in bound], names)
    for name, entry in spec.calibrations.items():
        problems += _unknown_devices(name, entry, spec, document)
        if entry.from_ is None:
            problems += _without_file(name, entry, document)
            continue
        file = read_side_file(entry.from_, document, ("calibrations", name, "from"))
        said = Outcome[HandEyeFile](None) if file.value is None else read_hand_eye(file.value)
        problems += [*file.diagnostics, *said.diagnostics]
        if file.value is None or said.value is None:
            continue
        files[name] = CalibrationFile(path=file.value.path, sha256=file.value.sha256)
        for placed in _resting_on(name, spec, bound, names):
            pose = _place(placed, _Read(name, entry, said.value), edges, names, document)
            problems += pose.diagnostics
            if pose.value is not None:
                (mounts if placed.path[0] == "devices" else frames)[str(placed.path[1])] = pose.value
    return Outcome(Measured(mounts, frames, files), tuple(problems))


def with_mounts(bound: tuple[BoundDevice, ...], measured: Measured) -> tuple[BoundDevice, ...]:
    """Return the devices where files put them."""
    return tuple(
        replace(device, device=_mounted(device.device, measured.mounts[device.device.name]))
        if device.device.name in measured.mounts
        else device
        for device in bound
    )


def _mounted(device: Device, transform_root_to_parent: Pose) -> Device:
    return replace(device, mount=replace(device.mount, transform_root_to_parent=transform_root_to_parent))


def _unknown_devices(
    name: str, entry: CalibrationSpec, spec: CellSpec, document: SourceDocument
) -> Iterator[Diagnostic]:
    for device in entry.serials:
        if device not in spec.devices:
            path: YamlPath = ("calibrations", name, "serials", device)
            yield unknown_name("unknown-device", device, "device", spec.devices, document, path)


def _without_file(name: str, entry: CalibrationSpec, document: SourceDocument) -> Iterator[Diagnostic]:
    for key, stated in (("parent", entry.parent), ("child", entry.child)):
        if stated is not None:
            path: YamlPath = ("calibrations", name, key)
            message = f"`{key}` tells a frame of a file, and `{name}` names none"
            yield Diagnostic(CODE, Severity.ERROR, message, document.locate(path), path, "add `from:`, or remove it")


def _resting_on(name: str, spec: CellSpec, bound: tuple[BoundDevice, ...], names: FrameNames) -> Iterator[_Placed]:
    for device in (device.device for device in bound):
        mount = spec.devices[device.name].mount
        if mount is not None and mount.calibration == name:
            yield _Placed(device.body.root_link, device.mount.parent_frame, (*device.path, "mount"), mount)
    for frame, frame_spec in spec.frames.items():
        parent = names.by_reference.get(frame_spec.parent)
        if frame_spec.calibration == name and parent is not None and not frame_spec.dynamic:
            yield _Placed(frame, parent, ("frames", frame), frame_spec)


def _edges(spec: CellSpec, devices: list[Device], names: FrameNames) -> dict[str, _Edge]:
    """Return every frame with its parent; an edge is rigid unless a joint or a publisher moves it."""
    edges: dict[str, _Edge] = {}
    for device in devices:
        edges[device.body.root_link] = _Edge(
            device.mount.parent_frame, device.mount.transform_root_to_parent, rigid=True
        )
        for joint in device.body.description.joints:
            edges[joint.child] = _Edge(joint.parent, joint.pose, rigid=not joint.movable)
    for frame, frame_spec in spec.frames.items():
        parent = names.by_reference.get(frame_spec.parent)
        if parent is not None:
            still = not frame_spec.dynamic
            edges[frame] = _Edge(parent, pose(frame_spec.xyz, frame_spec.rpy) if still else identity(), rigid=still)
    return edges


def _place(
    placed: _Placed, read: _Read, edges: Mapping[str, _Edge], names: FrameNames, document: SourceDocument
) -> Outcome[Pose]:
    """Return the pose of what is placed in its parent, as the file has it."""
    said = read.said
    ends: list[str] = []
    for reported, stated in ((said.parent, read.entry.parent), (said.child, read.entry.child)):
        frame = _frame(stated or reported, names)
        if frame is None:
            return Outcome(None, (_unknown(stated or reported, read, names, document, stated is not None),))
        ends.append(frame)
    (parent, near), (child, far), (mount, at_mount) = (
        _climb(frame, edges, placed.child) for frame in (*ends, placed.parent)
    )
    measured = said.pose
    if parent == placed.child and child == mount:
        # The tool was configured with the frames swapped: their names give the direction of the transform.
        (parent, near), (child, far), measured = (child, far), (parent, near), measured.inverse()
    if (parent, child) != (mount, placed.child):
        return Outcome(None, (_elsewhere(placed, read, ends),))
    standing = not _moves(mount, edges)
    if said.in_hand is not None and said.in_hand is standing:
        return Outcome(None, (_other_mounting(placed, said, standing=standing),))
    pose = at_mount.inverse() @ near @ measured @ far.inverse()
    differs = _difference(placed, read, pose, document)
    return Outcome(None if differs else pose, differs)


def _frame(name: str | None, names: FrameNames) -> str | None:
    """Return a TF frame by its own name, or by that of the spec."""
    if name is None:
        return None
    return name if name in names.by_reference.values() else names.by_reference.get(name)


def _climb(frame: str, edges: Mapping[str, _Edge], cut: str) -> tuple[str, Pose]:
    """Return the frame at which what is rigid with a frame begins, and the pose of the frame in it; ``cut`` is one."""

    def rigid(child: str) -> tuple[str, Pose] | None:
        edge = edges.get(child)
        return (edge.parent, edge.pose) if edge is not None and edge.rigid else None

    return climb(frame, rigid, (cut,))


def _moves(top: str, edges: Mapping[str, _Edge]) -> bool:
    return top != WORLD and top in edges


def _unknown(name: str | None, read: _Read, names: FrameNames, document: SourceDocument, stated: bool) -> Diagnostic:
    path: YamlPath = ("calibrations", read.name)
    place: Span = document.locate(path) if stated or name is None else read.said.place
    if name is None:
        message = f"`{read.entry.from_}` names no frames, and `{read.name}` states no `parent` and `child`"
        return Diagnostic(_FRAMES, Severity.ERROR, message, place, path, "state both, as `device/link`")
    known = {*names.by_reference, *names.by_reference.values()}
    more = f"; or state `parent` and `child` of `{read.name}`"
    help_ = did_you_mean(name, known, "frames of this cell").and_more(more)
    return Diagnostic(_FRAMES, Severity.ERROR, f"there is no frame `{name}`", place, path, help_)


def _elsewhere(placed: _Placed, read: _Read, ends: list[str]) -> Diagnostic:
    message = (
        f"`{ends[1]}` in `{ends[0]}` does not give the pose of `{placed.child}` in `{placed.parent}`: "
        "one of the two must be rigid with each"
    )
    help_ = f"name the calibration of these frames, or state `parent` and `child` of `{read.name}`"
    return Diagnostic(_FRAMES, Severity.ERROR, message, read.said.place, placed.path, help_)


def _other_mounting(placed: _Placed, said: HandEyeFile, *, standing: bool) -> Diagnostic:
    calibrated = "in the hand" if said.in_hand else "beside the robot"
    there = "is stationary" if standing else "is moved by the robot"
    message = f"the calibration is of a camera {calibrated}, and `{placed.parent}` {there}"
    help_ = "name the file of this camera, or correct the mount"
    return Diagnostic(_FRAMES, Severity.ERROR, message, said.place, placed.path, help_)


def _difference(placed: _Placed, read: _Read, found: Pose, document: SourceDocument) -> tuple[Diagnostic, ...]:
    placement = placed.written
    if placement.xyz is None and placement.rpy is None:
        return ()
    stated = pose(placement.xyz, placement.rpy)
    distance, angle = apart(stated, found)
    if distance <= _NEAR_M and angle <= _NEAR_RAD:
        return ()
    path = (*placed.path, "xyz" if placement.xyz is not None else "rpy")
    off = f"{distance * 1000.0:.2f} mm and {math.degrees(angle):.2f} deg"
    message = f"`{placed.path[1]}` must stand where `{read.entry.from_}` has it, got {off} beside it"
    xyz = " ".join(f"{value * 1000.0:.2f}" for value in found.position)
    rpy = " ".join(f"{math.degrees(value):.3f}" for value in found.rpy())
    help_ = f"write neither `xyz` nor `rpy`, so that the file counts; it says `xyz: {xyz} mm, rpy: {rpy} deg`"
    return (Diagnostic(_DIFFERS, Severity.ERROR, message, document.locate(path), path, help_),)
