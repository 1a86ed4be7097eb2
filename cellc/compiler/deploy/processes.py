"""Which processes a cell starts: where each runs, which ask for motion, and the security enclave of each."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import ControllerManager
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.hardware import OfferedInterface
from cellc.compiler.cell.interface import Node, NodeSource
from cellc.compiler.deploy.files import is_planner, is_servo
from cellc.compiler.link.frames import ROBOT_STATE_PUBLISHER
from cellc.compiler.link.nodes import DESCRIPTION_PUBLISHER, description_home
from cellc.contract.bring_up import BringUp
from cellc.contract.entities import TARGETS
from cellc.contract.vocabulary import BringUpPhase, Feature, Motion, features


def launch_hosts(cell: Cell) -> tuple[str, ...]:
    """Return the hosts on which something is started, in the order of the spec; empty where all runs in one place."""
    hosts = used_hosts(cell)
    return hosts if len(hosts) > 1 else ()


def used_hosts(cell: Cell) -> tuple[str, ...]:
    """Return the hosts on which something is started, in the order of the spec; empty where the spec states none."""
    used = {node.host for node in cell.nodes} | {manager.host for manager in cell.managers}
    return tuple(host for host in cell.hosts if host in used)


def description_nodes(cell: Cell) -> tuple[str, ...]:
    """Return the nodes whose parameter ``robot_description`` is what the managers run, each once.

    Managers may have been started on several hosts, each with a target of its own: one answer does not tell of all.
    """
    return tuple(dict.fromkeys(_node(cell, manager) for manager in cell.managers))


def _node(cell: Cell, manager: ControllerManager) -> str:
    if Feature.DESCRIPTION_TOPIC not in features(cell.distro):  # the manager has it as a parameter
        return manager.node
    if len(cell.managers) > 1:
        return f"{description_home(manager)}/{DESCRIPTION_PUBLISHER}"
    return f"/{ROBOT_STATE_PUBLISHER}"


def beside_mock(cell: Cell) -> tuple[Node, ...]:
    """Return the nodes that may run beside a mock: those that the spec names, but no planner and no bridge."""
    named = (node for node in cell.nodes if node.source is NodeSource.SPEC and not node.is_bridge)
    return tuple(node for node in named if not is_planner(node) and not is_servo(cell, node))


def asks_for_motion(cell: Cell, node: Node) -> bool:
    """Return whether a node of the spec sends goals or commands of its own accord.

    A node that serves an action itself, such as a planner, acts on request; one with neither moves nothing.
    """
    return node.full_name in cell.mover_names


def is_adapter(cell: Cell, node: Node) -> bool:
    """Tell whether a node is the adapter of a device: configured it reads, and active it is a claim."""
    return any(adapted.node == node.full_name for adapted in cell.adapters)


def adapted_devices(cell: Cell) -> frozenset[str]:
    """Return the devices that an adapter moves instead of their driver: nothing of that driver runs."""
    return frozenset(adapter.device for adapter in cell.adapters)


def started_by_a_person(cell: Cell, node: Node) -> bool:
    """Tell whether a node runs only from the gate before motion on; a managed mover runs earlier, unactivated."""
    return asks_for_motion(cell, node) and not node.lifecycle


def motion_clients(cell: Cell) -> tuple[Node, ...]:
    """Return the nodes that a person starts or activates before anything moves."""
    return cell.movers


def past_controllers(cell: Cell) -> Iterator[tuple[Device, OfferedInterface, str]]:
    """Yield the driver's interfaces that move its device past every controller, with what a call does.

    Interfaces that the cell names have their clients in the spec; the others have no client in the cell.
    """
    named = {interface.name for interface in cell.interfaces}
    for device in cell.devices:
        for offer in device.control.offers:
            if offer.effect is not None and offer.effect.motion is Motion.MOVES and offer.name not in named:
                yield device, offer, offer.effect.does


def bring_up_nodes(plan: BringUp) -> tuple[str, ...]:
    """Return the names that the program of the bring-up gives its node: after the last phase that it takes."""
    taken = {step.phase for target in TARGETS for step in plan.steps(target)}
    return tuple(f"bring_up_{phase}" for phase in BringUpPhase if phase in taken)
