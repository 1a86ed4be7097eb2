"""The table of many cells, a row for each with each version tuple: what ``--json`` prints of it, and its verdicts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar, Literal

from pydantic import ConfigDict, Field

from cellc.contract.base import ContractModel
from cellc.contract.frozen import dataclass
from cellc.contract.review import ReviewFinding

_READ = ConfigDict(extra="forbid", allow_inf_nan=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class FleetRehearsal:
    """How a rehearsal ended on the mock."""

    __pydantic_config__: ClassVar[ConfigDict] = _READ

    name: Annotated[str, Field(description="Name of the rehearsal.")]
    outcome: Annotated[str, Field(description="How it ended.")]
    expected: Annotated[str, Field(description="How it must end.")]
    passed: Annotated[bool, Field(description="Whether it ended so, in time.")]


@dataclass(frozen=True, slots=True, kw_only=True)
class FleetSweep:
    """How often a rehearsal succeeded."""

    __pydantic_config__: ClassVar[ConfigDict] = _READ

    rehearsal: Annotated[str, Field(description="Name of the rehearsal.")]
    runs: Annotated[int, Field(description="Number of runs that the verdict rests on.")]
    succeeded: Annotated[int, Field(description="Those of them that succeeded.")]
    low: Annotated[float, Field(description="Least rate of success that they leave possible.")]
    high: Annotated[float, Field(description="Highest rate of success that they leave possible.")]
    confidence: Annotated[float, Field(description="Confidence of that interval.")]
    verdict: Annotated[
        Literal["passed", "failed", "UNKNOWN"] | None,
        Field(description="Whether the expected rate holds; null where the cell expects none."),
    ]


@dataclass(frozen=True, slots=True, kw_only=True)
class FleetRow:
    """One cell with one version tuple."""

    __pydantic_config__: ClassVar[ConfigDict] = _READ

    cell: Annotated[str, Field(description="Name of the cell; empty where an error hides it.")]
    source: Annotated[str, Field(description="Spec or generated folder, as it was named.")]
    versions: Annotated[Mapping[str, str], Field(description="Parts of the tuple by which rows differ, and `ros`.")]
    passed: Annotated[bool, Field(description="Whether everything is as it must be.")]
    problem: Annotated[str, Field(description="Why there is no result; empty where there is one.")] = ""
    findings: Annotated[
        tuple[ReviewFinding, ...] | None,
        Field(description="Of the check, options applied; null for a generated folder, which is not checked again."),
    ] = None
    rehearsals: Annotated[tuple[FleetRehearsal, ...] | None, Field(description="Null where none was run.")] = None
    sweeps: Annotated[tuple[FleetSweep, ...] | None, Field(description="Null where none was asked for.")] = None

    @property
    def label(self) -> str:
        """The cell, or where an error hides that its source, with the tuple."""
        return " ".join([self.cell or self.source, *(f"{part}={text}" for part, text in self.versions.items())])


class Fleet(ContractModel):
    """The table of a call."""

    format: Literal[1] = Field(description="Version of this format.")
    passed: bool = Field(description="Whether every row passed.")
    rows: tuple[FleetRow, ...] = Field(description="Cells in the order of the call, tuples in that of the options.")
