"""Whose a parameter is: that of a controller, of MoveIt, of the driver of a device, or of another node."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.contract.contract import Contract
from cellc.contract.vocabulary import ReviewArea
from cellc.tools.review.facts import Facts
from cellc.tools.review.leaves import Path

_PARAMETERS, _NODE = ("parameter", "parameters of a node"), 2
_MOVEIT, _MANAGER = "moveit_msgs/", "controller_manager"


def area_of_parameter(quantity: str, path: Path, sides: tuple[Facts, Facts]) -> ReviewArea | None:
    """Return the area of a parameter of a node that runs no controller; None of a controller and of anything else."""
    if quantity not in _PARAMETERS or path[0] != "parameters":
        return None
    name, contracts = path[_NODE], [side.contract for side in sides]
    if any(name in _commanding(contract) for contract in contracts):
        return None
    if any(name in _planning(contract) for contract in contracts):
        return ReviewArea.MOTION
    devices = {device for contract in contracts for device in contract.devices}
    is_driver = any(f"{name}_".startswith(f"{device}_") for device in devices)
    return ReviewArea.DEVICES if is_driver else ReviewArea.INTERFACES


def _commanding(contract: Contract) -> Iterator[str]:
    """Yield what runs controllers or commands joints by itself."""
    yield from (_MANAGER, *contract.managers, *contract.adapters)
    yield from (name for manager in contract.managers.values() for name in manager.controllers)


def _planning(contract: Contract) -> Iterator[str]:
    """Yield the nodes that answer requests to MoveIt."""
    for interface in contract.interfaces.values():
        if interface.kind != "topic" and interface.type.startswith(_MOVEIT):
            yield from (end.node for end in interface.sources)
