"""What ends when a robot no longer follows set points: its claims, the goals on them, and what asks for motion.

What says so is what its vendor tells of a claim: whatever would keep old set points where it does not hold, and send
them once it does again.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller, ControllerManager
from cellc.compiler.cell.device import Device
from cellc.compiler.deploy.processes import motion_clients
from cellc.compiler.deploy.readiness import components_of, is_claiming
from cellc.contract.bring_up import CLAIM_WATCH, WATCH_WITHIN_S, TopicProof, Watch
from cellc.contract.vocabulary import Behavior, InterfaceKind, Need


def heard(cell: Cell, device: Device) -> Mapping[Need, TopicProof]:
    """Return what a claim of a device needs, with what says in this cell that it has it; the rest is unheard."""
    telling = cell.controllers_of.get(device.name, {})
    reports = {} if device.control.hardware is None else device.control.hardware.heard_before_a_claim
    return {
        need: TopicProof(
            kind="topic",
            topic=f"{telling[report.controller_kind]}/{report.topic}",
            type=report.type,
            field=report.field,
            values=report.values,
            above=report.above,
        )
        for need, report in reports.items()
        if report.controller_kind in telling
    }


def watches(cell: Cell) -> Iterator[Watch]:
    """Yield what ends when a device follows no set points: of both targets, as only what is active loses a claim."""
    for manager in cell.managers:
        for device in components_of(cell, manager, "real"):
            if proofs := heard(cell, device):
                claiming = tuple(_claiming(cell, manager, device))
                yield Watch(
                    device=device.name,
                    host=manager.host,
                    manager=manager.node,
                    controllers=tuple(owner.name for owner in claiming),
                    actions=tuple(_canceled(cell, claiming)),
                    nodes=tuple(node.full_name for node in motion_clients(cell) if node.lifecycle),
                    while_hold=dict(proofs),
                    acknowledge=f"{CLAIM_WATCH}/acknowledge_{device.name}",
                    within_s=WATCH_WITHIN_S,
                )


def _claiming(cell: Cell, manager: ControllerManager, device: Device) -> Iterator[Controller]:
    own = {joint.name for joint in device.joints}
    for owner in manager.controllers:
        moved_past = owner.behavior is Behavior.OWN_MOTION and owner.device == device.name
        if is_claiming(cell, owner, ()) and (own & set(owner.joints) or moved_past):
            yield owner


def _canceled(cell: Cell, claiming: Sequence[Controller]) -> Iterator[str]:
    """Yield the actions of controllers, and of the planners that send goals to them."""
    serving = {owner.full_name for owner in claiming} | {planner.full_name for planner in cell.planners}
    for interface in cell.interfaces:
        served = any(end.full_name in serving for end in interface.sources)
        if interface.kind is InterfaceKind.ACTION and "real" in interface.targets and served:
            yield interface.name
