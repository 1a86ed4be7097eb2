"""The samples of a device arrive late: the images of a camera, the joint states of an arm."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.bus.network import EdgeBehaviour
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import BORNE, SUCCEEDED, Ending, FaultCase, ends_in, fault_case
from cellc.mock.faults.cell_steps import CellStep
from cellc.mock.faults.contents import image_topic, joints_of_device
from cellc.mock.faults.observed import cameras
from cellc.mock.faults.silent_states import catch_up, delay, of_joints
from cellc.mock.plant import Plant
from cellc.mock.task.bounds import joint_state_age_s

TIMES_TOO_LATE = 3.0
"""A case delays by this multiple of the age that is allowed."""


@dataclass(frozen=True, slots=True)
class Delay:
    """Delays the topic of a camera, or every broadcaster that reports a joint of the device."""

    topic: str | None
    joints: tuple[str, ...]
    delay_s: float

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Delay | None:
        """Return the fault of an entry; None where its target has neither images nor joints."""
        topic, joints = image_topic(contract, entry.target), joints_of_device(contract, entry.target)
        return cls(topic, joints, entry.delay_s or 0.0) if joints or topic else None

    def begin(self, plant: Plant) -> None:
        """Delay what is stamped from now on."""
        if self.topic is not None:
            plant.network.disturb(self.topic, EdgeBehaviour(latency_s=self.delay_s))
        for history in of_joints(plant, self.joints):
            delay(history, plant.now_ns, round(self.delay_s * 1e9))

    def end(self, plant: Plant) -> None:
        """Let what is stamped from now on arrive at once."""
        if self.topic is not None:
            plant.network.calm(self.topic)
        for history in of_joints(plant, self.joints):
            catch_up(history, plant.now_ns, round(self.delay_s * 1e9))


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every device with joints, and every camera in whose images something is observed."""
    bounds = Bounds(contract)
    for device in contract.devices:
        if joints_of_device(contract, device):
            delay_s = TIMES_TOO_LATE * joint_state_age_s(contract)
            entry = FaultEntry(kind="delay", target=device, delay_s=delay_s)
            yield fault_case(entry, contract, partial(_late_states, bounds))
    for device, frames in cameras(contract).items():
        if frames:
            delay_s = TIMES_TOO_LATE * max(map(bounds.observation_age_s, frames))
            entry = FaultEntry(kind="delay", target=device, delay_s=delay_s)
            yield fault_case(entry, contract, partial(_late_images, bounds, frames))


def _late_states(bounds: Bounds, step: CellStep) -> Ending:
    return ends_in("stale_state", within_s=bounds.joint_state_s()) if step.controllers else BORNE


def _late_images(bounds: Bounds, frames: tuple[str, ...], step: CellStep) -> Ending:
    within_s = max(map(bounds.observation_s, frames))
    borne = () if step.observes in frames else (SUCCEEDED,)
    return ends_in("stale_state", *borne, within_s=within_s)
