"""The security enclave of each process of a cell: the path of its keys in a keystore of SROS2."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import ControllerManager
from cellc.compiler.cell.interface import Node, NodeSource
from cellc.contract.diagnostics import YamlPath


def enclave_of(cell: Cell, node: Node) -> str:
    """Return the enclave of a node's process."""
    return f"/{cell.name}{node.full_name}"


def manager_enclave(cell: Cell, manager: ControllerManager) -> str:
    """Return the enclave of the process with a controller manager, its controllers and hardware."""
    return f"/{cell.name}{manager.namespace}/controller_manager"


def spawner_enclave(cell: Cell, manager: ControllerManager) -> str:
    """Return the enclave of the processes that load and activate a manager's controllers."""
    return f"/{cell.name}{manager.namespace}/spawner"


def people_enclave(cell: Cell) -> str:
    """Return the enclave of what people type at a shell while they pass the gates."""
    return f"/{cell.name}/people"


def commissioning_enclave(cell: Cell) -> str:
    """Return the enclave of the one command with which a person acts, where a gate or a recovery has it."""
    return f"/{cell.name}/commissioning"


def bring_up_enclave(cell: Cell) -> str:
    """Return the enclave of the program with which the bring-up waits, configures and activates."""
    return f"/{cell.name}/bring_up"


def first_goal_enclave(cell: Cell) -> str:
    """Return the enclave of the program that sends the first goal."""
    return f"/{cell.name}/first_goal"


def observe_enclave(cell: Cell) -> str:
    """Return the enclave of the program that compares the graph with the package, and only looks."""
    return f"/{cell.name}/observe"


def enclaves(cell: Cell) -> Iterator[tuple[str, YamlPath]]:
    """Yield the enclaves, each with the place in the spec that names it."""
    for node in cell.nodes:
        if node.source is not NodeSource.STANDARD or node.name != "controller_manager":
            yield enclave_of(cell, node), node.path
    for manager in cell.managers:
        yield manager_enclave(cell, manager), manager.path
        yield spawner_enclave(cell, manager), manager.path
    typed = (people_enclave(cell), commissioning_enclave(cell))
    for path in (*typed, bring_up_enclave(cell), first_goal_enclave(cell), observe_enclave(cell)):
        yield path, ("cell",)
