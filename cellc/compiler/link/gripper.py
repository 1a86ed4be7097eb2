"""The gripper that a device is, as its joint moves it: by its data sheet, and as the spec has it grip."""

from __future__ import annotations

from cellc.compiler.catalog.device_model import DeviceModel, GripperFacts
from cellc.compiler.cell.device import Gripper
from cellc.compiler.link.quantities import si
from cellc.compiler.spec.devices import DeviceSpec, GripSpec


def gripper_of(facts: DeviceModel, written: DeviceSpec, prefix: str) -> Gripper | None:
    """Return the gripper that the device is, with the speed and force that the spec states."""
    gripper, stated = facts.gripper, written.grip or GripSpec()
    if gripper is None:
        return None
    speed = gripper.max_speed.si if stated.speed is None else min(stated.speed.si, gripper.max_speed.si)
    return Gripper(
        joint=prefix + gripper.joint,
        open=gripper.open.si,
        closed=gripper.closed.si,
        max_force=gripper.max_force.si,
        max_velocity=_joint_speed(gripper, speed),
        goal_tolerance=float(gripper.goal_tolerance.si),
        stroke_m=gripper.stroke.si,
        swing=si(gripper.swing),
        max_speed_m_s=gripper.max_speed.si,
        min_force=si(gripper.min_force),
        grip_speed_m_s=si(stated.speed),
        grip_force=si(stated.force),
    )


def _joint_speed(gripper: GripperFacts, speed_m_s: float) -> float | None:
    """Return the joint speed that corresponds to a speed of the jaws, in rad/s or m/s; None where it has no value.

    Jaw travel is taken as linear in the joint position. The limit in a vendor's URDF differs, and was not measured.
    """
    way, stroke = abs(float(gripper.closed.si) - float(gripper.open.si)), gripper.stroke.si
    return speed_m_s * way / stroke or None if stroke > 0.0 else None
