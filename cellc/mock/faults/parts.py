"""Faults of parts: one that is not there, another one, one that falls or slides out of the fingers."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import ClassVar

from cellc.contract.contract import Contract, ContractGrasp
from cellc.contract.faults import FaultKind
from cellc.contract.frozen import dataclass
from cellc.contract.rehearsals import FaultEntry
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.faults.cases import BORNE, CellStep, Ending, FaultCase, ends_in, fault_case
from cellc.mock.faults.endings import Bounds
from cellc.mock.faults.ports import FaultPorts

BEYOND = 2.0
"""A case plays a part that is wrong, or a slip that is too far, by so many tolerances."""


@dataclass(frozen=True, slots=True)
class MissingPart:
    """A part is not where it is seen."""

    kind: ClassVar[FaultKind] = FaultKind.MISSING_PART
    part: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> MissingPart | None:
        """Return the fault of an entry; None where fingers cannot tell its target."""
        return cls(entry.target) if entry.target in _known(contract) else None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every part that fingers can tell."""
        for part in _known(contract):
            entry = FaultEntry(kind=cls.kind, target=part)
            yield fault_case(entry, contract, partial(_seen_by_fingers, Bounds(contract)))

    def begin(self, ports: FaultPorts) -> None:
        """Take it away."""
        ports.parts.miss(self.part, missing=True)

    def end(self, ports: FaultPorts) -> None:
        """Put it there."""
        ports.parts.miss(self.part, missing=False)


@dataclass(frozen=True, slots=True)
class WrongPart:
    """A part is wider than stated, by m."""

    kind: ClassVar[FaultKind] = FaultKind.WRONG_PART
    part: str
    by_m: float

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> WrongPart | None:
        """Return the fault of an entry; None where fingers cannot tell its target."""
        return cls(entry.target, entry.size_m or 0.0) if entry.target in _known(contract) else None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every part that fingers can tell, too narrow."""
        for part, grasp in _known(contract).items():
            entry = FaultEntry(kind=cls.kind, target=part, size_m=-BEYOND * (grasp.tolerance_m or 0.0))
            yield fault_case(entry, contract, partial(_seen_by_fingers, Bounds(contract)))

    def begin(self, ports: FaultPorts) -> None:
        """Put another part there."""
        ports.parts.widen(self.part, self.by_m)

    def end(self, ports: FaultPorts) -> None:
        """Put the right one there."""
        ports.parts.widen(self.part, 0.0)


@dataclass(frozen=True, slots=True)
class LosePart:
    """The fingers of a gripper have no force."""

    kind: ClassVar[FaultKind] = FaultKind.LOSE_PART
    gripper: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> LosePart | None:
        """Return the fault of an entry; None where its target can tell no part."""
        return cls(entry.target) if entry.target in _grippers(contract) else None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every gripper that can tell a part: any step may show that it is lost."""
        for gripper in _grippers(contract):
            entry = FaultEntry(kind=cls.kind, target=gripper)
            yield fault_case(entry, contract, partial(_let_go, Bounds(contract), gripper), hits_running_step=True)

    def begin(self, ports: FaultPorts) -> None:
        """Let go."""
        ports.parts.weaken(self.gripper, weak=True, now_ns=ports.schedule.now_ns)

    def end(self, ports: FaultPorts) -> None:
        """Grip again; what fell lies where it fell."""
        ports.parts.weaken(self.gripper, weak=False, now_ns=ports.schedule.now_ns)


@dataclass(frozen=True, slots=True)
class Slip:
    """What a gripper holds slides between its fingers, by m."""

    kind: ClassVar[FaultKind] = FaultKind.SLIP
    gripper: str
    by_m: float

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Slip | None:
        """Return the fault of an entry; None where its target can tell no part."""
        return cls(entry.target, entry.size_m or 0.0) if entry.target in _grippers(contract) else None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every gripper that can tell a part, with a slip that no part bears."""
        for gripper in _grippers(contract):
            most_m = max(grasp.tolerance_m or 0.0 for grasp in _known(contract).values())
            entry = FaultEntry(kind=cls.kind, target=gripper, size_m=BEYOND * most_m)
            yield fault_case(entry, contract, partial(_seen_by_fingers, Bounds(contract)), hits_running_step=True)

    def begin(self, ports: FaultPorts) -> None:
        """Slide."""
        ports.parts.slip(self.gripper, self.by_m)

    def end(self, ports: FaultPorts) -> None:
        """Nothing: a part stays where it has slid to."""


def _known(contract: Contract) -> dict[str, ContractGrasp]:
    """Return the parts whose width a gripper can check."""
    return {name: frame.grasp for name, frame in contract.frames.items() if frame.grasp and frame.grasp.bands}


def _grippers(contract: Contract) -> tuple[str, ...]:
    """Return the grippers that can check a part."""
    return tuple(dict.fromkeys(device for grasp in _known(contract).values() for device in grasp.bands))


def _seen_by_fingers(bounds: Bounds, step: CellStep) -> Ending:
    """A step that closes on a part shows it, or one that lets go of it; any other bears it."""
    if step.kind != "grip":
        return BORNE
    return ends_in(AttemptOutcome.GRIP_FAILURE, AttemptOutcome.SUCCEEDED, within_s=bounds.execution_s(step))


def _let_go(bounds: Bounds, gripper: str, step: CellStep) -> Ending:
    """The fingers leave their band before they are closed; a gripper that holds nothing loses nothing."""
    facts = bounds.contract.devices[gripper].gripper
    speed = None if facts is None else facts.max_velocity
    closing_s = abs(facts.closed - facts.open) / speed if facts is not None and speed else None
    within_s = bounds.execution_s(step) if step.kind == "grip" else None
    if within_s is None and closing_s is not None:
        within_s = closing_s + bounds.watched_s()
    return ends_in(AttemptOutcome.GRIP_FAILURE, AttemptOutcome.SUCCEEDED, within_s=within_s)
