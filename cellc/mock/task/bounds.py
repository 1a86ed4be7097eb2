"""The bounds that the task takes from the contract, and those it has of its own where nothing is stated."""

from __future__ import annotations

from cellc.contract.contract import Contract
from cellc.contract.entities import ContractInterface
from cellc.mock.bus.qos import served_actions
from cellc.mock.world.joint_states import JOINT_STATE_TYPE

DEFAULT_CANCEL_S = 0.5
"""Where the contract bounds neither the cancel of an action nor that of the cell."""
DEFAULT_GRIP_S = 10.0
"""Where the action of a gripper states no timeout."""
DEFAULT_JOINT_STATE_AGE_S = 0.1
"""Where no interface states how old a joint state may be."""


def cancel_bound_s(contract: Contract) -> float:
    """Return the tightest bound that the contract sets for a cancel."""
    bounds = [contract.kpis.cancel_s, *(each.cancel_within_s for each in contract.interfaces.values())]
    stated = [bound for bound in bounds if bound is not None]
    return min(stated) if stated else DEFAULT_CANCEL_S


def joint_state_age_s(contract: Contract) -> float:
    """Return how old a joint state may be."""
    stated = [
        interface.max_age_s
        for interface in contract.interfaces.values()
        if interface.type == JOINT_STATE_TYPE and interface.max_age_s is not None
    ]
    return min(stated) if stated else DEFAULT_JOINT_STATE_AGE_S


def action_timeout_s(contract: Contract) -> float | None:
    """Return the bound of the action that plans and executes for the task; a controller's own bound is another one."""
    stated = [interface.timeout_s for interface in planning_actions(contract).values()]
    return max((timeout_s for timeout_s in stated if timeout_s is not None), default=None)


def goal_timeout_s(contract: Contract, controller: str) -> float | None:
    """Return the bound of a whole goal: of the action that plans and executes, else of the one that takes the goal."""
    planned_s = action_timeout_s(contract)
    return _own_timeout_s(contract, controller) if planned_s is None else planned_s


def grip_timeout_s(contract: Contract, controller: str) -> float:
    """Return the bound of one opening or closing: that of the gripper's own action, which is not planned."""
    stated_s = _own_timeout_s(contract, controller)
    return DEFAULT_GRIP_S if stated_s is None else stated_s


def _own_timeout_s(contract: Contract, controller: str) -> float | None:
    interface = contract.interfaces.get(served_actions(contract).get(controller) or "")
    return None if interface is None else interface.timeout_s


def planning_server(contract: Contract) -> str:
    """Return the node that plans for the task; empty where the task plans itself."""
    actions = [interface for interface in planning_actions(contract).values() if interface.sinks]
    servers = [source.node for interface in actions for source in interface.sources]
    return servers[0] if servers else ""


def planning_actions(contract: Contract) -> dict[str, ContractInterface]:
    """Return the actions by which the task has a motion planned and executed, in the order of their names.

    The actions of controllers and adapters are left out, and those of their types, which stand in for one elsewhere.
    """
    served = [name for name in served_actions(contract).values() if name in contract.interfaces]
    types = {contract.interfaces[name].type for name in served if name is not None}
    interfaces = sorted(contract.interfaces.items())
    return {name: each for name, each in interfaces if each.kind == "action" and each.type not in types}
