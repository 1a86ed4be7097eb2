"""Checks of the model, of the phases, and of stamped state."""

from __future__ import annotations

from math import isnan

from cellc.adapter.conformance.case import (
    ConformanceCase,
    Rig,
    active,
    require,
    require_error,
    require_phase,
    require_standstill,
)
from cellc.adapter.phase import Phase


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
    ConformanceCase("an active device holds for as long as nobody commands", _activated),
    ConformanceCase("a deactivated device is inactive and can be activated again", _deactivated),
    ConformanceCase("a disconnected device is gone for good", _disconnected),
    ConformanceCase("states are stamped when they are measured", _stamps),
    ConformanceCase("states have a value for every joint", _sizes),
    ConformanceCase("only a stop can be acknowledged", _needless_acknowledgement),
)
