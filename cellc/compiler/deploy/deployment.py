"""The deployment of a cell: what several artifacts share, decided once and handed to every emitter.

What follows from one thing alone, such as the file of a node or the enclave of a process, stays a function of that
thing in the modules beside this one: it is the same wherever it is asked for.
"""

from __future__ import annotations

from collections.abc import Mapping

from cellc.compiler.cell.interface import Node
from cellc.compiler.deploy.bringup import planned
from cellc.compiler.deploy.configuration import (
    OpenQuestion,
    configuration_id,
    configuration_inputs,
    header_of,
    open_questions,
    version_tuple,
)
from cellc.compiler.deploy.gates import Gate, network_gates, promotion_gates
from cellc.compiler.deploy.processes import launch_hosts, motion_clients
from cellc.compiler.deploy.recording import recorded_topics
from cellc.compiler.formats.header import Header
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.bring_up import BringUp
from cellc.contract.entities import Qos
from cellc.contract.frozen import dataclass
from cellc.contract.manifest import ConfigurationInputs


@dataclass(frozen=True, slots=True)
class Deployment:
    """How a cell is brought up, promoted and recorded.

    Args:
        header: what every generated file begins with.
        configuration_id: id over ``configuration_inputs``.
        versions: every part of the version tuple by name.
        questions: what no person has answered and blocks the real target, versions first.
        hosts: those on which something is started; empty where all runs in one place.
        motion_clients: nodes that a person starts or activates before anything moves.
        bring_up: the steps from processes to motion, on each target.
        promotion: gates G0 to G7.
        network: layers L1 to L6.
        recorded: every recorded topic with a profile that each of its publishers satisfies.
    """

    header: Header
    configuration_id: str
    configuration_inputs: ConfigurationInputs
    versions: Mapping[str, str]
    questions: tuple[OpenQuestion, ...]
    hosts: tuple[str, ...]
    motion_clients: tuple[Node, ...]
    bring_up: BringUp
    promotion: tuple[Gate, ...]
    network: tuple[Gate, ...]
    recorded: Mapping[str, Qos]


def plan_deployment(graph: CellGraph) -> Deployment:
    """Decide how a checked cell is deployed."""
    cell = graph.cell
    inputs, header = configuration_inputs(graph), header_of(cell)
    return Deployment(
        header=header,
        configuration_id=configuration_id(inputs),
        configuration_inputs=inputs,
        versions=version_tuple(cell),
        questions=open_questions(graph),
        hosts=launch_hosts(cell),
        motion_clients=motion_clients(cell),
        bring_up=graph.once(planned),
        promotion=promotion_gates(graph, header),
        network=network_gates(graph, header),
        recorded=recorded_topics(cell),
    )
