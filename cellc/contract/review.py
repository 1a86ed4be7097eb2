"""What ``cellc diff --format json`` prints: what changed from one state of a cell to another, and what that means.

Values are texts as people read them, with units. Programs ask for areas, subjects, grades and codes of gates.
"""

from typing import Literal

from pydantic import Field

from cellc.contract.base import ContractModel
from cellc.contract.vocabulary import ApprovalArea, GateCode, Grade, ReviewArea


class ReviewSide(ContractModel):
    """One of the two states."""

    name: str = Field(description="Spec, folder or revision, as it was asked for.")
    cell: str = Field(description="Name of the cell.")
    configuration_id: str = Field(description="Id over all that evidence rests on.")
    joints: dict[str, tuple[str, ...]] = Field({}, description="Joints of each device that have limits, by device.")


class ReviewValue(ContractModel):
    """A value of the spec that is another one."""

    line: str = Field(description="Its path below that of the cause.")
    before: str | None = Field(None, description="What it said; null where it is new.")
    after: str | None = Field(None, description="What it says; null where it is gone.")
    place: str = Field(description="File, line and column.")


class ReviewCause(ContractModel):
    """A line of the spec, or a part of it, that causes changes."""

    line: str = Field(description="Path of the value in the spec, such as `devices.arm.model`.")
    before: str | None = Field(None, description="What it said; null where it is new.")
    after: str | None = Field(
        None, description="What it says; null where it is gone. Of several values, which they are."
    )
    place: str = Field("", description="File, line and column; of what is gone, those before.")
    lines: int = Field(1, description="How many values of that part are listed as one.")
    values: tuple[ReviewValue, ...] = Field((), description="Those values, where there are several.")
    renamed: bool = Field(False, description="It only has another name.")
    kept: tuple[str, ...] = Field(
        (), description="Of another model: what the spec states for the model before, and was left as it was."
    )


class ReviewChange(ContractModel):
    """One change, of one subject or of several that changed alike."""

    area: ReviewArea = Field(description="What it concerns.")
    subjects: tuple[str, ...] = Field(description="Frame, joint, controller, interface or whatever changed.")
    quantity: str = Field(description="What of it changed.")
    before: str | None = Field(None, description="Value before; null where there was none.")
    after: str | None = Field(None, description="Value after; null where it is removed.")
    delta: str = Field("", description="The difference where it has a size: mm, degrees or percent.")
    grade: Grade = Field(description="How it is taken.")
    breaking: bool = Field(False, description="A consumer outside of the cell breaks.")
    why: str = Field("", description="Why it has this grade, by the rules of docs/review.md.")
    approval: ApprovalArea = Field(description="Area of approval.")
    owner: str = Field(description="Who approves it, by the spec after the change.")
    beside: dict[ApprovalArea, str] = Field({}, description="Areas of approval asked beside it, each with its owner.")
    cause: int | None = Field(None, description="Number of its cause in `causes`, from 0; null where no line is known.")


class ReviewFinding(ContractModel):
    """A finding of the check that one side has and the other has not."""

    code: str = Field(description="Code of the finding.")
    severity: str = Field(description="Its severity.")
    message: str = Field(description="What it says.")
    place: str = Field(description="File, line and column.")
    cause: int | None = Field(None, description="Of a new one, the number of its cause; null where no line is known.")


class ReviewRehearsal(ContractModel):
    """How a rehearsal ended on the mock, before and after."""

    name: str = Field(description="Name of the rehearsal.")
    before: str | None = Field(None, description="Outcome before; null where it was not there or could not run.")
    after: str | None = Field(None, description="Outcome after; null where it is not there or could not run.")
    passed_before: bool | None = Field(None, description="Whether it ended as declared, before.")
    passed_after: bool | None = Field(None, description="Whether it ended as declared, after.")


class ReviewGate(ContractModel):
    """A gate that must be repeated."""

    code: GateCode = Field(description="Gate or layer.")
    title: str = Field(description="Its title.")
    evidence: str = Field(description="File of evidence that is no longer valid.")
    because: tuple[ReviewArea, ...] = Field(description="Areas whose changes it is the first to look at.")


class Review(ContractModel):
    """Everything that changed."""

    format: Literal[1] = Field(description="Version of this format.")
    before: ReviewSide = Field(description="The state before.")
    after: ReviewSide = Field(description="The state after.")
    changes: tuple[ReviewChange, ...] = Field(description="By grade, the worst first, then by area.")
    causes: tuple[ReviewCause, ...] = Field((), description="Lines of the spec that cause the changes.")
    new_findings: tuple[ReviewFinding, ...] = Field((), description="New findings of the check.")
    gone_findings: tuple[ReviewFinding, ...] = Field((), description="Findings of the check that are resolved.")
    rehearsals: tuple[ReviewRehearsal, ...] = Field((), description="Outcomes, where rehearsals were asked for.")
    gates: tuple[ReviewGate, ...] = Field((), description="Gates to repeat.")
    files: tuple[str, ...] = Field((), description="Generated files that differ.")
    notes: tuple[str, ...] = Field((), description="What is odd about a side, such as a file edited by hand.")

    def worst(self) -> Grade | None:
        """Return the worst grade; None where nothing changed."""
        order = tuple(Grade)
        return max((change.grade for change in self.changes), key=order.index, default=None)

    def rehearsals_differ(self) -> bool:
        """Tell whether a rehearsal ends otherwise than before."""
        return any(rehearsal.before != rehearsal.after for rehearsal in self.rehearsals)
