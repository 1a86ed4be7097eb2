"""A server answers nothing: no goal response, no result, no answer to a cancel."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import BORNE, Ending, FaultCase, ends_in, fault_case
from cellc.mock.faults.cell_steps import CellStep
from cellc.mock.faults.contents import controllers
from cellc.mock.plant import Plant
from cellc.mock.task.bounds import planning_server
from cellc.mock.task.execute import RESPONSE_S


@dataclass(frozen=True, slots=True)
class Unresponsive:
    """Silences a server; what it has accepted goes on in its control loop."""

    server: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Unresponsive | None:
        """Return the fault of an entry; None where its target serves nothing."""
        served = {
            source.node for each in contract.interfaces.values() if each.kind != "topic" for source in each.sources
        }
        return cls(entry.target) if entry.target in served | controllers(contract).keys() else None

    def begin(self, plant: Plant) -> None:
        """Fall silent."""
        plant.requests.unresponsive.add(self.server)

    def end(self, plant: Plant) -> None:
        """Answer again what is asked from now on."""
        plant.requests.unresponsive.discard(self.server)


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every server that the task asks: the controllers with an action, and who plans."""
    planner = planning_server(contract)
    acting = [name for name, facts in controllers(contract).items() if facts.active and facts.action is not None]
    for server in (*acting, *([planner] if planner else [])):
        entry = FaultEntry(kind="unresponsive", target=server)
        yield fault_case(entry, contract, partial(_ending, Bounds(contract), server, server == planner))


def _ending(bounds: Bounds, server: str, plans: bool, step: CellStep) -> Ending:
    """A request is given up soon; a result that stays away at the bound of the action."""
    if plans and step.kind == "move":
        return ends_in("timeout", within_s=RESPONSE_S + bounds.asked_s())
    if server not in step.controllers:
        return BORNE
    execution_s = bounds.execution_s(step)
    return ends_in("timeout", within_s=None if execution_s is None else max(RESPONSE_S, execution_s))
