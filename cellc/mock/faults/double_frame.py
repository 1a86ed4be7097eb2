"""A second node publishes a frame, and places it elsewhere.

tf2 stores what both publish and complains of nothing, so that lookups jump from one to the other.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from cellc.contract.contract import Contract, ContractFrame
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import BORNE, SUCCEEDED, Ending, FaultCase, ends_in, fault_case
from cellc.mock.faults.cell_steps import CellStep
from cellc.mock.faults.drop_frame import published_frames
from cellc.mock.plant import Plant
from cellc.mock.tf.buffer import DEFAULT_BUFFER_S
from cellc.mock.tf.sources import SampledSource
from cellc.transforms import Pose

AUTHORITY = "second_authority"
RATE_HZ = 10.0
BESIDE_M = 0.1
"""How far beside the parent's origin the second node sees the frame."""


class DoubleFrame:
    """Publishes a frame under another authority."""

    def __init__(self, frame: str, facts: ContractFrame) -> None:
        """Bind the fault to a frame of the contract."""
        self._frame = frame
        self._facts = facts
        self._active = False

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> DoubleFrame | None:
        """Return the fault of an entry; None where its target is no frame with a parent."""
        facts = contract.frames.get(entry.target)
        return None if facts is None or not facts.parent else cls(entry.target, facts)

    def begin(self, plant: Plant) -> None:
        """Publish from now on."""
        self._active = True
        buffer_s = self._facts.buffer_s or DEFAULT_BUFFER_S
        source = SampledSource(self._facts.parent, self._frame, AUTHORITY, buffer_s, plant.buffer.warnings)
        plant.buffer.add(self._frame, source)
        plant.simulation.every(plant.now_ns, RATE_HZ, lambda _: self._publish(plant, source))

    def end(self, plant: Plant) -> None:
        """Publish no more; what was published stays in every buffer."""
        self._active = False

    def _publish(self, plant: Plant, source: SampledSource) -> None:
        if self._active:
            source.insert(plant.clocks.now_ns(plant.task), Pose((0.0, 0.0, BESIDE_M), (0.0, 0.0, 0.0, 1.0)))


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every dynamic frame, and of each group the moving link that is nearest to its base."""
    for frame in published_frames(contract):
        entry = FaultEntry(kind="double_frame", target=frame)
        yield fault_case(entry, contract, partial(_ending, Bounds(contract), frame))


def _ending(bounds: Bounds, frame: str, step: CellStep) -> Ending:
    """A step that does not look the frame up is concerned as long as the cell stands where the frame has led it."""
    if step.kind == "move" and frame in step.frames:
        return ends_in("tf_failure", within_s=bounds.asked_s())
    if bounds.contract.frames[frame].kind != "dynamic":
        return BORNE
    return ends_in("tf_failure", SUCCEEDED, within_s=bounds.watched_s())
