"""A sensor repeats its last sample with its old stamp."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import FaultCase, fault_case
from cellc.mock.faults.observed import cameras, ending_unobserved
from cellc.mock.plant import Plant


@dataclass(frozen=True, slots=True)
class Freeze:
    """Freezes the stream of a device."""

    device: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> Freeze | None:
        """Return the fault of an entry; None where its target is no camera."""
        return cls(entry.target) if entry.target in cameras(contract) else None

    def begin(self, plant: Plant) -> None:
        """Repeat the last image from now on."""
        plant.cameras[self.device].frozen = True

    def end(self, plant: Plant) -> None:
        """Stream again."""
        plant.cameras[self.device].frozen = False


def cases(contract: Contract) -> Iterator[FaultCase]:
    """Yield every camera."""
    for device, frames in cameras(contract).items():
        entry = FaultEntry(kind="freeze", target=device)
        yield fault_case(entry, contract, ending_unobserved(Bounds(contract), frames))
