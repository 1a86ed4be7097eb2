"""Adapters of the contract: devices that their vendor's library drives, with the bounds of their commands."""

from __future__ import annotations

from cellc.cell.cell import Cell
from cellc.contract.adapter import ContractAdapter
from cellc.formats.urdf.robot import start_positions
from cellc.graph.adapters import AdaptedDevice, adapted_devices
from cellc.spec.devices import AdapterSpec
from cellc.spec.quantity import Quantity

DEFAULT_RATE_HZ = 100.0
"""Of a state topic without a rate; a rule asks for one."""
DEFAULT_TIMEOUT_PERIODS = 10.0
"""Watchdog of an adapter that states none, in command periods."""
DEFAULT_STOP_S = 0.1
"""Time to standstill of an adapter that states none."""


def adapters(cell: Cell) -> dict[str, ContractAdapter]:
    """Return every adapted device by its name."""
    start = start_positions(cell)
    return {adapted.device.name: _adapter(adapted, start) for adapted in adapted_devices(cell)}


def _adapter(adapted: AdaptedDevice, start: dict[str, float]) -> ContractAdapter:
    joints = adapted.device.actuated_joints
    written = adapted.device.spec.adapter or AdapterSpec()
    period_s = 1.0 / (adapted.state.rate_hz or DEFAULT_RATE_HZ)
    return ContractAdapter.model_validate(
        {
            "joints": tuple(joint.name for joint in joints),
            "units": tuple("m" if joint.type == "prismatic" else "rad" for joint in joints),
            "action": adapted.action.name,
            "state_topic": adapted.state.name,
            "client": next((sink.node for sink in adapted.action.sinks), None),
            "command_period_s": period_s,
            "command_timeout_s": _or(written.command_timeout, DEFAULT_TIMEOUT_PERIODS * period_s),
            "stop_time_s": _or(written.stop_time, DEFAULT_STOP_S),
            "start_positions": tuple(start.get(joint.name, 0.0) for joint in joints),
        }
    )


def _or(written: Quantity | None, default: float) -> float:
    return default if written is None else written.si
