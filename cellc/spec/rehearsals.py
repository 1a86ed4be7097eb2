"""What the mock backend executes: steps, faults, and the outcome each must end in."""

from __future__ import annotations

from typing import Annotated, Literal, Union

from pydantic import Discriminator, Field, Tag

from cellc.contract.closed_lists import OutcomeName
from cellc.spec.base import Name, SpecModel
from cellc.spec.faults import FaultsSpec, first_key
from cellc.spec.quantity import Duration


class MoveStep(SpecModel):
    """Move a group to a named pose or a Cartesian goal."""

    move: Name = Field(..., description="Named pose or goal.", examples=["home"])


class DetectStep(SpecModel):
    """Wait for a fresh observation of a dynamic frame and keep its stamp for the goals that use it."""

    detect: Name = Field(..., description="Dynamic frame.", examples=["object"])


class GripStep(SpecModel):
    """Drive the gripper."""

    grip: Literal["open", "close"] = Field(..., description="Open or close.", examples=["close"])
    device: Name | None = Field(None, description="Gripper; the only one if absent.", examples=["gripper"])


class WaitStep(SpecModel):
    """Let simulated time pass."""

    wait: Duration = Field(..., description="How long.", examples=["1 s"])


class AcknowledgeStep(SpecModel):
    """Let a person acknowledge a stop, so that the cell may go on; without it every further goal is refused."""

    acknowledge: Literal["operator"] = Field(..., description="Who acknowledges.", examples=["operator"])


_STEP_KEYS = ("move", "detect", "grip", "wait", "acknowledge")


def _step_key(value: object) -> str | None:
    return first_key(value, _STEP_KEYS)


StepSpec = Annotated[
    Union[
        Annotated[MoveStep, Tag("move")],
        Annotated[DetectStep, Tag("detect")],
        Annotated[GripStep, Tag("grip")],
        Annotated[WaitStep, Tag("wait")],
        Annotated[AcknowledgeStep, Tag("acknowledge")],
    ],
    Discriminator(
        _step_key,
        custom_error_type="step-kind-missing",
        custom_error_message="a step needs one of the keys `move`, `detect`, `grip`, `wait` or `acknowledge`",
    ),
]


class RehearsalSpec(SpecModel):
    """One run of the mock: steps of its own or of another rehearsal, faults, and the expected end."""

    steps: tuple[StepSpec, ...] = Field((), description="Steps in order.", examples=[[{"move": "home"}]])
    use: Name | None = Field(None, description="Rehearsal whose steps are used.", examples=["pick_and_place"])
    inject: FaultsSpec = Field((), description="One fault or several.", examples=[{"freeze": "camera", "at": "2 s"}])
    expect: OutcomeName = Field("succeeded", description="Outcome that it must end in.", examples=["stale_state"])
    within: Duration | None = Field(
        None, description="Bound from the fault (or its effect's start) to the outcome.", examples=["200 ms"]
    )
    timeout: Duration | None = Field(None, description="Bound of the whole run in simulated time.", examples=["120 s"])
