"""Planning pipelines: sampling-based by default, point-to-point and straight lines by request."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.cell.cell import Cell
from cellc.cell.interface import ParameterValue

Parameters = Mapping[str, ParameterValue]

_SAMPLING = "ompl"
_INDUSTRIAL = "pilz_industrial_motion_planner"
_PLANNER = "RRTConnectkConfigDefault"
_PLUGINS = {_SAMPLING: "ompl_interface/OMPLPlanner", _INDUSTRIAL: f"{_INDUSTRIAL}/CommandPlanner"}
_REQUEST = "default_planning_request_adapters"
_RESPONSE = "default_planning_response_adapters"
_REQUEST_ADAPTERS = (
    "ResolveConstraintFrames",
    "ValidateWorkspaceBounds",
    "CheckStartStateBounds",
    "CheckStartStateCollision",
)
# The industrial planner parameterizes time itself.
_RESPONSE_ADAPTERS = {
    _SAMPLING: ("AddTimeOptimalParameterization", "ValidateSolution", "DisplayMotionPath"),
    _INDUSTRIAL: ("ValidateSolution", "DisplayMotionPath"),
}
# Humble: one text of adapters before and after planning, the outermost first.
_HUMBLE = "default_planner_request_adapters"
_HUMBLE_ADAPTERS = {
    _SAMPLING: (
        "AddTimeOptimalParameterization",
        "ResolveConstraintFrames",
        "FixWorkspaceBounds",
        "FixStartStateBounds",
        "FixStartStateCollision",
        "FixStartStatePathConstraints",
    ),
    _INDUSTRIAL: (),
}


def planning_pipelines(cell: Cell) -> Parameters:
    """Return both pipelines with their plugins, adapters and planners."""
    return {
        "planning_pipelines": (_SAMPLING, _INDUSTRIAL),
        "default_planning_pipeline": _SAMPLING,
        "capabilities": f"{_INDUSTRIAL}/MoveGroupSequenceAction {_INDUSTRIAL}/MoveGroupSequenceService",
        **_pipeline(cell, _SAMPLING),
        f"{_SAMPLING}.planner_configs.{_PLANNER}.type": "geometric::RRTConnect",
        **_groups(cell),
        **_pipeline(cell, _INDUSTRIAL),
        f"{_INDUSTRIAL}.default_planner_config": "PTP",
    }


def _pipeline(cell: Cell, name: str) -> Parameters:
    if cell.distro == "humble":
        adapters = " ".join(f"{_HUMBLE}/{adapter}" for adapter in _HUMBLE_ADAPTERS[name])
        # Zero: a start state outside its bounds is refused, never moved inside them.
        bounds: Parameters = {f"{name}.request_adapters": adapters, f"{name}.start_state_max_bounds_error": 0.0}
        return {f"{name}.planning_plugin": _PLUGINS[name], **(bounds if adapters else {f"{name}.request_adapters": ""})}
    return {
        f"{name}.planning_plugins": (_PLUGINS[name],),
        f"{name}.request_adapters": tuple(f"{_REQUEST}/{adapter}" for adapter in _REQUEST_ADAPTERS),
        f"{name}.response_adapters": tuple(f"{_RESPONSE}/{adapter}" for adapter in _RESPONSE_ADAPTERS[name]),
    }


def _groups(cell: Cell) -> Parameters:
    parameters: dict[str, ParameterValue] = {}
    for group in cell.groups:
        prefix = f"{_SAMPLING}.{group.name}"
        parameters |= {
            f"{prefix}.default_planner_config": _PLANNER,
            f"{prefix}.planner_configs": (_PLANNER,),
            f"{prefix}.longest_valid_segment_fraction": 0.005,
        }
        if len(group.joints) > 1:
            parameters[f"{prefix}.projection_evaluator"] = f"joints({','.join(group.joints[:2])})"
    return parameters
