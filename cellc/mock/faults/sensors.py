"""Faults of digital inputs: the sensor of a switched device that does not change any more."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import ClassVar

from cellc.contract.contract import Contract
from cellc.contract.devices import ContractSwitched
from cellc.contract.faults import FaultKind
from cellc.contract.frozen import dataclass
from cellc.contract.rehearsals import FaultEntry
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.faults.cases import BORNE, CellStep, Ending, FaultCase, ends_in, fault_case
from cellc.mock.faults.endings import Bounds
from cellc.mock.faults.ports import FaultPorts


@dataclass(frozen=True, slots=True)
class SilentSensor:
    """The sensors of a device read for ever what they read now, as with a cut wire or a sensor out of its place."""

    kind: ClassVar[FaultKind] = FaultKind.SILENT_SENSOR
    device: str

    @classmethod
    def of(cls, entry: FaultEntry, contract: Contract) -> SilentSensor | None:
        """Return the fault of an entry; None where no sensor of its target is wired."""
        return cls(entry.target) if entry.target in _sensed(contract) else None

    @classmethod
    def cases(cls, contract: Contract) -> Iterator[FaultCase]:
        """Yield every device with a sensor that is wired."""
        for device, facts in _sensed(contract).items():
            entry = FaultEntry(kind=cls.kind, target=device)
            yield fault_case(
                entry, contract, partial(_unseen, Bounds(contract), device, facts.within_s), hits_running_step=True
            )

    def begin(self, ports: FaultPorts) -> None:
        """Let them read nothing new."""
        ports.switches.silence(self.device, ports.schedule.now_ns)

    def end(self, ports: FaultPorts) -> None:
        """Let them read again."""
        ports.switches.restore(self.device)


def _sensed(contract: Contract) -> dict[str, ContractSwitched]:
    switched = {name: device.switched for name, device in contract.devices.items()}
    return {name: facts for name, facts in switched.items() if facts is not None and facts.inputs}


def _unseen(bounds: Bounds, device: str, within_s: float, step: CellStep) -> Ending:
    """Who waits for the sensor waits until its timeout, unless it read before what is waited for."""
    if (step.kind, step.target) != ("sense", device):
        return BORNE
    outcomes = (AttemptOutcome.TIMEOUT, AttemptOutcome.SUCCEEDED)
    return ends_in(*outcomes, within_s=within_s + bounds.watched_s())
