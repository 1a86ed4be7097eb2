"""Paths inside the generated package that several artifacts refer to."""

from __future__ import annotations

from cellc.cell.cell import Cell
from cellc.cell.control import ControllerManager
from cellc.cell.interface import Node

REHEARSALS = "rehearsals.json"
"""What the mock executes."""

RECORDING = "config/recording_qos.yaml"
"""QoS with which an attempt is recorded."""

QOS_OVERRIDES = "config/qos_overrides.yaml"
"""QoS of the nodes that the spec names."""


def description_file(cell: Cell, target: str) -> str:
    """Return the path of the URDF for ``mock`` or ``real``."""
    return f"urdf/{cell.name}.{target}.urdf"


def manager_description_file(cell: Cell, manager: ControllerManager, target: str) -> str:
    """Return the path of the URDF that a controller manager reads: the cell's, or one with its own hardware alone."""
    return f"urdf/{cell.name}{'' if len(cell.managers) == 1 else f'.{manager.name}'}.{target}.urdf"


def controllers_file(cell: Cell, manager: ControllerManager) -> str:
    """Return the path of a controller manager's parameter file."""
    return "config/controllers.yaml" if len(cell.managers) == 1 else f"config/{manager.name}.controllers.yaml"


def node_file(node: Node) -> str:
    """Return the path of a node's parameter file; there is none for a node without parameters."""
    return f"config/{node.full_name.lstrip('/').replace('/', '.')}.yaml"
