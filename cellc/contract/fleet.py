"""What ``--json`` prints where a command is about many cells: one row for each cell with each version tuple."""

from typing import Literal

from pydantic import Field

from cellc.contract.base import ContractModel
from cellc.contract.review import ReviewFinding


class FleetRehearsal(ContractModel):
    """How a rehearsal ended on the mock."""

    name: str = Field(description="Name of the rehearsal.")
    outcome: str = Field(description="How it ended.")
    expected: str = Field(description="How it must end.")
    passed: bool = Field(description="Whether it ended so, in time.")


class FleetSweep(ContractModel):
    """How often a rehearsal succeeded."""

    rehearsal: str = Field(description="Name of the rehearsal.")
    runs: int = Field(description="Number of runs that the verdict rests on.")
    succeeded: int = Field(description="Those of them that succeeded.")
    low: float = Field(description="Least rate of success that they leave possible.")
    high: float = Field(description="Highest rate of success that they leave possible.")
    confidence: float = Field(description="Confidence of that interval.")
    verdict: Literal["passed", "failed", "UNKNOWN"] | None = Field(
        description="Whether the expected rate holds; null where the cell expects none."
    )


class FleetRow(ContractModel):
    """One cell with one version tuple."""

    cell: str = Field(description="Name of the cell; empty where an error hides it.")
    source: str = Field(description="Spec or generated folder, as it was named.")
    versions: dict[str, str] = Field(description="Parts of the tuple by which rows differ, and `ros`.")
    passed: bool = Field(description="Whether everything is as it must be.")
    problem: str = Field("", description="Why there is no result; empty where there is one.")
    findings: tuple[ReviewFinding, ...] | None = Field(
        None, description="Of the check, options applied; null for a generated folder, which is not checked again."
    )
    rehearsals: tuple[FleetRehearsal, ...] | None = Field(None, description="Null where none was run.")
    sweeps: tuple[FleetSweep, ...] | None = Field(None, description="Null where none was asked for.")


class Fleet(ContractModel):
    """The table of a call."""

    format: Literal[1] = Field(description="Version of this format.")
    passed: bool = Field(description="Whether every row passed.")
    rows: tuple[FleetRow, ...] = Field(description="Cells in the order of the call, tuples in that of the options.")
