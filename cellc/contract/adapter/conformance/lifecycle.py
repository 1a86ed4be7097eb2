"""Conformance cases: what each is given, and those of the lifecycle."""

from __future__ import annotations

from collections.abc import Callable
from math import isnan
from typing import Protocol

from cellc.contract.adapter.device import DeviceAdapter, JointCommand, Phase
from cellc.contract.frozen import dataclass

STANDSTILL = 1e-3
"""rad/s or m/s below which a joint is at standstill."""


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
    """Require that every joint is at standstill, and stays where it is."""
    before = adapter.read()
    require(all(abs(speed) < STANDSTILL for speed in before.velocities), f"it still moves: {before.velocities}")
    rig.wait(0.1)
    after = adapter.read()
    away = max(abs(a - b) for a, b in zip(before.positions, after.positions, strict=True))
    require(away < STANDSTILL * 0.1, f"it moved by {away:.6g} in 0.1 s of standstill")


def require_phase(adapter: DeviceAdapter, phase: Phase) -> None:
    """Require a phase."""
    current = adapter.read().phase
    require(current is phase, f"it is {current.value}, not {phase.value}")


def require_error(action: Callable[[], object], error: type[Exception], text: str) -> None:
    """Require that an action raises an error."""
    try:
        action()
    except error:
        return
    raise AssertionError(text)


def _model(rig: Rig) -> None:
    model = rig.new().model
    require(len(model.joints) > 0, "no joint is named")
    require(len(set(model.joint_names)) == len(model.joints), "two joints have one name")
    for joint in model.joints:
        bounded = joint.lower < joint.upper and not isnan(joint.lower + joint.upper)
        require(bounded or joint.lower == -joint.upper, f"`{joint.name}` has no range")
        require(0.0 < joint.velocity < float("inf"), f"`{joint.name}` has no greatest speed")
    require(0.0 < model.command_period_s < model.command_timeout_s, "the watchdog is shorter than a command period")
    require(0.0 < model.stop_time_s < float("inf"), "the stop takes no time, or for ever")
    require(bool(model.clock), "the clock of the stamps has no name")


def _unconnected(rig: Rig) -> None:
    adapter = rig.new()
    require_error(adapter.read, ConnectionError, "a state was read without a connection")
    require_error(adapter.activate, RuntimeError, "it was activated without a connection")


def _connected(rig: Rig) -> None:
    adapter = rig.new()
    adapter.connect()
    require_phase(adapter, Phase.INACTIVE)
    require_standstill(rig, adapter)
    require(not adapter.read().fault, "a device that is not stopped tells of a fault")


def _activated(rig: Rig) -> None:
    adapter = active(rig)
    require_phase(adapter, Phase.ACTIVE)
    rig.wait(3.0 * adapter.model.command_timeout_s)
    require_phase(adapter, Phase.ACTIVE)
    require_standstill(rig, adapter)


def _deactivated(rig: Rig) -> None:
    adapter = active(rig)
    adapter.deactivate()
    require_phase(adapter, Phase.INACTIVE)
    adapter.activate()
    require_phase(adapter, Phase.ACTIVE)


def _disconnected(rig: Rig) -> None:
    adapter = active(rig)
    adapter.disconnect()
    require_error(adapter.read, ConnectionError, "a state was read after the connection was closed")
    require_error(adapter.connect, ConnectionError, "a finalized adapter connected again")


def _stamps(rig: Rig) -> None:
    adapter = active(rig)
    last_ns = adapter.read().stamp_ns
    for _ in range(5):
        rig.wait(2.0 * adapter.model.command_period_s)
        state, now_ns = adapter.read(), adapter.now_ns()
        require(state.stamp_ns > last_ns, "the stamp of a later state is no later")
        age_s = (now_ns - state.stamp_ns) / 1e9
        require(0.0 <= age_s <= adapter.model.command_timeout_s, f"a state that was just read is {age_s:.6f} s old")
        last_ns = state.stamp_ns


def _sizes(rig: Rig) -> None:
    adapter = active(rig)
    state, count = adapter.read(), len(adapter.model.joints)
    require(len(state.positions) == count, "not every joint has a position")
    require(len(state.velocities) == count, "not every joint has a velocity")
    require(len(state.efforts) in (0, count), "some joints have an effort and some have none")


def _needless_acknowledgement(rig: Rig) -> None:
    adapter = active(rig)
    require_error(adapter.acknowledge, RuntimeError, "a stop was acknowledged that never was")
    require_phase(adapter, Phase.ACTIVE)


LIFECYCLE_CASES = (
    ConformanceCase("the model states joints, bounds and times", _model),
    ConformanceCase("nothing is read or activated before it is connected", _unconnected),
    ConformanceCase("connecting moves nothing", _connected),
    ConformanceCase("an active device holds for as long as it gets no command", _activated),
    ConformanceCase("a deactivated device is inactive and can be activated again", _deactivated),
    ConformanceCase("a disconnected device is gone for good", _disconnected),
    ConformanceCase("states are stamped when they are measured", _stamps),
    ConformanceCase("states have a value for every joint", _sizes),
    ConformanceCase("only a stop can be acknowledged", _needless_acknowledgement),
)
