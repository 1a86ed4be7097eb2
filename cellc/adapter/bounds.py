"""The bounds of a command, for every implementation to share: refused as a whole, never clipped."""

from __future__ import annotations

import math
from collections.abc import Sequence

from cellc.adapter.messages import JointCommand, Refusal, RefusalReason
from cellc.adapter.model import AdapterModel, JointModel
from cellc.adapter.phase import Phase

STEP_TOLERANCE = 1e-6
"""Share by which a step may exceed what the greatest speed allows: rounding of a stream that runs at that speed."""


def check_command(
    model: AdapterModel, command: JointCommand, *, phase: Phase, last: Sequence[float], now_ns: int
) -> Refusal | None:
    """Return why a command must be refused; None for one to follow.

    Args:
        phase: of the device.
        last: positions of the last command that was taken, or where the joints stand if there is no stream.
        now_ns: on the clock of the model.
    """
    if phase is not Phase.ACTIVE:
        return Refusal(RefusalReason.NOT_ACTIVE, f"`{model.device}` is {phase.value}")
    if len(command.positions) != len(model.joints):
        text = f"{len(command.positions)} positions for {len(model.joints)} joints"
        return Refusal(RefusalReason.WRONG_SIZE, text)
    age_s = (now_ns - command.stamp_ns) / 1e9
    if abs(age_s) > model.command_timeout_s:
        text = f"command is {age_s:.3f} s old, {model.command_timeout_s:g} s allowed"
        return Refusal(RefusalReason.STALE, text)
    for joint, position, before in zip(model.joints, command.positions, last, strict=True):
        refusal = _check_joint(joint, position, before, model.command_period_s)
        if refusal is not None:
            return refusal
    return None


def _check_joint(joint: JointModel, position: float, before: float, period_s: float) -> Refusal | None:
    unit = joint.unit.value
    if not math.isfinite(position):
        return Refusal(RefusalReason.NOT_FINITE, f"`{joint.name}` is sent to {position}")
    if not joint.lower <= position <= joint.upper:
        text = f"`{joint.name}` is sent to {position:.6g} {unit}, allowed {joint.lower:.6g} to {joint.upper:.6g} {unit}"
        return Refusal(RefusalReason.OUT_OF_RANGE, text)
    speed = abs(position - before) / period_s
    if speed > joint.velocity * (1.0 + STEP_TOLERANCE):
        text = f"`{joint.name}` is sent off at {speed:.6g} {unit}/s, {joint.velocity:.6g} {unit}/s allowed"
        return Refusal(RefusalReason.TOO_FAST, text)
    return None
