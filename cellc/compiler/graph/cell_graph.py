"""The cell as graphs, one for each question that rules and emitters ask."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TypeVar, cast

from cellc.compiler.cell.cell import Cell
from cellc.compiler.graph.claims import ClaimGraph, build_claims
from cellc.compiler.graph.data_flow import DataFlow, build_data_flow
from cellc.compiler.graph.frame_tree import FrameTree, ModelParts, build_frame_tree
from cellc.compiler.graph.network import NetworkGraph, build_network
from cellc.compiler.graph.responsibilities import Responsibilities, build_responsibilities
from cellc.compiler.graph.startup import StartupGraph, build_startup
from cellc.contract.frozen import dataclass

_Answer = TypeVar("_Answer")


# Without slots, so that each graph is built when it is first asked for and kept.
@dataclass(frozen=True)
class CellGraph:
    """A linked cell with its graphs; every answer is in the order of the spec.

    networkx is imported where a question needs it and not before: a clean cell is checked without paying for it.
    """

    cell: Cell

    @cached_property
    def frames(self) -> FrameTree:
        """Which frame hangs on which, and who publishes the edge."""
        return build_frame_tree(self.cell)

    @cached_property
    def data(self) -> DataFlow:
        """Who tells what to whom, down to the controllers."""
        return build_data_flow(self.cell)

    @cached_property
    def claims(self) -> ClaimGraph:
        """Which controller owns which command interface, in every state that switches reach."""
        return build_claims(self.cell)

    @cached_property
    def startup(self) -> StartupGraph:
        """Which part must be ready before which."""
        return build_startup(self.cell)

    @cached_property
    def model(self) -> ModelParts:
        """Which links and joints the descriptions of the devices have."""
        return ModelParts(self.cell)

    @cached_property
    def network(self) -> NetworkGraph:
        """Which addresses there are, on which card of which host."""
        return build_network(self.cell)

    @cached_property
    def responsibilities(self) -> Responsibilities:
        """Who is responsible for what."""
        return build_responsibilities(self.cell)

    def once(self, question: Callable[[CellGraph], _Answer]) -> _Answer:
        """Answer a question of a stage above, once however many rules and emitters ask it."""
        if question not in self._answers:
            self._answers[question] = question(self)
        return cast(_Answer, self._answers[question])

    @cached_property
    def _answers(self) -> dict[Callable[[CellGraph], object], object]:
        return {}


def build_graph(cell: Cell) -> CellGraph:
    """Wrap a linked cell in its graphs, each of which is built when first used."""
    return CellGraph(cell)
