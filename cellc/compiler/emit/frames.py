"""``config/frames.yaml``: the frame tree for people and tools: parent, authority, calibration, transform.

No ROS node reads it: static frames come from the URDF, dynamic ones from their publishers. Transforms are in meters and
fixed-axis roll, pitch, yaw in radians; a frame that moves has the one at joint position zero, a dynamic one has none.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.frame import Frame
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.formats.numbers import rounded
from cellc.compiler.formats.yaml_text import Tree, render
from cellc.compiler.graph.cell_graph import CellGraph


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the frame tree."""
    calibrations: Tree = {"calibrations": {name: _calibration(graph.cell, name) for name in graph.cell.calibrations}}
    frames: Tree = {"frames": {frame.name: _frame(frame) for frame in graph.cell.frames}}
    sections = (
        "# calibrations\n",
        render(calibrations),
        "\n# frames, devices with their mounts, scene\n",
        render(frames),
    )
    yield Artifact("config/frames.yaml", plan.header.commented("#") + "".join(sections))


def _calibration(cell: Cell, name: str) -> Tree:
    stated = cell.calibrations[name]
    samples = {} if stated.samples is None else {"samples": stated.samples}
    residual = {} if stated.residual_m is None else {"residual_m": stated.residual_m}
    return {
        "revision": stated.revision,
        "measured": stated.measured,
        "method": stated.method,
        **samples,
        **residual,
        "owner": stated.owner,
        **({} if stated.file is None else {"file": stated.file.path, "sha256": stated.file.sha256}),
    }


def _frame(frame: Frame) -> Tree:
    calibration = {} if frame.calibration is None else {"calibration": frame.calibration}
    rate = {} if frame.rate_hz is None else {"rate_hz": frame.rate_hz}
    buffer = {} if frame.buffer_s is None else {"buffer_s": frame.buffer_s}
    parent = {"parent": frame.parent} if frame.parent else {}
    return {
        **parent,
        "kind": frame.kind.value,
        "authority": frame.authority,
        **calibration,
        **rate,
        **buffer,
        **_transform(frame),
    }


def _transform(frame: Frame) -> Tree:
    pose = frame.transform_to_parent
    if pose is None or not frame.parent:
        return {}
    return {"xyz": tuple(map(rounded, pose.position)), "rpy": tuple(map(rounded, pose.rpy()))}
