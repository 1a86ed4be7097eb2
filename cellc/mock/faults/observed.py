"""What becomes of a step when the observations of some frames stay away."""

from __future__ import annotations

from collections.abc import Callable

from cellc.contract.contract import Contract
from cellc.mock.faults.bounds import Bounds
from cellc.mock.faults.case import BORNE, SUCCEEDED, Ending, ends_in
from cellc.mock.faults.cell_steps import CellStep


def cameras(contract: Contract) -> dict[str, tuple[str, ...]]:
    """Return the dynamic frames that are seen in the images of each camera."""
    found: dict[str, tuple[str, ...]] = {}
    for name, device in contract.devices.items():
        if device.camera is not None and device.camera.topic in contract.interfaces:
            nodes = {sink.node for sink in contract.interfaces[device.camera.topic].sinks}
            frames = (frame for frame, facts in contract.frames.items() if facts.kind == "dynamic")
            found[name] = tuple(frame for frame in frames if contract.frames[frame].authority in nodes)
    return found


def ending_unobserved(bounds: Bounds, frames: tuple[str, ...]) -> Callable[[CellStep], Ending]:
    """Return how steps end while nothing new is seen of ``frames``.

    A step that does not look itself is concerned as long as the cell stands where an observation has led it.
    """

    def ending(step: CellStep) -> Ending:
        if not frames:
            return BORNE
        within_s = max(map(bounds.observation_s, frames))
        if step.observes in frames:
            return ends_in("stale_state", within_s=within_s)
        return ends_in("stale_state", SUCCEEDED, within_s=within_s)

    return ending
