"""A conformance check, and what it needs of whoever runs it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from cellc.adapter.device import DeviceAdapter
from cellc.adapter.messages import JointCommand
from cellc.adapter.phase import Phase

STANDSTILL = 1e-3
"""rad/s or m/s below which a joint stands still."""


class Rig(Protocol):
    """Makes adapters and lets time pass."""

    def new(self) -> DeviceAdapter:
        """Return an adapter that is not connected yet, its device at rest away from the limits of its joints."""
        ...

    def wait(self, seconds: float) -> None:
        """Let so much time of the device pass; for real hardware a sleep."""
        ...


@dataclass(frozen=True, slots=True)
class ConformanceCase:
    """One check: a sentence, and a function that raises AssertionError where the sentence is not true."""

    sentence: str
    run: Callable[[Rig], None]

    def __str__(self) -> str:
        return self.sentence.replace(" ", "_")


def require(condition: bool, text: str) -> None:
    """Raise AssertionError with a text where a condition does not hold."""
    if not condition:
        raise AssertionError(text)


def active(rig: Rig) -> DeviceAdapter:
    """Return an adapter that takes commands."""
    adapter = rig.new()
    adapter.connect()
    adapter.activate()
    return adapter


def stream(rig: Rig, adapter: DeviceAdapter, periods: int) -> tuple[float, ...]:
    """Move the first joint for some periods at a tenth of its greatest speed; return where it was sent last."""
    model = adapter.model
    positions = list(adapter.read().positions)
    step = 0.1 * model.joints[0].velocity * model.command_period_s
    for _ in range(periods):
        positions[0] += step
        refusal = adapter.command(JointCommand(adapter.now_ns(), tuple(positions)))
        require(refusal is None, f"a command within all bounds was refused: {refusal and refusal.text}")
        rig.wait(model.command_period_s)
    return tuple(positions)


def require_standstill(rig: Rig, adapter: DeviceAdapter) -> None:
    """Require that every joint stands still, and stays where it is."""
    before = adapter.read()
    require(all(abs(speed) < STANDSTILL for speed in before.velocities), f"it still moves: {before.velocities}")
    rig.wait(0.1)
    after = adapter.read()
    away = max(abs(a - b) for a, b in zip(before.positions, after.positions, strict=True))
    require(away < STANDSTILL * 0.1, f"it moved by {away:.6g} in 0.1 s of standstill")


def require_phase(adapter: DeviceAdapter, phase: Phase) -> None:
    """Require a phase."""
    found = adapter.read().phase
    require(found is phase, f"it is {found.value}, not {phase.value}")


def require_error(action: Callable[[], object], error: type[Exception], text: str) -> None:
    """Require that an action raises an error."""
    try:
        action()
    except error:
        return
    raise AssertionError(text)
