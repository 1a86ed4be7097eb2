"""The steps that a rehearsal of a cell can take, and what each of them rests on."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.contract.contract import Contract


@dataclass(frozen=True, slots=True)
class CellStep:
    """A step as it may stand in a rehearsal.

    Attributes:
        kind, target: as in rehearsals.json.
        controllers: those that get a goal in this step.
        observes: dynamic frame whose observation the step needs or rests on.
        frames: frames whose transforms it looks up.
    """

    kind: str
    target: str
    controllers: tuple[str, ...] = ()
    observes: str | None = None
    frames: tuple[str, ...] = ()


def cell_steps(contract: Contract) -> Iterator[CellStep]:
    """Yield every step that a rehearsal of the cell can take."""
    for name, poses in contract.poses.items():
        controllers = [contract.groups[pose.group].controller for pose in poses]
        yield CellStep("move", name, tuple(name for name in controllers if name is not None))
    for name, goal in contract.goals.items():
        controller = contract.groups[goal.group].controller
        yield CellStep(
            "move",
            name,
            () if controller is None else (controller,),
            _observed(contract, goal.frame),
            (*ancestors(contract, goal.frame), *ancestors(contract, contract.groups[goal.group].base_link)),
        )
    for name, frame in contract.frames.items():
        if frame.kind == "dynamic":
            yield CellStep("detect", name, observes=name)
    for name, device in contract.devices.items():
        if device.gripper is not None:
            yield CellStep("grip", name, () if device.gripper.controller is None else (device.gripper.controller,))
    yield CellStep("wait", "")


def ancestors(contract: Contract, frame: str) -> tuple[str, ...]:
    """Return a frame and all frames that it hangs from, up to the root."""
    chain: list[str] = []
    while frame in contract.frames and frame not in chain:
        chain.append(frame)
        frame = contract.frames[frame].parent
    return tuple(chain)


def _observed(contract: Contract, frame: str) -> str | None:
    dynamic = [name for name in ancestors(contract, frame) if contract.frames[name].kind == "dynamic"]
    return dynamic[0] if dynamic else None
