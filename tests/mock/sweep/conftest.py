"""A cell whose failures are known in closed form: one fixture of uncertain place, and one tolerance."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.mock import MockCell, load
from tests.cells import build_into, spec_text, written

RESIDUAL_M = 0.001
TOLERANCE_M = 0.0015

_MORE = """
calibrations:
  nest: {revision: 1, measured: 2026-07-02, method: touch probe, samples: 5, residual: 1 mm, owner: perception}
frames: {nest: {parent: world, xyz: 450 100 50 mm, calibration: nest, reference_points: 3}}
hosts: {pc: {clock: {domain: ros, synchronized_by: chrony, max_offset: 1 ms}}}
uncertainty: {tolerances: {put: 1.5 mm}, repeatability: {arm: 0 mm}}
"""


@pytest.fixture(scope="session")
def nest(nest_folder: Path) -> MockCell:
    """The cell, loaded."""
    return load(nest_folder)


@pytest.fixture(scope="session")
def nest_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What is generated of the cell."""
    folder = tmp_path_factory.mktemp("nest")
    text = spec_text("minimal").replace("cell: minimal", "cell: nest")
    text = text.replace(
        "rehearsals:\n", "  goals: {put: {frame: nest, rpy: 180 0 0 deg, xyz: 0 0 200 mm}}\nrehearsals:\n"
    )
    text += "  put: {steps: [{move: ready}, {move: put}], success: 85 %, confidence: 95 %}\n" + _MORE
    return build_into(folder / "generated", written(folder, text))
