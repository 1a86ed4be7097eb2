"""Names of the security enclaves, as the policy declares them and the launch file uses them."""

from __future__ import annotations

from cellc.cell.cell import Cell
from cellc.cell.control import ControllerManager
from cellc.cell.interface import Node


def enclave_of(cell: Cell, node: Node) -> str:
    """Return the enclave of a node's process."""
    return f"/{cell.name}{node.full_name}"


def manager_enclave(cell: Cell, manager: ControllerManager) -> str:
    """Return the enclave of the process with a controller manager, its controllers and hardware."""
    return f"/{cell.name}{manager.namespace}/controller_manager"


def spawner_enclave(cell: Cell, manager: ControllerManager) -> str:
    """Return the enclave of the processes that load and activate a manager's controllers."""
    return f"/{cell.name}{manager.namespace}/spawner"


def bring_up_enclave(cell: Cell) -> str:
    """Return the enclave of the command-line tools with which the bring-up waits, configures and activates."""
    return f"/{cell.name}/bring_up"
