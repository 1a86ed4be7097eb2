"""Faults of a device behind an adapter, asked for in the words in which those of ros2_control's hardware are."""

from __future__ import annotations

from dataclasses import replace

from cellc.mock.adapter.simulated import SimulatedAdapter
from cellc.mock.control.hardware.disturbances import JointFault


class AdapterDisturbances:
    """Switches faults of one device on and off; its component is the device itself."""

    def __init__(self, adapter: SimulatedAdapter) -> None:
        """Bind the healthy device."""
        self._adapter = adapter

    def stick(self, joint: str) -> None:
        """Let a joint stand still whatever is commanded."""
        self._adapter.disturb(joint, replace(self._fault(joint), stuck=True))

    def slow(self, joint: str, max_velocity: float) -> None:
        """Let a joint not exceed a velocity (rad/s or m/s)."""
        self._adapter.disturb(joint, replace(self._fault(joint), max_velocity=max_velocity))

    def offset(self, joint: str, offset: float) -> None:
        """Let a joint stand beside its command by a constant (rad or m)."""
        self._adapter.disturb(joint, replace(self._fault(joint), offset=offset))

    def clear(self, joint: str) -> None:
        """Let a joint be healthy again."""
        self._adapter.disturb(joint, JointFault())

    def protective_stop(self, component: str) -> None:
        """Let the safety of the device stop it."""
        self._adapter.trip(f"safety stop of {component}")

    def recover(self, component: str) -> None:
        """Leave a stop whose reason is over, and take commands again; the joints stay where they stand."""
        self._adapter.release()
        self._adapter.acknowledge()
        self._adapter.activate()

    def _fault(self, joint: str) -> JointFault:
        return self._adapter.joint_faults.get(joint, JointFault())
