"""A frame is no longer published."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import BORNE, SUCCEEDED, Ending, FaultCase, ends_in, fault_case
from cellc.mock.faults.cell_steps import CellStep, ancestors
from cellc.mock.plant import Plant


@dataclass(frozen=True, slots=True)
class DropFrame:
    """Stops the publisher of a frame; a frame of /tf_static stays known to who has heard it, as in tf2."""

    frame: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> DropFrame | None:
        """Return the fault of an entry; None where its target is no frame."""
        return cls(entry.target) if entry.target in contract.frames else None

    def begin(self, plant: Plant) -> None:
        """Stop publishing."""
        if self.frame in plant.perceptions:
            plant.perceptions[self.frame].publishes_transform = False
        else:
            plant.robot_state_publisher.drop(self.frame, plant.now_ns)

    def end(self, plant: Plant) -> None:
        """Publish again."""
        if self.frame in plant.perceptions:
            plant.perceptions[self.frame].publishes_transform = True
        else:
            plant.robot_state_publisher.resume(self.frame, plant.now_ns)


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every dynamic frame, and of each group the moving link that is nearest to its base."""
    for frame in published_frames(contract):
        entry = FaultEntry(kind="drop_frame", target=frame)
        yield fault_case(entry, contract, partial(_ending, Bounds(contract), frame))


def published_frames(contract: Contract) -> tuple[str, ...]:
    """Return the frames on /tf that stand for all: the dynamic ones, and the first moving link of each group."""
    dynamic = [name for name, frame in contract.frames.items() if frame.kind == "dynamic"]
    chains = (ancestors(contract, group.tip_frame) for group in contract.groups.values())
    moving = [[name for name in chain if _moves(contract, name)] for chain in chains]
    return tuple(dict.fromkeys([*dynamic, *(names[-1] for names in moving if names)]))


def _moves(contract: Contract, frame: str) -> bool:
    return contract.frames[frame].kind == "link" and contract.frames[frame].pose is None


def _ending(bounds: Bounds, frame: str, step: CellStep) -> Ending:
    """An observation from before the fault can still be looked up, so that a move may bear it."""
    if step.kind != "move" or frame not in step.frames:
        return BORNE
    return ends_in("tf_failure", SUCCEEDED, within_s=bounds.asked_s())
