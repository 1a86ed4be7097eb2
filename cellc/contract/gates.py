"""What the gates of a cell set in robots and leave as evidence, and what is known of each pin, in ``contract.json``.

The checklists of the gates and ``audit.md`` say it to people. Read by ``cellc diff`` and ``cellc evidence``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar, Literal

from pydantic import ConfigDict, Field

from cellc.contract.base import ContractModel
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import GateCode, RobotSetting

GATES = "gates/gates.json"
"""File of its own in packages that an older cellc wrote."""
_READ = ConfigDict(extra="forbid")


@dataclass(frozen=True, slots=True, kw_only=True)
class GateSetting:
    """What a line has set or checked in a robot, which no other file of the package holds as data."""

    __pydantic_config__: ClassVar[ConfigDict] = _READ

    gate: Annotated[GateCode, Field(description="Gate with the line.")]
    sets: Annotated[RobotSetting, Field(description="What is set.")]
    device: Annotated[str, Field(description="Whose controller it is set in, or whose joint moves.")]
    values: Annotated[Mapping[str, str], Field(description="What is stated of it, by name.")]


@dataclass(frozen=True, slots=True, kw_only=True)
class PinAnswer:
    """What the compatibility matrix says of one part of the version tuple."""

    __pydantic_config__: ClassVar[ConfigDict] = _READ

    holder: Annotated[str, Field(description="The cell, or a device.")]
    part: Annotated[str, Field(description="Part of the tuple.")]
    answer: Annotated[Literal["OK", "INCOMPATIBLE", "UNKNOWN"], Field(description="Whether it goes with the rest.")]
    reason: Annotated[str, Field(description="Why, with the source.")]


@dataclass(frozen=True, slots=True, kw_only=True)
class GateFile:
    """One file or folder that a gate must leave in the folder of its attempt."""

    __pydantic_config__: ClassVar[ConfigDict] = _READ

    name: Annotated[str, Field(description="Its name; `*` is the time of writing.")]
    kind: Annotated[
        Literal["notes", "observe", "bag", "first_goal", "attempt"], Field(description="Who writes it, and how.")
    ] = "notes"
    host: Annotated[str | None, Field(description="Host that must leave it; null where all runs in one place.")] = None
    least_s: Annotated[float | None, Field(description="How long must be observed, in seconds.")] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class GateEvidence:
    """What a gate must leave, and who signs it."""

    __pydantic_config__: ClassVar[ConfigDict] = _READ

    gate: Annotated[GateCode, Field(description="The gate.")]
    title: Annotated[str, Field(description="Its name for people.")]
    shows: Annotated[str, Field(description="What is shown once it is passed.")]
    signed_by: Annotated[str, Field(description="Owner who signs.")]
    files: Annotated[
        tuple[GateFile, ...], Field(description="What it leaves; empty where it must not be passed on hardware.")
    ]
    measured: Annotated[tuple[str, ...], Field(description="Values that people measure and record.")] = ()


class Gates(ContractModel):
    """What the gates of one cell have set, and what they rest on."""

    format: Literal[1] = Field(1, description="Version of this format.")
    settings: tuple[GateSetting, ...] = Field((), description="What is set or checked in robots.")
    evidence: tuple[GateEvidence, ...] = Field(
        (), description="What each gate leaves, in order; empty in contracts of an older cellc."
    )
    versions: tuple[PinAnswer, ...] = Field(description="The version tuple, part by part.")
