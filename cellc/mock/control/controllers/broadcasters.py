"""Broadcasters that only read: force torque sensor, and those of which nothing but their presence matters."""

from __future__ import annotations

from cellc.mock.control.controllers.base import ConfigureError, Context, QuietController
from cellc.mock.control.parameters import Parameter
from cellc.mock.control.parameters.requirements import not_empty

_AXES = tuple(f"{kind}.{axis}" for kind in ("force", "torque") for axis in ("x", "y", "z"))


class ForceTorqueBroadcaster(QuietController):
    """force_torque_sensor_broadcaster: publishes a wrench of one sensor.

    Args:
        context: what the manager gives.

    Raises:
        ParameterError: from the declaration of the parameters.
    """

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        context.parameters.declare(
            (
                Parameter("frame_id", "string", "", (not_empty,)),
                Parameter("sensor_name", "string", ""),
                *(Parameter(f"interface_names.{axis}", "string", "") for axis in _AXES),
                *(Parameter(f"offset.{axis}", "double", 0.0) for axis in _AXES),
                *(Parameter(f"multiplier.{axis}", "double", 1.0) for axis in _AXES),
            )
        )

    def _named(self) -> dict[str, str]:
        names = {axis: self.context.parameters.text(f"interface_names.{axis}") for axis in _AXES}
        return {axis: name for axis, name in names.items() if name}

    def configure(self) -> None:
        """Exactly one way to name the sensor must be used."""
        sensor, named = self.context.parameters.text("sensor_name"), self._named()
        if sensor and named:
            raise ConfigureError(
                "both 'sensor_name' and any of 'interface_names.force.[x|y|z]' or 'interface_names.torque.[x|y|z]' "
                "parameters cannot be set."
            )
        if not sensor and not named:
            raise ConfigureError(
                "'sensor_name' or at least one 'interface_names.[force|torque].[x|y|z]' parameter has to be specified."
            )

    def state_interfaces(self) -> tuple[str, ...]:
        """The six axes of the sensor, or those that are named."""
        sensor = self.context.parameters.text("sensor_name")
        return tuple(f"{sensor}/{axis}" for axis in _AXES) if sensor else tuple(self._named().values())

    def wrench(self) -> tuple[float, ...]:
        """Force x y z in N and torque x y z in N m, NaN for an axis that is not named."""
        parameters, table = self.context.parameters, self.context.table
        sensor, named = parameters.text("sensor_name"), self._named()
        names = {axis: f"{sensor}/{axis}" for axis in _AXES} if sensor else named
        return tuple(
            (float(table.state[table.state_column(names[axis])]) + parameters.number(f"offset.{axis}"))
            * parameters.number(f"multiplier.{axis}")
            if axis in names
            else float("nan")
            for axis in _AXES
        )


class PassiveBroadcaster(QuietController):
    """A broadcaster that claims nothing and whose messages come from elsewhere.

    Args:
        context: what the manager gives.
    """


class DeclaredController(QuietController):
    """A vendor's broadcaster or server: it takes what the cell declares of it, and commands nothing by itself.

    Args:
        context: what the manager gives.
    """

    def command_interfaces(self) -> tuple[str, ...]:
        """What it claims for its services."""
        return self.context.declared.command

    def state_interfaces(self) -> tuple[str, ...]:
        """What its messages are made of."""
        return self.context.declared.state
