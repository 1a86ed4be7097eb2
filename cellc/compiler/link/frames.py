"""Binds references to frames to their TF names, and every frame to its parent, its authority and its calibration."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from cellc.compiler.cell.device import Device
from cellc.compiler.cell.frame import WORLD, Frame, FrameKind, Grasp, SharedArea, SimulatedPose
from cellc.compiler.link.hopeless import until_hopeless
from cellc.compiler.link.names import unknown_name
from cellc.compiler.link.quantities import pose, si, vector
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.frames import FrameSpec, GraspSpec
from cellc.contract.diagnostics import Diagnostic, Outcome, YamlPath
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, identity


@dataclass(frozen=True, slots=True)
class FrameNames:
    """Every reference that the spec may write, with its TF frame."""

    by_reference: Mapping[str, str]
    document: SourceDocument

    def bind(self, reference: str, path: YamlPath) -> Outcome[str]:
        """Return the TF frame of a reference, or the diagnostic that it does not exist."""
        if reference in self.by_reference:
            return Outcome(self.by_reference[reference])
        known = self.by_reference
        return Outcome(None, (unknown_name("unknown-frame", reference, "frame", known, self.document, path),))


def name_frames(spec: CellSpec, document: SourceDocument, devices: Iterable[Device]) -> FrameNames:
    """Collect the frames of the world, of devices, of the spec's frames and of its scene."""
    names = {WORLD: WORLD}
    for device in devices:
        names |= {f"{device.name}/{short}": link for short, link in device.body.frames.items()}
    names |= {name: name for name in (*spec.frames, *spec.scene)}
    return FrameNames(names, document)


ROBOT_STATE_PUBLISHER = "robot_state_publisher"
"""Publishes every static frame, because all of them stand in the URDF: one authority."""


def link_frames(
    spec: CellSpec,
    document: SourceDocument,
    devices: tuple[Device, ...],
    names: FrameNames,
    measured: Mapping[str, Pose],
) -> Outcome[tuple[Frame, ...]]:
    """Bind the world, the links and mounts of devices, and the frames of the spec; scene boxes are frames too.

    Args:
        measured: the poses of frames that are from files of calibrations.
    """
    frames = [_world(document), *_device_frames(spec, document, devices)]
    problems: list[Diagnostic] = []
    for name, frame in until_hopeless(spec.frames.items(), problems):
        bound = _spec_frame(name, frame, document, names, measured.get(name))
        problems += [*bound.diagnostics, *_unknown_calibration(spec, document, ("frames", name), frame.calibration)]
        problems += _unknown_publisher(spec, document, name, frame)
        if bound.value is not None:
            frames.append(bound.value)
    for device, entry in spec.devices.items():
        if entry.mount is not None:
            at = ("devices", device, "mount")
            problems += _unknown_calibration(spec, document, at, entry.mount.calibration)
    return Outcome(tuple(frames), tuple(problems))


def link_areas(spec: CellSpec, document: SourceDocument, names: FrameNames) -> Outcome[tuple[SharedArea, ...]]:
    """Bind the volumes that several arms share."""
    areas: list[SharedArea] = []
    problems: list[Diagnostic] = []
    for name, area_spec in until_hopeless(spec.areas.items(), problems):
        path = ("areas", name)
        parent = names.bind(area_spec.parent, (*path, "parent"))
        problems += parent.diagnostics
        if parent.value is not None:
            area = SharedArea(
                name=name,
                path=path,
                span=document.locate(path),
                parent=parent.value,
                transform_to_parent=pose(area_spec.xyz, area_spec.rpy),
                size=vector(area_spec.box),
                granted_by=area_spec.granted_by,
                released=area_spec.released or "",
            )
            areas.append(area)
    return Outcome(tuple(areas), tuple(problems))


def _world(document: SourceDocument) -> Frame:
    return Frame(
        name=WORLD,
        path=("cell",),
        span=document.locate(("cell",)),
        kind=FrameKind.WORLD,
        parent="",
        transform_to_parent=identity(),
        authority=ROBOT_STATE_PUBLISHER,
        designed=True,
    )


def _device_frames(spec: CellSpec, document: SourceDocument, devices: Iterable[Device]) -> Iterator[Frame]:
    for device in devices:
        mount = spec.devices[device.name].mount
        path = (*device.path, "mount") if mount is not None else device.path
        yield Frame(
            name=device.body.root_link,
            path=path,
            span=document.locate(path),
            kind=FrameKind.MOUNT,
            parent=device.mount.parent_frame,
            transform_to_parent=device.mount.transform_root_to_parent,
            authority=ROBOT_STATE_PUBLISHER,
            device=device.name,
            calibration=None if mount is None else mount.calibration,
        )
        for joint in device.body.description.joints:
            yield Frame(
                name=joint.child,
                path=device.path,
                span=device.span,
                kind=FrameKind.LINK,
                parent=joint.parent,
                transform_to_parent=joint.pose,
                authority=ROBOT_STATE_PUBLISHER,
                device=device.name,
                designed=True,
                moving=joint.movable,
            )


def _spec_frame(
    name: str, written: FrameSpec, document: SourceDocument, names: FrameNames, measured: Pose | None
) -> Outcome[Frame]:
    path = ("frames", name)
    parent = names.bind(written.parent, (*path, "parent"))
    simulated = _simulated_pose(name, written, names)
    problems = (*parent.diagnostics, *simulated.diagnostics)
    if parent.value is None:
        return Outcome(None, problems)
    frame = Frame(
        name=name,
        path=path,
        span=document.locate(path),
        kind=FrameKind.DYNAMIC if written.dynamic else FrameKind.FIXED,
        parent=parent.value,
        transform_to_parent=None if written.dynamic else measured or pose(written.xyz, written.rpy),
        authority=written.published_by or ROBOT_STATE_PUBLISHER,
        calibration=written.calibration,
        designed=written.designed,
        moving=written.dynamic,
        rate_hz=si(written.rate),
        buffer_s=si(written.buffer),
        reference_points=written.reference_points,
        simulated_pose=simulated.value,
        grasp=None if written.grasp is None else _grasp(written.grasp),
    )
    return Outcome(frame, problems)


def _grasp(written: GraspSpec) -> Grasp:
    return Grasp(
        width_m=si(written.width),
        tolerance_m=si(written.tolerance),
        mass_kg=si(written.mass),
        size_m=None if written.size is None else vector(written.size),
        friction=written.friction,
    )


def _simulated_pose(name: str, written: FrameSpec, names: FrameNames) -> Outcome[SimulatedPose]:
    placed = written.simulated_pose
    if placed is None:
        return Outcome(None)
    parent = names.bind(placed.parent, ("frames", name, "simulated_pose", "parent"))
    if parent.value is None:
        return Outcome(None, parent.diagnostics)
    return Outcome(SimulatedPose(parent=parent.value, pose=pose(placed.xyz, placed.rpy)))


def _unknown_calibration(
    spec: CellSpec, document: SourceDocument, path: tuple[str, ...], calibration: str | None
) -> tuple[Diagnostic, ...]:
    if calibration is None or calibration in spec.calibrations:
        return ()
    at = (*path, "calibration")
    return (unknown_name("unknown-calibration", calibration, "calibration", spec.calibrations, document, at),)


def _unknown_publisher(
    spec: CellSpec, document: SourceDocument, name: str, written: FrameSpec
) -> tuple[Diagnostic, ...]:
    known = (*spec.nodes, *spec.devices)
    if written.published_by is None or written.published_by in known:
        return ()
    path = ("frames", name, "published_by")
    return (unknown_name("unknown-node", written.published_by, "node", known, document, path),)
