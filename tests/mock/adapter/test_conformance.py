"""The mock's adapter keeps the contract, and the checks notice adapters that do not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import inf

import pytest

from cellc.contract.adapter import (
    AdapterModel,
    DeviceAdapter,
    DeviceState,
    JointCommand,
    JointModel,
    Phase,
    Refusal,
    Unit,
)
from cellc.contract.adapter.conformance import CASES, ConformanceCase
from cellc.mock.adapter.simulated import SimulatedAdapter

MODEL = AdapterModel(
    device="arm",
    joints=(
        JointModel("shoulder", Unit.RADIAN, -3.0, 3.0, 1.0),
        JointModel("elbow", Unit.RADIAN, -inf, inf, 2.0),
        JointModel("lift", Unit.METRE, 0.0, 0.5, 0.2),
    ),
    clock="arm",
    command_period_s=0.002,
    command_timeout_s=0.02,
    stop_time_s=0.1,
)


class SimulatedRig:
    """Adapters of one kind on a clock that `wait` moves."""

    def __init__(self, kind: Callable[..., DeviceAdapter] = SimulatedAdapter) -> None:
        self._kind = kind
        self._now_ns = 5_000_000_000

    def new(self) -> DeviceAdapter:
        return self._kind(MODEL, (0.0, 0.0, 0.25), lambda: self._now_ns)

    def wait(self, seconds: float) -> None:
        self._now_ns += round(seconds * 1e9)


@pytest.mark.parametrize("case", CASES, ids=str)
def test_simulated_adapter_keeps_the_contract(case: ConformanceCase) -> None:
    case.run(SimulatedRig())


class Clipping(SimulatedAdapter):
    """Takes what it cannot do, and does what it can."""

    def command(self, command: JointCommand) -> Refusal | None:
        refusal = super().command(command)
        if refusal is not None and self.read().phase is Phase.ACTIVE:
            super().command(JointCommand(self.now_ns(), self.read().positions))
            return None
        return refusal


class Restless(SimulatedAdapter):
    """Takes refused commands as a sign of life."""

    def command(self, command: JointCommand) -> Refusal | None:
        refusal = super().command(command)
        if refusal is not None and self.read().phase is Phase.ACTIVE:
            super().command(JointCommand(self.now_ns(), self.read().positions))
        return refusal


class Forgiving(SimulatedAdapter):
    """Leaves a stop as soon as somebody activates it."""

    def activate(self) -> None:
        if self.read().phase is Phase.STOPPED:
            self.acknowledge()
        super().activate()


class Unwatched(SimulatedAdapter):
    """Has no watchdog."""

    def _watch(self) -> None:
        return


class Frozen(SimulatedAdapter):
    """Stamps every state with the time of the connection."""

    def connect(self) -> None:
        super().connect()
        self._connected_ns = self.now_ns()

    def read(self) -> DeviceState:
        return replace(super().read(), stamp_ns=self._connected_ns)


class Coasting(SimulatedAdapter):
    """Takes four times as long to stop as it says."""

    def __init__(self, model: AdapterModel, positions: tuple[float, ...], now_ns: Callable[[], int]) -> None:
        super().__init__(replace(model, stop_time_s=4.0 * model.stop_time_s), positions, now_ns)
        self._stated = model

    @property
    def model(self) -> AdapterModel:
        return self._stated


@pytest.mark.parametrize(
    ("kind", "sentence"),
    [
        (Clipping, "a command faster than a joint may be is refused"),
        (Clipping, "an old command is refused"),
        (Restless, "refused commands do not keep the watchdog quiet"),
        (Forgiving, "a stop is left by a person alone"),
        (Unwatched, "a stream that falls silent ends in a stop"),
        (Frozen, "states are stamped when they are measured"),
        (Coasting, "a hold ends in standstill in time and the device stays active"),
    ],
)
def test_checks_notice_an_adapter_that_breaks_the_contract(kind: type[SimulatedAdapter], sentence: str) -> None:
    case = next(case for case in CASES if case.sentence == sentence)
    with pytest.raises(AssertionError):
        case.run(SimulatedRig(kind))
