"""Where the commands of a trajectory controller do not go on smoothly, for who judges them against limits."""

from __future__ import annotations

import numpy as np

from cellc.mock.control.controllers.joint_trajectory.motion import Motion, PendingTrajectory
from cellc.mock.control.interfaces import Array
from cellc.mock.control.journal import Cause

_SAME = 1e-9
"""rad or m: a measured position nearer than this to the command is the commanded one."""


def cause_of(pending: PendingTrajectory, motion: Motion | None, measured: Array, commanded: Array) -> Cause | None:
    """Tell why the command may step as a trajectory is taken over; None where it must go on smoothly.

    Args:
        pending: what is taken over.
        motion: what it follows.
        measured: measured positions, which it starts from.
        commanded: present commands of the first kind of interface.
    """
    if pending.interrupts:
        return Cause.HOLD if len(pending.points) == 1 else Cause.DECELERATION
    if pending.held:
        return None
    if motion is not None and not motion.held:
        return Cause.REPLACED
    steps = np.abs(measured[: len(commanded)] - commanded)
    return None if bool((steps <= _SAME).all()) else Cause.OFF_COMMAND
