"""Claim: activate what commands, and look whether each command interface has exactly the owner that it should."""

from __future__ import annotations

from cellc.contract.contract import ContractManager
from cellc.mock.bringup.activation import activate
from cellc.mock.control import ControllerManager
from cellc.mock.engine.process import Waiting
from cellc.mock.plant import Plant
from cellc.mock.result import StageEvidence


def claim(plant: Plant) -> Waiting[StageEvidence]:
    """Activate the commanding controllers and adapters, and compare the claims of controllers with the contract."""
    facts: list[str] = []
    problems: list[str] = []
    for name, entry in plant.contract.managers.items():
        commanding = tuple(
            controller
            for controller, facts_of in entry.controllers.items()
            if facts_of.active and facts_of.command_interfaces and "mock" in facts_of.targets
        )
        problems += yield from activate(plant, name, commanding)
        claims = _claims(plant.control.managers[name])
        facts += [f"`{interface}` is claimed by `{owner}`" for interface, owner in sorted(claims.items())]
        if not problems:
            problems += _differences(entry, claims)
    for device, server in plant.control.adapters.items() if not problems else ():
        server.adapter.activate()
        client = plant.contract.adapters[device].client
        facts.append(f"the adapter of `{device}` is {server.adapter.phase.value}, for `{client or 'nobody'}` alone")
    return StageEvidence("claim", tuple(facts), tuple(problems))


def _claims(manager: ControllerManager) -> dict[str, str]:
    return {
        interface: controller.name
        for controller in manager.list_controllers()
        for interface in controller.claimed_interfaces
    }


def _differences(entry: ContractManager, claims: dict[str, str]) -> list[str]:
    expected = {
        interface: name
        for name, controller in entry.controllers.items()
        if controller.active and "mock" in controller.targets
        for interface in controller.command_interfaces
    }
    return [
        f"`{interface}` is claimed by `{claims.get(interface, 'nobody')}`, "
        f"the contract says `{expected.get(interface, 'nobody')}`"
        for interface in sorted({*expected, *claims})
        if claims.get(interface) != expected.get(interface)
    ]
