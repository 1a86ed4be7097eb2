"""States in which a device stops by itself: those that its vendor names, or those of every recovery."""

from __future__ import annotations

from cellc.compiler.cell.device import Device
from cellc.compiler.cell.hardware import Effect
from cellc.compiler.cell.site import STOPPED
from cellc.compiler.cell.vendor import SafetyState
from cellc.contract.vocabulary import GateCode


def stops_of(device: Device) -> tuple[SafetyState, ...]:
    """Return the states that stop a device; of one whose folder names no state, those that every cell recovers from."""
    if device.procedures.safety.states or not (device.control.is_driven and device.actuated_joints):
        return tuple(state for state in device.procedures.safety.states if state.stops)
    return tuple(SafetyState(name=name, stops=True, reported=None, gate=GateCode.G4) for name in STOPPED)


def effect_of(device: Device, state: SafetyState) -> Effect | None:
    """Return what a stop does; None where no source says it."""
    return None if device.control.hardware is None else device.control.hardware.effects.get(state.moment)
