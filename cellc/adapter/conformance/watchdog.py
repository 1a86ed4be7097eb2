"""Checks of the watchdog, and of what comes after a stop: nothing, until a person has looked."""

from __future__ import annotations

from math import nan

from cellc.adapter.conformance.case import (
    ConformanceCase,
    Rig,
    active,
    require,
    require_error,
    require_phase,
    require_standstill,
    stream,
)
from cellc.adapter.device import DeviceAdapter
from cellc.adapter.messages import JointCommand, RefusalReason
from cellc.adapter.phase import Phase


def _silent(rig: Rig, adapter: DeviceAdapter) -> None:
    """Let a stream fall silent for longer than the watchdog allows."""
    stream(rig, adapter, periods=10)
    rig.wait(1.1 * adapter.model.command_timeout_s)


def _stops(rig: Rig) -> None:
    adapter = active(rig)
    _silent(rig, adapter)
    require_phase(adapter, Phase.STOPPED)
    require(bool(adapter.read().fault), "the stop has no reason in words")
    rig.wait(adapter.model.stop_time_s)
    require_standstill(rig, adapter)


def _patience(rig: Rig) -> None:
    adapter = active(rig)
    stream(rig, adapter, periods=5)
    rig.wait(0.8 * adapter.model.command_timeout_s - adapter.model.command_period_s)
    require_phase(adapter, Phase.ACTIVE)
    stream(rig, adapter, periods=1)
    require_phase(adapter, Phase.ACTIVE)
    adapter.hold()


def _not_fed(rig: Rig) -> None:
    adapter = active(rig)
    stream(rig, adapter, periods=5)
    for _ in range(4):
        rig.wait(0.4 * adapter.model.command_timeout_s)
        positions = (nan,) * len(adapter.model.joints)
        adapter.command(JointCommand(adapter.now_ns(), positions))
    require_phase(adapter, Phase.STOPPED)


def _rests_after_hold(rig: Rig) -> None:
    adapter = active(rig)
    stream(rig, adapter, periods=5)
    adapter.hold()
    rig.wait(3.0 * adapter.model.command_timeout_s)
    require_phase(adapter, Phase.ACTIVE)


def _needs_a_person(rig: Rig) -> None:
    adapter = active(rig)
    _silent(rig, adapter)
    refusal = adapter.command(JointCommand(adapter.now_ns(), adapter.read().positions))
    require(refusal is not None and refusal.reason is RefusalReason.NOT_ACTIVE, "a stopped device took a command")
    require_error(adapter.activate, RuntimeError, "a stop was left without acknowledgement")
    require_phase(adapter, Phase.STOPPED)


def _forgets(rig: Rig) -> None:
    adapter = active(rig)
    _silent(rig, adapter)
    rig.wait(adapter.model.stop_time_s)
    adapter.acknowledge()
    require_phase(adapter, Phase.INACTIVE)
    require(not adapter.read().fault, "an acknowledged stop still tells of its fault")
    adapter.activate()
    require_standstill(rig, adapter)
    stream(rig, adapter, periods=1)
    adapter.hold()


WATCHDOG_CASES = (
    ConformanceCase("a stream that falls silent ends in a stop", _stops),
    ConformanceCase("a stream with a pause within the watchdog's time goes on", _patience),
    ConformanceCase("refused commands do not keep the watchdog quiet", _not_fed),
    ConformanceCase("the watchdog rests after a hold", _rests_after_hold),
    ConformanceCase("a stop is left by a person alone", _needs_a_person),
    ConformanceCase("no old command returns after a stop", _forgets),
)
