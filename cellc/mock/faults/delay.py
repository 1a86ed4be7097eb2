"""Joint states of a device arrive late."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from cellc.mock.plant import Plant
from cellc.mock.world.joint_states import JointStateHistory, LateArrival


@dataclass(frozen=True, slots=True)
class Delay:
    """Delays every broadcaster that reports a joint of the device."""

    joints: tuple[str, ...]
    delay_s: float

    def begin(self, plant: Plant) -> None:
        """Delay what is stamped from now on."""
        for history in self._histories(plant):
            history.late.append(LateArrival(plant.now_ns, None, round(self.delay_s * 1e9)))

    def end(self, plant: Plant) -> None:
        """Let what is stamped from now on arrive at once."""
        for history in self._histories(plant):
            history.late[-1] = replace(history.late[-1], until_ns=plant.now_ns)

    def _histories(self, plant: Plant) -> Iterator[JointStateHistory]:
        for history in plant.control.histories.values():
            if any(joint in history.names for joint in self.joints):
                yield history
