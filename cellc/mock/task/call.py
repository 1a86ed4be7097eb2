"""A step that asks a service: the mock replaces the program behind it, and answers immediately or never."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.contract.entities import ContractEndpoint, ContractInterface
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.bus.qos import hears
from cellc.mock.engine.process import Waiting
from cellc.mock.task.context import AttemptError, TaskContext
from cellc.mock.task.execute import RESPONSE_S


def call(context: TaskContext, name: str) -> Waiting[None]:
    """Ask a service, and wait for its answer as long as its interface allows.

    Raises:
        AttemptError: goal_rejection, where nothing offers such a service; wrong_owner, where the task is no client of
            it; timeout, where no answer comes, unless its interface says that the client goes on.
    """
    interface = context.contract.interfaces.get(name)
    if interface is None or interface.kind != "service":
        raise AttemptError(AttemptOutcome.GOAL_REJECTION, f"no node offers the service {name}")
    if context.node.name not in {sink.node for sink in interface.sinks}:
        raise AttemptError(AttemptOutcome.WRONG_OWNER, f"{context.node.name} is not a client of {name}")
    yield from context.let_take_effect()
    context.check_cell()
    if any(_answering(context, name, interface)):
        return
    bound_s = RESPONSE_S if interface.timeout_s is None else interface.timeout_s
    yield from context.rest(bound_s)
    if interface.on_timeout != "continue":
        raise AttemptError(AttemptOutcome.TIMEOUT, f"no answer from {name} within {bound_s:g} s")


def _answering(context: TaskContext, name: str, interface: ContractInterface) -> Iterator[ContractEndpoint]:
    """Yield the servers that the request reaches, and whose answer comes back."""
    plant, client = context.plant, context.node.name
    for server in interface.sources:
        reached = plant.network.answers(server.node) and not plant.network.is_cut(client, server.node)
        if reached and hears(context.contract, name, server.node, client):
            yield server
