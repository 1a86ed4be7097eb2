"""What the folder of a device excuses of its vendor's description, and for which joints that counts."""

from __future__ import annotations

from cellc.compiler.cell.device import Device
from cellc.compiler.graph.cell_graph import CellGraph


def spared(graph: CellGraph, device: Device, joint: str, code: str) -> bool:
    """Tell whether a finding is excused: where it is of a joint, only as long as no controller commands that joint.

    Args:
        joint: with its prefix; empty for a finding that is of none.
    """
    return code in device.body.excused and joint not in graph.once(_commanded)


def _commanded(graph: CellGraph) -> frozenset[str]:
    commanding = (controller for controller in graph.cell.controllers if controller.command_interfaces)
    return frozenset(joint for controller in commanding for joint in controller.joints)
