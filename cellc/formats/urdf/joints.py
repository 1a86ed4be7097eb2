"""Joints as URDF elements, with the limits of the cell in place of the device's own."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from cellc.cell.device import DeviceJoint
from cellc.description.model import Joint, JointDynamics, Mimic, SafetyController
from cellc.formats.numbers import settled, shortest
from cellc.formats.urdf.geometry import numbers, origin
from cellc.formats.xml_text import element
from cellc.transforms import Pose


def fixed_joint(name: str, parent: str, child: str, transform_child_to_parent: Pose) -> Element:
    """Return the joint that holds a mount, a frame or a box where it is."""
    return element(
        "joint",
        {"name": name, "type": "fixed"},
        [
            *origin(transform_child_to_parent),
            element("parent", {"link": parent}),
            element("child", {"link": child}),
        ],
    )


def device_joint(joint: Joint, limits: DeviceJoint | None) -> Element:
    """Return ``<joint>``; ``limits`` are those of the cell, None for a joint that does not move."""
    children = [
        *origin(joint.pose),
        element("parent", {"link": joint.parent}),
        element("child", {"link": joint.child}),
    ]
    if joint.type != "fixed":
        children.append(element("axis", {"xyz": numbers(settled(value) for value in joint.axis)}))
    if limits is not None:
        children.append(_limit(limits))
    if joint.mimic is not None:
        children.append(_mimic(joint.mimic))
    if joint.dynamics is not None:
        children.append(_dynamics(joint.dynamics))
    if joint.safety is not None:
        children.append(_safety(joint.safety))
    return element("joint", {"name": joint.name, "type": joint.type}, children)


def _limit(joint: DeviceJoint) -> Element:
    # urdfdom refuses a limit that lacks effort or velocity; a continuous joint has no lower and upper.
    values = {"lower": joint.lower, "upper": joint.upper} if joint.type != "continuous" else {}
    values |= {"velocity": joint.velocity, "effort": joint.effort}
    return element("limit", {name: shortest(value) for name, value in values.items() if value is not None})


def _mimic(mimic: Mimic) -> Element:
    factors = {"multiplier": mimic.multiplier, "offset": mimic.offset}
    return element("mimic", {"joint": mimic.joint} | {name: shortest(value) for name, value in factors.items()})


def _dynamics(dynamics: JointDynamics) -> Element:
    return element("dynamics", {"damping": shortest(dynamics.damping), "friction": shortest(dynamics.friction)})


def _safety(safety: SafetyController) -> Element:
    return element(
        "safety_controller",
        {
            "soft_lower_limit": shortest(safety.soft_lower),
            "soft_upper_limit": shortest(safety.soft_upper),
            "k_position": shortest(safety.k_position),
            "k_velocity": shortest(safety.k_velocity),
        },
    )
