"""The configuration id: one name for calibration, TF publishers and URDF (chapter 4, TF and time gate 6)."""

from __future__ import annotations

import hashlib
import json

from cellc.cell.cell import Cell
from cellc.contract.manifest import ConfigurationInputs
from cellc.formats.urdf.robot import robot_description
from cellc.formats.xml_text import render

_DIGITS = 12


def configuration_inputs(cell: Cell) -> ConfigurationInputs:
    """Gather what the id is taken over; the same cell on another host gives the same."""
    urdf = render(robot_description(cell, "real"))
    return ConfigurationInputs(
        calibrations={name: written.revision for name, written in cell.spec.calibrations.items()},
        tf_publishers={frame.name: frame.authority for frame in cell.frames if frame.parent},
        urdf_sha256=hashlib.sha256(urdf.encode()).hexdigest(),
    )


def configuration_id(inputs: ConfigurationInputs) -> str:
    """Return ``cfg-`` and 12 hexadecimal digits; the order of calibrations and frames does not matter."""
    canonical = json.dumps(inputs.model_dump(), sort_keys=True, separators=(",", ":"))
    return "cfg-" + hashlib.sha256(canonical.encode()).hexdigest()[:_DIGITS]
