"""What the mock executes, what it must end in, what is measured and what is recorded."""

from functools import cache
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, create_model

from cellc.compiler.spec.base import MOST, StandardOr
from cellc.compiler.spec.faults import FaultsSpec
from cellc.compiler.spec.kinds import Kinds
from cellc.compiler.spec.quantity import Confidence, Duration, PositiveDuration, Quantity, Rate, Share
from cellc.contract.entities import Target
from cellc.contract.stated import Name, StatedModel, Text
from cellc.contract.steps import DEVICE, STATE, TOGETHER, Key, StepKind, StepTarget
from cellc.contract.vocabulary import AttemptOutcome


class StepSpec(StatedModel):
    """One step; the model of its kind adds its keys."""

    kind: ClassVar[StepKind]

    @property
    def target(self) -> str | Quantity:
        """What the key of its kind says, as written."""
        target: str | Quantity = getattr(self, self.kind.value)
        return target

    @property
    def more(self) -> str | bool | None:
        """What its second key says."""
        more: str | bool | None = None if self.kind.more is None else getattr(self, self.kind.more.key)
        return more


_TARGETS: dict[StepTarget, object] = {
    StepTarget.FINGERS: Literal["open", "close"],
    StepTarget.SERVICE: Text,
    StepTarget.TIME: Duration,
    StepTarget.PERSON: Literal["operator"],
}
"""How a target is written that is not one name."""
_MORE: dict[Key, tuple[object, object]] = {TOGETHER: (bool, False), DEVICE: (Name | None, None), STATE: (Name, ...)}
"""How a second key is written, and its default."""


@cache
def step_model(kind: StepKind) -> type[StepSpec]:
    """Return the model of a kind of step, made of its declaration in ``cellc.contract.steps``."""
    shape = _TARGETS.get(kind.target, Name)
    fields: dict[str, Any] = {kind.value: (shape, Field(..., description=kind.description, examples=[kind.example]))}
    if kind.more is not None:
        key, description, example = kind.more
        shape, default = _MORE[kind.more]
        fields[key] = (shape, Field(default, description=description, examples=[example]))
    name = f"{kind.title()}Step"
    model = create_model(name, __base__=StepSpec, __doc__=kind.meaning, __module__=__name__, **fields)
    model.kind = kind
    return model


StepKinds = Kinds("step", tuple(StepKind), step_model)


class RehearsalSpec(StatedModel):
    """One run of the mock: steps of its own or of another rehearsal, faults, and the expected end."""

    steps: tuple[Annotated[StepSpec, StepKinds], ...] = Field(
        (), description="Steps in order.", examples=[[{"move": "home"}]]
    )
    use: Name | None = Field(None, description="Rehearsal whose steps are used.", examples=["pick_and_place"])
    bring_up: Target = Field(
        "mock",
        description="Steps of the bring-up that are taken; with `real` the devices do what their vendors' drivers do.",
        examples=["real"],
    )
    inject: FaultsSpec = Field((), description="One fault or several.", examples=[{"freeze": "camera", "at": "2 s"}])
    expect: AttemptOutcome = Field(
        AttemptOutcome.SUCCEEDED, strict=False, description="Outcome that it must end in.", examples=["stale_state"]
    )
    within: Duration | None = Field(
        None, description="Bound from the fault (or its effect's start) to the outcome.", examples=["200 ms"]
    )
    timeout: PositiveDuration | None = Field(
        None, description="Bound of the whole run in simulated time.", examples=["120 s"]
    )
    success: Rate | None = Field(
        None, description="Least share of the runs of a sweep that must succeed.", examples=["99.5 %"]
    )
    confidence: Confidence | None = Field(
        None, description="How sure a verdict on that must be; 95 % if absent.", examples=["95 %"]
    )


class KpisSpec(StatedModel):
    """The key figures of the checkpoint; one without a target is a warning."""

    plan_to_execute: Duration | None = Field(
        None, description="Longest time from plan to execution.", examples=["500 ms"]
    )
    cancel: Duration | None = Field(None, description="Longest time from cancel to hold.", examples=["200 ms"])
    missed_cycles: int | None = Field(
        None, description="Missed update cycles allowed in a run.", examples=[0], ge=0, le=MOST
    )
    stale_state_rejection: Share | None = Field(
        None, description="Share of stale samples rejected.", examples=["100 %"]
    )
    protective_stops: int | None = Field(
        None, description="Protective stops allowed in a shift.", examples=[0], ge=0, le=MOST
    )
    recovery_time: Duration | None = Field(None, description="Longest time from stop to ready.", examples=["120 s"])
    wrong_owner_events: int | None = Field(
        None, description="Commands of a wrong owner allowed.", examples=[0], ge=0, le=MOST
    )


class RecordingSpec(StatedModel):
    """What every attempt leaves behind."""

    attempt_fields: StandardOr = Field(
        "standard", description="`standard` for all fields of the checkpoint, or their names.", examples=["standard"]
    )
    topics: tuple[Text, ...] = Field(
        (), description="Topics to record beyond those of the motion path.", examples=[["/diagnostics"]]
    )


class TargetSpec(StatedModel):
    """What differs between mock, simulation and the real cell."""

    hardware: Literal["mock", "sim", "real"] | None = Field(
        None, description="Hardware components used; that of the target's name if absent.", examples=["mock"]
    )
    clock: Literal["wall", "sim"] | None = Field(
        None, description="Time of every node of the target.", examples=["wall"]
    )
