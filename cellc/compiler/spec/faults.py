"""What goes wrong in a rehearsal: the kind of a fault is its first key, with what it hits."""

from functools import cache
from typing import Annotated, Any, ClassVar, Literal, Union

from pydantic import Discriminator, Field, Tag, create_model

from cellc.compiler.spec.base import MOST, FrameReference, shape_of
from cellc.compiler.spec.kinds import Kinds, first_key
from cellc.compiler.spec.quantity import Duration, JointPosition, JointSpeed, Quantity, Share, TimeShift, Way
from cellc.contract.fault_declaration import Amount, Reference
from cellc.contract.faults import MOST_CYCLES, FaultKind, GoalStep
from cellc.contract.stated import Name, StatedModel, Text


class PhaseSpec(StatedModel):
    """A moment before the first step: the bring-up comes to a phase."""

    phase: Literal["start", "activate", "claim"] = Field(
        ..., description="Before anything of this phase of the bring-up.", examples=["claim"]
    )


class EventSpec(StatedModel):
    """A moment in a rehearsal, defined by the progress of a step."""

    step: int = Field(..., description="Number of the step, counted from 1.", examples=[3], ge=1, le=MOST)
    when: Literal["started", "accepted", "moving"] = Field(
        "started",
        description="Before the first action of the step, when a controller took its goal, or at the first motion.",
        examples=["accepted"],
    )
    after: Duration | None = Field(None, description="Simulated time after that.", examples=["100 ms"])


def _moment(value: object) -> str:
    if shape_of(value) != "mapping":
        return "time"
    return "phase" if first_key(value, ("phase",)) else "event"


MomentSpec = Annotated[
    Union[Annotated[Duration, Tag("time")], Annotated[EventSpec, Tag("event")], Annotated[PhaseSpec, Tag("phase")]],
    Discriminator(_moment),
]


class FaultSpec(StatedModel):
    """When a fault begins and how long it lasts; the model of its kind adds what it hits, and by how much."""

    SHARED_AFTER: ClassVar[str] = "every other"
    kind: ClassVar[FaultKind]

    at: MomentSpec = Field(
        ...,
        description="Simulated time from the start of the rehearsal, an event of a step, or a phase of the bring-up.",
        examples=["2 s", {"step": 3, "when": "accepted", "after": "100 ms"}],
    )
    lasting: Duration | None = Field(None, description="How long; to the end if absent.", examples=["500 ms"])

    @property
    def target(self) -> str | int:
        """What it hits, as written."""
        target: str | int = getattr(self, self.kind.value)
        return target

    @property
    def amount(self) -> Quantity | None:
        """By how much, for a kind that says so."""
        amount: Quantity | None = None if self.kind.by is None else getattr(self, self.kind.by.amount.key)
        return amount


_TARGETS: dict[Reference, object] = {
    Reference.JOINT: FrameReference,
    Reference.FRAME: FrameReference,
    Reference.INTERFACE: Text,
    Reference.STEP: GoalStep,
    Reference.CYCLES: Annotated[int, Field(ge=1, le=MOST_CYCLES)],
}
"""How a target is written that is not one name."""
_AMOUNTS: dict[Amount, object] = {
    Amount.DELAY: Duration,
    Amount.JUMP: TimeShift,
    Amount.DISPLACEMENT: JointPosition,
    Amount.SIZE: Way,
    Amount.VELOCITY: JointSpeed,
    Amount.FACTOR: Share,
}


@cache
def fault_model(kind: FaultKind) -> type[FaultSpec]:
    """Return the model of a kind of fault, made of its declaration in ``cellc.contract.faults``."""
    target, by = kind.hits, kind.by
    shape = _TARGETS.get(target.target.reference, Name)
    fields: dict[str, Any] = {
        kind.value: (shape, Field(..., description=target.description, examples=[target.example]))
    }
    if by is not None:
        fields[by.amount.key] = (_AMOUNTS[by.amount], Field(..., description=by.description, examples=[by.example]))
    name = kind.title().replace("_", "") + "Fault"
    model = create_model(name, __base__=FaultSpec, __doc__=kind.meaning, __module__=__name__, **fields)
    model.kind = kind
    return model


FaultKinds = Kinds("fault", tuple(FaultKind), fault_model)
_Fault = Annotated[FaultSpec, FaultKinds]

FaultsSpec = Annotated[
    Union[Annotated[_Fault, Tag("mapping")], Annotated[tuple[_Fault, ...], Tag("list")]],
    Discriminator(shape_of, custom_error_type="wrong-type", custom_error_message="a fault or a list of faults"),
]
