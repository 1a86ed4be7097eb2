"""Parameters of the joint trajectory controller."""

from __future__ import annotations

from collections.abc import Sequence

from cellc.contract.vocabulary import Distro, Feature, features
from cellc.mock.control.parameters import Parameter, ParameterSet, ParameterValue
from cellc.mock.control.parameters.declaration import at_least, longer_than_zero, one_of, subset_of, unique

_COMMANDS = (
    ("position",),
    ("position", "velocity"),
    ("position", "velocity", "acceleration"),
    ("velocity",),
    ("effort",),
    ("position", "effort"),
)


def _as_set(value: ParameterValue) -> frozenset[str]:
    return frozenset(str(item) for item in value) if isinstance(value, list) else frozenset()


def _command_combination(_name: str, value: ParameterValue) -> str:
    kinds = _as_set(value)
    if any(kinds == frozenset(allowed) for allowed in _COMMANDS):
        return ""
    if "velocity" in kinds and "effort" in kinds:
        return "'velocity' and 'effort' command interfaces can not be used together"
    if "acceleration" in kinds:
        return (
            "'acceleration' command interface can only be used if 'velocity' and 'position' command interfaces are "
            "present"
        )
    return "'effort' command interface has to be used alone or with a 'position' interface"


def _state_combination(_name: str, value: ParameterValue) -> str:
    kinds = _as_set(value)
    if "velocity" in kinds and "position" not in kinds:
        return "'velocity' state interface cannot be used if 'position' interface is missing."
    if "acceleration" in kinds and not {"position", "velocity"} <= kinds:
        return "'acceleration' state interface cannot be used if 'position' and 'velocity' interfaces are not present."
    return ""


def parameters(distro: Distro, scaled: bool) -> tuple[Parameter, ...]:
    """The parameters that do not depend on joints, in the order in which upstream checks them."""
    nonzero_end = Feature.TRAJECTORIES_END_AT_REST not in features(distro)
    declared = (
        Parameter("joints", "string_array", [], (unique, longer_than_zero), True),
        Parameter("command_joints", "string_array", [], (unique,), True),
        Parameter(
            "command_interfaces",
            "string_array",
            [],
            (unique, longer_than_zero, subset_of(*_COMMANDS[2], "effort"), _command_combination),
            True,
        ),
        Parameter(
            "state_interfaces",
            "string_array",
            [],
            (unique, longer_than_zero, subset_of("position", "velocity", "acceleration"), _state_combination),
            True,
        ),
        Parameter("speed_scaling.initial_scaling_factor", "double", 1.0, (at_least(0.0),), True),
        Parameter("speed_scaling.state_interface", "string", "", (), True),
        Parameter("speed_scaling.command_interface", "string", "", (), True),
        Parameter("allow_partial_joints_goal", "bool", False),
        Parameter("interpolate_from_desired_state", "bool", False, (), True),
        Parameter("allow_integration_in_goal_trajectories", "bool", False),
        Parameter("set_last_command_interface_value_as_state_on_activation", "bool", True),
        Parameter("action_monitor_rate", "double", 20.0, (at_least(0.1),), True),
        Parameter("interpolation_method", "string", "splines", (one_of("splines", "none"),), True),
        Parameter("allow_nonzero_velocity_at_trajectory_end", "bool", nonzero_end),
        Parameter("cmd_timeout", "double", 0.0),
        Parameter("constraints.stopped_velocity_tolerance", "double", 0.01),
        Parameter("constraints.goal_time", "double", 0.0, (at_least(0.0),)),
        Parameter("constraints.decelerate_on_cancel", "bool", False, (), True),
    )
    if not scaled:
        return declared
    name = Parameter("speed_scaling_interface_name", "string", "speed_scaling/speed_scaling_factor", (), True)
    return (*declared, name)


def joint_parameters(joints: Sequence[str]) -> tuple[Parameter, ...]:
    """The parameters of each joint."""
    parameters: list[Parameter] = []
    for joint in joints:
        gains, constraints = f"gains.{joint}.", f"constraints.{joint}."
        parameters.extend(Parameter(gains + key, "double", 0.0) for key in ("p", "i", "d", "ff_velocity_scale"))
        infinity = float("inf")
        parameters.extend(Parameter(gains + key, "double", infinity) for key in ("u_clamp_max", "i_clamp_max"))
        parameters.extend(Parameter(gains + key, "double", -infinity) for key in ("u_clamp_min", "i_clamp_min"))
        parameters.extend(Parameter(constraints + key, "double", 0.0) for key in ("trajectory", "goal"))
        parameters.append(Parameter(constraints + "max_deceleration_on_cancel", "double", 0.0, (at_least(0.0),), True))
    return tuple(parameters)


def declare(parameter_set: ParameterSet, distro: Distro, scaled: bool) -> None:
    """Declare all parameters. Raises ParameterError."""
    parameter_set.declare(parameters(distro, scaled))
    parameter_set.declare(joint_parameters(parameter_set.texts("joints")))
