"""Samples of a device that stay away or come late: the images of a camera, the joint states of an arm."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar

from cellc.contract.contract import Contract
from cellc.contract.faults import FaultKind
from cellc.contract.frozen import dataclass
from cellc.contract.rehearsals import FaultEntry
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.bus.network import EdgeBehavior
from cellc.mock.faults.cases import (
    CellStep,
    Ending,
    FaultCase,
    cameras,
    ends_in,
    fault_case,
    image_topic,
    joints_of_device,
)
from cellc.mock.faults.endings import Bounds, StepEnding, stateless, unobserved
from cellc.mock.faults.ports import FaultPorts
from cellc.mock.task.bounds import joint_state_age_s

TIMES_TOO_LATE = 3.0
"""A case delays by this multiple of the age that is allowed."""


@dataclass(frozen=True, slots=True)
class Freeze:
    """A device repeats its last sample with its old stamp; a message that comes again so tells nothing new."""

    kind: ClassVar[FaultKind] = FaultKind.FREEZE
    device: str
    joints: tuple[str, ...]

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Freeze | None:
        """Return the fault of an entry; None where its target is neither a camera nor has joints."""
        joints = joints_of_device(contract, entry.target)
        return cls(entry.target, joints) if joints or entry.target in cameras(contract) else None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every camera, and every device with joints."""
        bounds = Bounds(contract)
        for device, frames in cameras(contract).items():
            yield fault_case(FaultEntry(kind=cls.kind, target=device), contract, unobserved(bounds, frames))
        for device in contract.devices:
            if joints_of_device(contract, device):
                yield fault_case(FaultEntry(kind=cls.kind, target=device), contract, stateless(bounds))

    def begin(self, ports: FaultPorts) -> None:
        """Repeat the last sample from now on."""
        ports.samples.freeze_camera(self.device, frozen=True)
        ports.samples.hold_back(ports.samples.of_joints(self.joints))

    def end(self, ports: FaultPorts) -> None:
        """Stream again."""
        ports.samples.freeze_camera(self.device, frozen=False)
        ports.samples.release(ports.samples.of_joints(self.joints))


@dataclass(frozen=True, slots=True)
class Delay:
    """Delays the topic of a camera, or every broadcaster that reports a joint of the device."""

    kind: ClassVar[FaultKind] = FaultKind.DELAY
    topic: str | None
    joints: tuple[str, ...]
    delay_s: float

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Delay | None:
        """Return the fault of an entry; None where its target has neither images nor joints."""
        topic, joints = image_topic(contract, entry.target), joints_of_device(contract, entry.target)
        return cls(topic, joints, entry.delay_s or 0.0) if joints or topic else None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every device with joints, and every camera in whose images something is observed."""
        bounds = Bounds(contract)
        for device in contract.devices:
            if joints_of_device(contract, device):
                delay_s = TIMES_TOO_LATE * joint_state_age_s(contract)
                yield fault_case(FaultEntry(kind=cls.kind, target=device, delay_s=delay_s), contract, stateless(bounds))
        for device, frames in cameras(contract).items():
            if frames:
                delay_s = TIMES_TOO_LATE * max(map(bounds.observation_age_s, frames))
                entry = FaultEntry(kind=cls.kind, target=device, delay_s=delay_s)
                yield fault_case(entry, contract, _late_images(bounds, frames))

    def begin(self, ports: FaultPorts) -> None:
        """Delay what is stamped from now on."""
        if self.topic is not None:
            ports.network.disturb(self.topic, EdgeBehavior(latency_s=self.delay_s))
        ports.samples.hold_back(ports.samples.of_joints(self.joints), round(self.delay_s * 1e9))

    def end(self, ports: FaultPorts) -> None:
        """Let what is stamped from now on arrive immediately."""
        if self.topic is not None:
            ports.network.restore_topic(self.topic)
        ports.samples.release(ports.samples.of_joints(self.joints), round(self.delay_s * 1e9))


def _late_images(bounds: Bounds, frames: tuple[str, ...]) -> StepEnding:
    within_s = max(map(bounds.observation_s, frames))

    def ending(step: CellStep) -> Ending:
        borne = () if step.observes in frames else (AttemptOutcome.SUCCEEDED,)
        return ends_in(AttemptOutcome.STALE_STATE, *borne, within_s=within_s)

    return ending
