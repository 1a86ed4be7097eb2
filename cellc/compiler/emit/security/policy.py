"""``security/policy.xml``: who may publish, subscribe, serve and call; everything else is denied.

SROS2 policy 0.2.0, read by ``ros2 security create_permission``. One enclave a node, one for the controller manager's
process with its controllers and hardware nodes, one for the spawners, one for the program of the bring-up, one for
what people type while they pass the gates, and
one for the command with which they act there. Only the clients that the spec declares may call an action and only its
sources may publish a topic. Left out: keys and certificates, which belong into no repository.
"""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import ControllerManager
from cellc.compiler.cell.interface import NodeSource
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.first_goal import NODE, first_goals
from cellc.compiler.deploy.spawning import spawnings
from cellc.compiler.emit.security.rights import (
    Profile,
    bring_up_process,
    commissioning,
    manager_client,
    manager_process,
    node_profiles,
    people,
    profile_element,
    sender,
)
from cellc.compiler.formats.xml_text import element, render
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.enclaves import (
    bring_up_enclave,
    commissioning_enclave,
    enclave_of,
    first_goal_enclave,
    manager_enclave,
    people_enclave,
    spawner_enclave,
)

_VERSION = {"version": "0.2.0"}


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the policy."""
    enclaves = element("enclaves", children=_enclaves(graph.cell, plan))
    yield Artifact("security/policy.xml", render(element("policy", _VERSION, [enclaves]), plan.header.text))


def _enclaves(cell: Cell, plan: Deployment) -> Iterator[Element]:
    for node in cell.nodes:
        if node.source is not NodeSource.STANDARD or node.name != "controller_manager":
            yield _enclave(enclave_of(cell, node), node_profiles(cell, node))
    for manager in cell.managers:
        yield _enclave(manager_enclave(cell, manager), manager_process(cell, manager))
        yield _enclave(spawner_enclave(cell, manager), _spawners(cell, manager))
    yield _enclave(bring_up_enclave(cell), bring_up_process(cell, plan.bring_up))
    if senders := [sender(cell, f"/{NODE}", goal.action, goal.topic) for goal in first_goals(cell)]:
        yield _enclave(first_goal_enclave(cell), senders)
    yield _enclave(people_enclave(cell), people(cell))
    yield _enclave(commissioning_enclave(cell), commissioning(cell))


def _spawners(cell: Cell, manager: ControllerManager) -> Iterator[Profile]:
    # The spawner names itself after its first controller.
    for spawning in spawnings(manager):
        yield manager_client(cell, manager, f"spawner_{spawning.controllers[0]}")


def _enclave(path: str, profiles: Iterator[Profile] | list[Profile]) -> Element:
    return element("enclave", {"path": path}, [element("profiles", children=map(profile_element, profiles))])
