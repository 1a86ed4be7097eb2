"""Frames and time: a frame with no publisher or with two, and a clock that jumps."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import ClassVar

from cellc.contract.contract import Contract, ContractFrame
from cellc.contract.faults import FaultKind
from cellc.contract.frozen import dataclass
from cellc.contract.rehearsals import FaultEntry
from cellc.contract.transforms import Pose
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.faults.cases import BORNE, CellStep, Ending, FaultCase, ends_in, fault_case, published_frames
from cellc.mock.faults.endings import Bounds
from cellc.mock.faults.ports import FaultPorts
from cellc.mock.tf.sources import SampledSource

AUTHORITY = "second_authority"
RATE_HZ = 10.0
BESIDE_M = 0.1
"""How far beside the parent's origin the second node sees the frame."""
DEFAULT_DOMAIN = "ros"
JUMPS_S = (1.0, -1.0)
"""Cases jump by more than any age that is allowed."""


@dataclass(frozen=True, slots=True)
class DropFrame:
    """Stops the publisher of a frame; a frame of /tf_static stays known to who has heard it, as in tf2."""

    kind: ClassVar[FaultKind] = FaultKind.DROP_FRAME
    frame: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> DropFrame | None:
        """Return the fault of an entry; None where its target is no frame."""
        return cls(entry.target) if entry.target in contract.frames else None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every dynamic frame, and of each group the moving link that is nearest to its base."""
        for frame in published_frames(contract):
            entry = FaultEntry(kind=cls.kind, target=frame)
            yield fault_case(entry, contract, partial(_dropped, Bounds(contract), frame))

    def begin(self, ports: FaultPorts) -> None:
        """Stop publishing."""
        ports.transforms.drop(self.frame)

    def end(self, ports: FaultPorts) -> None:
        """Publish again."""
        ports.transforms.resume(self.frame)


class DoubleFrame:
    """Publishes a frame under another authority, and places it elsewhere.

    tf2 stores what both publish and complains of nothing, so that lookups jump from one to the other.
    """

    kind: ClassVar[FaultKind] = FaultKind.DOUBLE_FRAME

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

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every dynamic frame, and of each group the moving link that is nearest to its base."""
        for frame in published_frames(contract):
            entry = FaultEntry(kind=cls.kind, target=frame)
            yield fault_case(entry, contract, partial(_doubled, Bounds(contract), frame))

    def begin(self, ports: FaultPorts) -> None:
        """Publish from now on."""
        self._active = True
        source = ports.transforms.add_authority(self._frame, self._facts, AUTHORITY)
        ports.schedule.every(ports.schedule.now_ns, RATE_HZ, lambda _: self._publish(ports, source))

    def end(self, ports: FaultPorts) -> None:
        """Publish no more; what was published stays in every buffer."""
        self._active = False

    def _publish(self, ports: FaultPorts, source: SampledSource) -> None:
        if self._active:
            ports.transforms.publish(source, Pose((0.0, 0.0, BESIDE_M), (0.0, 0.0, 0.0, 1.0)))


@dataclass(frozen=True, slots=True)
class JumpClock:
    """Sets a clock, or all clocks of a domain: ages and lookups are wrong until all samples are new."""

    kind: ClassVar[FaultKind] = FaultKind.JUMP_CLOCK
    clock: str
    jump_s: float

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> JumpClock | None:
        """Return the fault of an entry; None where its target is neither a clock nor a domain."""
        domains = {DEFAULT_DOMAIN, *(clock.domain for clock in contract.clocks.values())}
        return cls(entry.target, entry.jump_s or 0.0) if entry.target in domains | contract.clocks.keys() else None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every clock, once forwards and once back."""
        for clock in contract.clocks or (DEFAULT_DOMAIN,):
            for jump_s in JUMPS_S:
                entry = FaultEntry(kind=cls.kind, target=clock, jump_s=jump_s)
                yield fault_case(entry, contract, partial(_jumped, Bounds(contract)))

    def begin(self, ports: FaultPorts) -> None:
        """Jump."""
        ports.clocks.jump(self.clock, round(self.jump_s * 1e9))

    def end(self, ports: FaultPorts) -> None:
        """Jump back."""
        ports.clocks.jump(self.clock, -round(self.jump_s * 1e9))


def _dropped(bounds: Bounds, frame: str, step: CellStep) -> Ending:
    """An observation from before the fault can still be looked up, so that a move may bear it."""
    if step.kind != "move" or frame not in step.frames:
        return BORNE
    return ends_in(AttemptOutcome.TF_FAILURE, AttemptOutcome.SUCCEEDED, within_s=bounds.asked_s())


def _doubled(bounds: Bounds, frame: str, step: CellStep) -> Ending:
    """A step that does not look the frame up is affected as long as the cell is where the frame has led it."""
    if step.kind == "move" and frame in step.frames:
        return ends_in(AttemptOutcome.TF_FAILURE, within_s=bounds.asked_s())
    if bounds.contract.frames[frame].kind != "dynamic":
        return BORNE
    return ends_in(AttemptOutcome.TF_FAILURE, AttemptOutcome.SUCCEEDED, within_s=bounds.watched_s())


def _jumped(bounds: Bounds, step: CellStep) -> Ending:
    """Whatever is stale or cannot be looked up afterwards ends the step; new samples let it go on."""
    within_s = max([bounds.joint_state_s(), *(map(bounds.observation_s, bounds.dynamic_frames()))])
    if step.kind == "move" and step.frames:
        return ends_in(
            AttemptOutcome.STALE_STATE,
            AttemptOutcome.TF_FAILURE,
            AttemptOutcome.SUCCEEDED,
            within_s=within_s + bounds.asked_s(),
        )
    return ends_in(AttemptOutcome.STALE_STATE, AttemptOutcome.SUCCEEDED, within_s=within_s)
