"""Planning groups, poses, goals and unchecked pairs of links of the contract."""

from __future__ import annotations

from cellc.cell.cell import Cell
from cellc.cell.motion import CartesianGoal, PlanningGroup
from cellc.contract.contract import ContractDisabledCollision, ContractGoal, ContractGroup, ContractPoseTarget
from cellc.feasibility import disabled_links
from cellc.formats.contract_pose import contract_pose
from cellc.graph.adapters import adapter_of_group
from cellc.graph.cell_graph import CellGraph


def groups(cell: Cell) -> dict[str, ContractGroup]:
    """Return every planning group with the controller that is active for it."""
    return {group.name: _group(cell, group) for group in cell.groups}


def poses(cell: Cell) -> dict[str, tuple[ContractPoseTarget, ...]]:
    """Return named poses; one name may place several groups."""
    names = dict.fromkeys(pose.name for pose in cell.poses)
    return {
        name: tuple(
            ContractPoseTarget(group=pose.group, positions=pose.positions) for pose in cell.poses if pose.name == name
        )
        for name in names
    }


def goals(cell: Cell) -> dict[str, ContractGoal]:
    """Return every Cartesian goal."""
    return {goal.name: _goal(goal) for goal in cell.goals}


def disabled_collisions(graph: CellGraph) -> tuple[ContractDisabledCollision, ...]:
    """Return the pairs that the SRDF lists too; none where there is no group to plan for."""
    pairs = disabled_links(graph).pairs if graph.cell.groups else ()
    return tuple(
        ContractDisabledCollision.model_validate({"first": pair.first, "second": pair.second, "reason": pair.reason})
        for pair in pairs
    )


def _group(cell: Cell, group: PlanningGroup) -> ContractGroup:
    active = (c.label for c in cell.controllers if c.label in group.controllers and c.active)
    adapted = adapter_of_group(cell, group)
    return ContractGroup(
        base_link=group.base_link,
        tip_frame=group.tip_frame,
        joints=group.joints,
        controller=next(active, None if adapted is None else adapted.device.name),
    )


def _goal(goal: CartesianGoal) -> ContractGoal:
    return ContractGoal.model_validate(
        {
            "group": goal.group,
            "frame": goal.frame,
            "pose": contract_pose(goal.transform_tip_to_frame),
            "approach": goal.approach,
            "transform_at": goal.transform_at,
        }
    )
