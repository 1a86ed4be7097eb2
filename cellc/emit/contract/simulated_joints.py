"""Joints of the contract that the mock lets differ from ones that are where they were commanded at once."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from cellc.cell.cell import Cell
from cellc.contract.simulated_joint import ContractSimulatedJoint
from cellc.spec.devices import EVERY_JOINT, SimulatedJointSpec
from cellc.spec.quantity import Quantity


def simulated_joints(cell: Cell) -> dict[str, ContractSimulatedJoint]:
    """Return what the spec adds to joints, by joint; what it says of one joint counts before what it says of all."""
    found: dict[str, ContractSimulatedJoint] = {}
    for device in cell.devices:
        written = device.spec.simulated_joints
        for joint in device.actuated_joints:
            keys = (joint.name.removeprefix(device.prefix), EVERY_JOINT)
            if specs := [written[key] for key in keys if key in written]:
                found[joint.name] = _joint(specs)
    return found


def _joint(specs: Sequence[SimulatedJointSpec]) -> ContractSimulatedJoint:
    lag, noise = _first(spec.lag for spec in specs), _first(spec.noise for spec in specs)
    return ContractSimulatedJoint(
        lag_s=lag or 0.0, noise=noise or 0.0, max_velocity=_first(spec.velocity for spec in specs)
    )


def _first(written: Iterable[Quantity | None]) -> float | None:
    return next((value.si for value in written if value is not None), None)
