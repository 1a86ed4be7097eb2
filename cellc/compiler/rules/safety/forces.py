"""Bounds of forces: thresholds against what the joints can give, and springs against arms."""

from __future__ import annotations

import math
from collections.abc import Iterator

from cellc.compiler.cell.device import Device
from cellc.compiler.cell.robot import Thresholds
from cellc.compiler.graph.commissioning import chain_of
from cellc.compiler.rules.bounds import Bound, Figure, outside, stated
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, YamlPath, rule

_Owners = Iterator[tuple[YamlPath, object]]


def _collisions(graph: CellGraph, kind: str) -> Iterator[tuple[Device, YamlPath, Thresholds]]:
    for device in graph.cell.devices:
        if device.robot.collision is not None:
            yield device, (*device.path, "collision", kind), getattr(device.robot.collision, kind)


def _torques(graph: CellGraph) -> Iterator[Figure]:
    """Yield the largest share of the torque of its joint that a threshold is, and the smallest."""
    for device, path, thresholds in _collisions(graph, "torque"):
        efforts = [joint.effort for joint in device.actuated_joints]
        for key, values in (("lower", thresholds.lower), ("upper", thresholds.upper)):
            shares = [value / effort for value, effort in zip(values, efforts, strict=False) if effort]
            for share in (min(shares, default=1.0), max(shares, default=1.0)):
                yield Figure((*path, key), share, 5e-3, 2.5)


def _at_tool(graph: CellGraph) -> Iterator[Figure]:
    """Yield the thresholds at the tool against what the strongest joint gives there: moments, and forces at reach."""
    for kind, least in (("force", 1.0), ("moment", 0.2)):
        for device, path, thresholds in _collisions(graph, kind):
            strongest = max((joint.effort or 0.0 for joint in device.actuated_joints), default=0.0)
            reach = min((chain_of(graph, group).length for group in graph.cell.groups), default=1.0)
            most = strongest * (2.0 / max(reach, 0.1) if kind == "force" else 1.0)
            for key, values in (("lower", thresholds.lower), ("upper", thresholds.upper)):
                for value in (min(values), max(values)):
                    yield Figure((*path, key), value, least, most or math.inf, unit="N" if kind == "force" else "N m")


def _grips(graph: CellGraph) -> Iterator[Figure]:
    for device in graph.cell.devices:
        gripper = device.gripper
        if gripper is not None and gripper.grip_force is not None:
            yield Figure((*device.path, "grip", "force"), gripper.grip_force, gripper.max_force / 200.0)
    caps, assessed = graph.cell.bringup.caps, graph.cell.safety.risk_assessment
    if caps is not None and caps.force is not None:
        yield Figure(("bringup", "commissioning", "force"), caps.force, 0.5)
    if assessed is not None and assessed.force is not None:
        yield Figure(("safety", "risk_assessment", "force"), assessed.force, 1.0, 2000.0)


def _adapters(graph: CellGraph) -> _Owners:
    for device in graph.cell.devices:
        if device.control.adapter is not None:
            yield (*device.path, "adapter"), device.control.adapter


def _impedances(graph: CellGraph) -> _Owners:
    for device in graph.cell.devices:
        if device.robot.impedance is not None:
            yield (*device.path, "impedance"), device.robot.impedance


def _cartesian(graph: CellGraph) -> _Owners:
    for device in graph.cell.devices:
        if device.robot.impedance is not None and device.robot.impedance.cartesian is not None:
            yield (*device.path, "impedance", "cartesian"), device.robot.impedance.cartesian


def _settling(graph: CellGraph) -> Iterator[Figure]:
    """Yield the slowest and the fastest time constant, damping by stiffness, of what holds the joints of a device."""
    for device in graph.cell.devices:
        adapter, impedance = device.control.adapter, device.robot.impedance
        springs = [
            ("adapter", adapter.stiffness, adapter.damping) if adapter is not None else None,
            ("impedance", impedance.joint, impedance.damping) if impedance is not None else None,
        ]
        for key, stiffness, damping in filter(None, springs):
            pairs = zip(stiffness or (), damping or (), strict=False)
            times = [by / spring for spring, by in pairs if spring]
            for time in (min(times, default=0.01), max(times, default=0.01)):
                yield Figure((*device.path, key, "damping"), time, 1e-4, 2.0)


BOUNDS = (
    Bound(
        ("devices.*.collision.torque.lower", "devices.*.collision.torque.upper"),
        "the share of the torque of the joint",
        "%",
        "below which every motion stops, and above which no contact is seen",
        _torques,
    ),
    Bound(
        tuple(f"devices.*.collision.{kind}.{key}" for kind in ("force", "moment") for key in ("lower", "upper")),
        "the threshold",
        "N",
        "from what an arm measures to what its strongest joint gives at the tool",
        _at_tool,
    ),
    Bound(
        ("devices.*.grip.force", "bringup.commissioning.force", "safety.risk_assessment.force"),
        "`force`",
        "N",
        "what holds a part, and what a person withstands",
        _grips,
    ),
    stated("devices.*.adapter.stiffness", _adapters, "stiffness", 1.0, 1e5, "N m/rad", "what holds an arm"),
    stated("devices.*.impedance.joint", _impedances, "joint", 1.0, 1e5, "N m/rad", "what holds an arm"),
    stated(
        "devices.*.impedance.cartesian.translation", _cartesian, "translation", 5.0, 1e5, "N/m", "what holds a tool"
    ),
    stated("devices.*.impedance.cartesian.rotation", _cartesian, "rotation", 0.5, 1e4, "N m/rad", "what holds a tool"),
    Bound(
        ("devices.*.adapter.damping", "devices.*.impedance.damping"),
        "damping by stiffness",
        "s",
        "in which a joint comes to its command without swinging",
        _settling,
    ),
)


@rule(Severity.WARNING, assumes=("frame-cycle",), gives_way=True)
def implausible_force(graph: CellGraph) -> Findings:
    """Yield thresholds, forces and springs that the joints of the arm cannot mean."""
    yield from outside(graph, BOUNDS)
