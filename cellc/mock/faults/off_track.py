"""What becomes of a step when a joint is not where its controller wants it."""

from __future__ import annotations

from collections.abc import Callable

from cellc.mock.bus.qos import served_actions
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import BORNE, SUCCEEDED, Ending, ends_in
from cellc.mock.faults.cell_steps import CellStep


def ending_off_track(bounds: Bounds, controller: str, *more: str) -> Callable[[CellStep], Ending]:
    """Return how steps end when a joint of ``controller`` is off its track.

    A step that leaves the joint where it is bears it. Without a goal time, as of a gripper, the controller may wait for
    ever, and the client ends the goal.

    Args:
        more: outcomes that this fault may have besides.
    """
    action = served_actions(bounds.contract)[controller]
    interface = bounds.contract.interfaces.get(action or "")
    unbounded = interface is None or interface.timeout_s is None
    patience = ("timeout",) if unbounded else ()

    def ending(step: CellStep) -> Ending:
        if controller not in step.controllers:
            return BORNE
        return ends_in("tolerance_violation", SUCCEEDED, *patience, *more, within_s=bounds.execution_s(step))

    return ending
