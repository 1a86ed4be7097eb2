"""Conformance cases of commands: bounds, and the watchdog that stops where they stay away."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import isfinite, nan

from cellc.contract.adapter.conformance.lifecycle import (
    ConformanceCase,
    Rig,
    active,
    require,
    require_error,
    require_phase,
    require_standstill,
    stream,
)
from cellc.contract.adapter.device import DeviceAdapter, JointCommand, Phase, RefusalReason

Spoil = Callable[[DeviceAdapter], JointCommand]
"""Makes a command that must be refused."""


def _followed(rig: Rig) -> None:
    adapter = active(rig)
    before = adapter.read().positions
    sent = stream(rig, adapter, periods=20)
    at = adapter.read().positions
    moved, wanted = at[0] - before[0], sent[0] - before[0]
    require(moved > 0.5 * wanted, f"the first joint moved by {moved:.6g}, it was sent by {wanted:.6g}")
    others = max((abs(a - b) for a, b in zip(at[1:], before[1:], strict=True)), default=0.0)
    require(others < 0.1 * wanted, "a joint moved that was sent nowhere")
    adapter.hold()


def _held(rig: Rig) -> None:
    adapter = active(rig)
    stream(rig, adapter, periods=20)
    adapter.hold()
    rig.wait(adapter.model.stop_time_s)
    require_standstill(rig, adapter)
    require_phase(adapter, Phase.ACTIVE)


def _refused(spoil: Spoil, reason: RefusalReason, rig: Rig) -> None:
    adapter = active(rig)
    refusal = adapter.command(spoil(adapter))
    require(refusal is not None, f"a command was taken that is {reason.value}")
    require(refusal is None or refusal.reason is reason, f"refused as {refusal and refusal.reason}, it is {reason}")
    require(refusal is None or bool(refusal.text), "a refusal has no reason in words")
    rig.wait(adapter.model.command_period_s)
    require_standstill(rig, adapter)


def _inactive(rig: Rig) -> None:
    adapter = rig.new()
    adapter.connect()
    refusal = adapter.command(_here(adapter))
    require(refusal is not None and refusal.reason is RefusalReason.NOT_ACTIVE, "an inactive device took a command")


def _here(adapter: DeviceAdapter) -> JointCommand:
    return JointCommand(adapter.now_ns(), adapter.read().positions)


def _with_first(adapter: DeviceAdapter, position: float) -> JointCommand:
    here = _here(adapter)
    return JointCommand(here.stamp_ns, (position, *here.positions[1:]))


def _too_short(adapter: DeviceAdapter) -> JointCommand:
    here = _here(adapter)
    return JointCommand(here.stamp_ns, here.positions[1:])


def _not_a_number(adapter: DeviceAdapter) -> JointCommand:
    return _with_first(adapter, nan)


def _out_of_range(adapter: DeviceAdapter) -> JointCommand:
    upper = adapter.model.joints[0].upper
    return _with_first(adapter, upper + 0.1 if isfinite(upper) else nan)


def _too_fast(adapter: DeviceAdapter) -> JointCommand:
    step = 1.01 * adapter.model.joints[0].velocity * adapter.model.command_period_s
    return _with_first(adapter, adapter.read().positions[0] + step)


def _aged(periods: float, adapter: DeviceAdapter) -> JointCommand:
    here = _here(adapter)
    return JointCommand(here.stamp_ns - round(periods * adapter.model.command_timeout_s * 1e9), here.positions)


def _unbounded_joint(rig: Rig) -> bool:
    return not isfinite(rig.new().model.joints[0].upper)


def _range(rig: Rig) -> None:
    if not _unbounded_joint(rig):
        _refused(_out_of_range, RefusalReason.OUT_OF_RANGE, rig)


COMMAND_CASES = (
    ConformanceCase("a stream of bounded commands is followed", _followed),
    ConformanceCase("a hold ends in standstill in time and the device stays active", _held),
    ConformanceCase("an inactive device takes no command", _inactive),
    ConformanceCase(
        "a command that leaves out a joint is refused", partial(_refused, _too_short, RefusalReason.WRONG_SIZE)
    ),
    ConformanceCase(
        "a command that is not a number is refused", partial(_refused, _not_a_number, RefusalReason.NOT_FINITE)
    ),
    ConformanceCase("a command beyond a limit is refused", _range),
    ConformanceCase(
        "a command faster than a joint may be is refused", partial(_refused, _too_fast, RefusalReason.TOO_FAST)
    ),
    ConformanceCase("an old command is refused", partial(_refused, partial(_aged, 1.5), RefusalReason.STALE)),
    ConformanceCase(
        "a command from the future is refused", partial(_refused, partial(_aged, -1.5), RefusalReason.STALE)
    ),
)


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
