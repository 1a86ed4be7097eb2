"""What ``cellc upgrade --format json`` prints: what another distribution of ROS 2 makes of a cell.

Values are texts as people read them. A question is what only a person can answer; empty without one.
"""

from typing import Literal

from pydantic import Field

from cellc.contract.base import ContractModel
from cellc.contract.review import Review, ReviewFinding, ReviewGate


class UpgradePin(ContractModel):
    """One part of the version tuple, before and after."""

    holder: str = Field(description="The cell, or the device that the part belongs to.")
    part: str = Field(description="Part of the tuple, such as `driver`.")
    before: str = Field(description="Pin as it is written.")
    after: str = Field(description="Pin that the new tuple has; UNKNOWN where no matrix names one.")
    place: str = Field(description="File, line and column of the pin; empty where the spec does not write it.")
    answer: Literal["OK", "INCOMPATIBLE", "UNKNOWN"] = Field(description="What the matrix says of the new pin.")
    evidence: str = Field(description="What that rests on, with its source and day.")
    question: str = Field("", description="What a person has to find out.")


class UpgradeParameter(ContractModel):
    """A declared parameter that one of the distributions lacks or declares otherwise."""

    nodes: tuple[str, ...] = Field(description="Controllers and managers that declare it.")
    parameter: str = Field(description="Its name; `<joint>` is the name of a joint.")
    change: Literal["appears", "vanishes", "changes"] = Field(description="What becomes of it.")
    what: str = Field("", description="What of its declaration changes.")
    before: str | None = Field(None, description="Default before, or what of the declaration changes; null for none.")
    after: str | None = Field(None, description="The same after.")
    stated: bool = Field(description="The cell gives it a value, before or after.")
    question: str = Field("", description="What a person has to decide.")


class UpgradeInterface(ContractModel):
    """A topic, service or action that nodes have in one of the distributions alone."""

    nodes: tuple[str, ...] = Field(description="Full names of the nodes.")
    right: Literal["publish", "subscribe", "reply", "request", "execute", "call"] = Field(description="Their part.")
    name: str = Field(description="Name at the graph; `~/` is the node's own.")
    change: Literal["gained", "lost"] = Field(description="What becomes of it.")


class Upgrade(ContractModel):
    """What changes with the distribution."""

    format: Literal[1] = Field(description="Version of this format.")
    cell: str = Field(description="Name of the cell.")
    before: str = Field(description="Distribution that the spec pins.")
    after: str = Field(description="Distribution that was asked for.")
    facts: tuple[str, ...] = Field(description="What is known of the new distribution.")
    pins: tuple[UpgradePin, ...] = Field(description="Every part of the tuple, the cell's first.")
    parameters: tuple[UpgradeParameter, ...] = Field(description="Parameters whose declaration differs.")
    interfaces: tuple[UpgradeInterface, ...] = Field(description="Names at the ROS graph that differ.")
    review: Review | None = Field(
        None, description="What changes in the package; null where the check refuses the new one."
    )
    errors: tuple[ReviewFinding, ...] = Field((), description="Why the check refuses it.")
    gates: tuple[ReviewGate, ...] = Field((), description="Gates to repeat.")
    questions: tuple[str, ...] = Field((), description="Everything that is left to people.")

    def asks(self) -> bool:
        """Tell whether anything is to be decided: a question, an error, or a change of the package."""
        compared = self.review
        return compared is None or bool(self.questions or compared.changes or compared.new_findings)
