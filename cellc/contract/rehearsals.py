"""``rehearsals.json``: what the mock executes, every name resolved."""

from typing import Annotated, Literal

from pydantic import Field

from cellc.contract.base import ContractModel
from cellc.contract.entities import Target
from cellc.contract.faults import FaultKind
from cellc.contract.grading import UNSEEN, Graded, Rule
from cellc.contract.quantities import Coordinate, Count, Offset, PositiveMagnitude, PositiveSeconds, Seconds, Share
from cellc.contract.steps import StepKind
from cellc.contract.vocabulary import AttemptOutcome, BringUpPhase, ReviewArea


class StepEntry(ContractModel):
    """One step; ``target`` is a pose, goal, frame, device, service or who acknowledges; empty for a wait."""

    kind: StepKind = Field(description="What the step does.")
    target: str = Field(description="Pose, goal, frame, device, service, or who acknowledges.")
    command: Literal["open", "close", "together"] | None = Field(
        None, description="What the gripper does; `together` where the groups of a pose move simultaneously."
    )
    part: str | None = Field(None, description="Frame of the part that is to be between the fingers that close.")
    state: str | None = Field(None, description="State that a switched device is set to, or that its sensors tell.")
    duration_s: Seconds | None = Field(None, description="How long a wait lasts.")

    @property
    def title(self) -> str:
        """Its words, as records name it."""
        return " ".join(word for word in (self.kind, self.command or "", self.target, self.state or "") if word)


class FaultEvent(ContractModel):
    """What a fault waits for: how far a step has come.

    ``started`` is before the first action of the step, ``accepted`` when a controller took its goal, ``moving`` when a
    joint of that controller was first reported elsewhere than where it was.
    """

    step: int = Field(description="Number of the step, from 1.", ge=1)
    when: Literal["started", "accepted", "moving"] = Field("started", description="How far the step has come.")
    after_s: Seconds = Field(0.0, description="Simulated time after that.", ge=0.0)


class FaultEntry(ContractModel):
    """One fault; ``target`` is the ROS name of what it hits, or the kind of step for ``cancel``.

    It begins at ``at_s``, with ``event`` or with ``phase``; exactly one of them is given, none in a template.
    """

    kind: FaultKind = Field(description="What fails.")
    target: str = Field(description="What it hits.")
    at_s: Seconds | None = Field(None, description="Simulated time from the start; null where an event begins it.")
    event: FaultEvent | None = Field(None, description="Event that begins it; null where a time does.")
    phase: BringUpPhase | None = Field(
        None, description="Phase of the bring-up that begins it; null for a later begin."
    )
    lasting_s: Seconds | None = Field(None, description="How long; null to the end.")
    cycles: Count | None = Field(None, description="Update cycles missed in a row.")
    delay_s: Seconds | None = Field(None, description="How late samples arrive.")
    jump_s: Offset | None = Field(None, description="How far a clock jumps; negative is back.")
    displacement: Coordinate | None = Field(
        None, description="Offset of a joint from its command, or how far it is jogged, rad or m."
    )
    size_m: Coordinate | None = Field(None, description="How much wider a part is, or how far it slips.")
    velocity: PositiveMagnitude | None = Field(None, description="Speed that a joint does not exceed, rad/s or m/s.")
    factor: Share | None = Field(None, description="Speed scaling, 0 to 1.")


class RehearsalEntry(ContractModel):
    """One rehearsal and the outcome that it must end in, within a bound from the fault's effect."""

    name: str = Field(description="Name in the spec.")
    steps: tuple[StepEntry, ...] = Field(description="Steps in order.")
    faults: tuple[FaultEntry, ...] = Field(description="Faults that are injected.")
    expect: Annotated[AttemptOutcome, Graded(ReviewArea.REHEARSALS, "expected outcome")] = Field(
        description="Outcome that it must end in."
    )
    within_s: Annotated[
        Seconds | None, Graded(ReviewArea.REHEARSALS, "bound of the outcome", Rule.LOOSER, why=UNSEEN)
    ] = Field(None, description="Bound from the fault's effect to the outcome.")
    timeout_s: PositiveSeconds = Field(description="Bound of the whole run in simulated time.")
    bring_up: Target = Field(
        "mock", description="Target whose bring-up is taken; with `real` devices do what their vendors' drivers do."
    )

    @property
    def is_plain(self) -> bool:
        """Whether a campaign adds faults to it: it has none of its own, and how the real target starts is no step."""
        return not self.faults and self.bring_up == "mock"


class Rehearsals(ContractModel):
    """All rehearsals of a cell."""

    format: Literal[2] = Field(description="Version of this format.")
    rehearsals: tuple[RehearsalEntry, ...] = Field(description="Rehearsals in the order of the spec.")
