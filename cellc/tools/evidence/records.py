"""Records in a folder of evidence, as the programs that write them state them; all of it is untrusted."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Literal

from pydantic import BaseModel, ConfigDict

from cellc.contract.frozen import dataclass

UNKNOWN, SEEN = "UNKNOWN", "SEEN"
CONFIGURATION = re.compile(r"\bcfg-[0-9a-f]{12}\b")
"""An id as `manifest.json` has it, in the notes of people."""
_CELL = re.compile(r'^[ \t]*"cell": "([a-z][a-z0-9_]{1,63})",?[ \t]*$', re.MULTILINE)


class _Record(BaseModel):
    model_config = ConfigDict(frozen=True, extra="ignore", allow_inf_nan=False)


class ObservedLine(_Record):
    """One comparison of `scripts/observe`."""

    part: str
    subject: str
    verdict: Literal["PASSED", "FAILED", "UNKNOWN", "SEEN"]
    expected: str
    seen: str


class ObserveRecord(_Record):
    """One run of `scripts/observe`; `seconds` of listening."""

    attempt_id: str
    cell: str
    configuration_id: str
    gate: str
    target: Literal["real", "mock"]
    host: str = ""
    seconds: float
    lines: tuple[ObservedLine, ...]


class FirstGoalRecord(_Record):
    """One run of `scripts/first_goal`; without an identity where it was started without its package."""

    attempt_id: str
    cell: str | None = None
    configuration_id: str | None = None
    joint: str
    then: str
    verdict: Literal["PASSED", "FAILED"]
    seen: str


class AttemptRecord(_Record):
    """What `cellc attempt -o` writes."""

    cell: str
    configuration_id: str
    bags: tuple[str, ...]
    outcome: str


class RunsIndex(_Record):
    """`evidence.json`, which `cellc mock --evidence` writes: SHA-256 of each file beside it."""

    cell: str
    configuration_id: str
    seed: int
    files: Mapping[str, str]


class RunFigures(_Record):
    """`NAME.kpis.json`: how one rehearsal ended."""

    rehearsal: str
    outcome: str
    passed: bool


@dataclass(frozen=True, slots=True)
class Identity:
    """Of which cell and configuration something says to be; None where it says nothing."""

    cell: str | None
    configuration_id: str | None

    def differs_from(self, own: Identity) -> str:
        """Return in words what is another's; empty where nothing is."""
        if self.cell not in (None, own.cell):
            return f"is of cell `{self.cell}`, this package is of `{own.cell}`"
        if self.configuration_id not in (None, own.configuration_id):
            return f"is of configuration {self.configuration_id}, this package is {own.configuration_id}"
        return ""


def said_in(text: str, own: Identity) -> tuple[Identity, tuple[str, ...]]:
    """Return what notes of people and commands say to be of, and further configurations that they name."""
    named = dict.fromkeys(CONFIGURATION.findall(text))
    cells = dict.fromkeys(_CELL.findall(text))
    is_own = own.configuration_id in named
    first = own.configuration_id if is_own else next(iter(named), None)
    others = tuple(each for each in named if each != first)
    return Identity(next((cell for cell in cells if cell != own.cell), own.cell if cells else None), first), others


class Named(_Record):
    """Any record that names its cell."""

    cell: str
