"""Frames and calibrations of the contract."""

from __future__ import annotations

from cellc.cell.cell import Cell
from cellc.cell.frame import Frame
from cellc.contract.contract import ContractCalibration, ContractFrame
from cellc.formats.contract_pose import contract_pose


def calibrations(cell: Cell) -> dict[str, ContractCalibration]:
    """Return every calibration with its revision."""
    return {
        name: ContractCalibration(revision=written.revision, owner=written.owner)
        for name, written in cell.spec.calibrations.items()
    }


def frames(cell: Cell) -> dict[str, ContractFrame]:
    """Return every frame by name."""
    return {frame.name: _frame(frame) for frame in cell.frames}


def _frame(frame: Frame) -> ContractFrame:
    pose = None if frame.moving else frame.transform_to_parent
    simulated = frame.simulated_pose
    return ContractFrame(
        parent=frame.parent,
        authority=frame.authority,
        kind=frame.kind.value,
        pose=None if pose is None else contract_pose(pose),
        calibration=frame.calibration,
        rate_hz=frame.rate_hz,
        buffer_s=frame.buffer_s,
        simulated_parent=None if simulated is None else simulated.parent,
        simulated_pose=None if simulated is None else contract_pose(simulated.pose),
    )
