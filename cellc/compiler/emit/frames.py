"""``config/frames.yaml``: the frame tree for people and tools: parent, authority, calibration, transform.

No ROS node reads it: static frames come from the URDF, dynamic ones from their publishers. Transforms are in meters and
fixed-axis roll, pitch, yaw in radians; a frame that moves has the one at joint position zero, a dynamic one has none.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.frame import Frame
from cellc.compiler.cell.interface import ParameterValue
from cellc.compiler.cell.site import Calibration
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.formats.numbers import rounded
from cellc.compiler.formats.yaml_text import render_rows
from cellc.compiler.graph.cell_graph import CellGraph

Row = dict[str, ParameterValue]


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the frame tree."""
    calibrations = {name: _calibration(calibration) for name, calibration in graph.cell.calibrations.items()}
    frames = {frame.name: _frame(frame) for frame in graph.cell.frames}
    sections = (
        f"# {origin}\n{key}:\n{render_rows(rows, 1)}"
        for key, origin, rows in (
            ("calibrations", "calibrations", calibrations),
            ("frames", "frames, devices with their mounts, scene", frames),
        )
        if rows
    )
    yield Artifact("config/frames.yaml", plan.header.commented("#") + "\n".join(sections))


def _calibration(calibration: Calibration) -> Row:
    file = calibration.file
    return _stated(
        revision=calibration.revision,
        measured=calibration.measured,
        method=calibration.method,
        samples=calibration.samples,
        residual_m=calibration.residual_m,
        owner=calibration.owner,
        serials=tuple(f"{name} {serial}" for name, serial in calibration.serials.items()) or None,
        file=None if file is None else file.path,
        sha256=None if file is None else file.sha256,
    )


def _frame(frame: Frame) -> Row:
    pose = frame.transform_to_parent if frame.parent else None
    return _stated(
        parent=frame.parent or None,
        kind=frame.kind.value,
        authority=frame.authority,
        calibration=frame.calibration,
        rate_hz=frame.rate_hz,
        buffer_s=frame.buffer_s,
        xyz=None if pose is None else tuple(map(rounded, pose.position)),
        rpy=None if pose is None else tuple(map(rounded, pose.rpy())),
    )


def _stated(**values: ParameterValue | None) -> Row:
    return {name: value for name, value in values.items() if value is not None}
