"""Controllers that publish what the hardware reports."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from cellc.contract.frozen import dataclass
from cellc.mock.control.controllers.base import ConfigureError, Context, Cycle, QuietController
from cellc.mock.control.interfaces import Array, Block, Times
from cellc.mock.control.parameters import Parameter
from cellc.mock.control.parameters.declaration import not_empty

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


_Number = TypeVar("_Number", np.float64, np.int64)

_KINDS = ("position", "velocity", "effort")


@dataclass(frozen=True, slots=True)
class JointStateBlock:
    """Joint states that were published.

    Attributes:
        stamps_ns: stamps, shape (m,).
        names: joint names in the order of the message.
        positions: rad or m, shape (m, joints), NaN where a joint has no such interface.
        velocities: rad/s or m/s, the same way.
        efforts: N m or N, the same way.
    """

    stamps_ns: Times
    names: tuple[str, ...]
    positions: Array
    velocities: Array
    efforts: Array


class JointStateBroadcaster(QuietController):
    """A joint state broadcaster.

    Args:
        context: what the manager gives.

    Raises:
        ParameterError: from the declaration of the parameters.
    """

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        context.parameters.declare(
            (
                Parameter("use_local_topics", "bool", False, (), True),
                Parameter("joints", "string_array", [], (), True),
                Parameter("extra_joints", "string_array", [], (), True),
                Parameter("interfaces", "string_array", [], (), True),
                *(Parameter(f"map_interface_to_joint_state.{kind}", "string", kind, (), True) for kind in _KINDS),
                Parameter("use_urdf_to_filter", "bool", True, (), True),
                Parameter("frame_id", "string", "base_link", (), True),
                Parameter("publish_dynamic_joint_states", "bool", True, (), True),
            )
        )
        self._listened = False
        self._names: tuple[str, ...] = ()
        self._stamps: list[Times] = []
        self._rows: list[Array] = []
        self._ended: list[JointStateBlock] = []

    def _asked_for(self) -> tuple[str, ...]:
        parameters = self.context.parameters
        joints, kinds = parameters.texts("joints"), parameters.texts("interfaces")
        return tuple(f"{joint}/{kind}" for joint in joints for kind in kinds)

    def state_interfaces(self) -> tuple[str, ...]:
        """The interfaces that are asked for; none represents all that exist."""
        return self._asked_for()

    def _kinds(self) -> dict[str, str]:
        """Interface name of each field of the message."""
        return {kind: self.context.parameters.text(f"map_interface_to_joint_state.{kind}") for kind in _KINDS}

    def activation_error(self) -> str:
        """An error where nothing is exported that could be published.

        Source: https://github.com/ros-controls/ros2_controllers/blob/5.17.0/joint_state_broadcaster/src/joint_state_broadcaster.cpp
        (`on_activate`).
        """
        if self.context.table.exported_states():
            return ""
        return (
            "No state interfaces found to publish. Error initializing joint data. JointStateBroadcaster will not run."
        )

    def joint_names(self) -> tuple[str, ...]:
        """Names in the order of the message: as listed, else alphabetical."""
        table, parameters = self.context.table, self.context.parameters
        asked = self._asked_for()
        available = asked or tuple(
            name for name in table.exported_states() if table.data_type(name) in ("double", "float32")
        )
        fields = set(self._kinds().values())
        complete = {name.rpartition("/")[0] for name in available if name.rpartition("/")[2] in fields}
        if asked:
            names = [joint for joint in parameters.texts("joints") if joint in complete]
        elif parameters.flag("use_urdf_to_filter"):
            names = sorted(complete & set(self.context.description.joints))
        else:
            names = sorted(complete)
        return (*names, *(joint for joint in parameters.texts("extra_joints") if joint not in names))

    def activate(self, now_ns: int) -> None:
        """Look up what is published; what was published of other joints before is a block of its own."""
        table, names = self.context.table, self.joint_names()
        if self._rows and names != self._names:
            self._ended.append(self._block())
        self._names = names
        wanted = [f"{name}/{kind}" for kind in self._kinds().values() for name in names]
        self._columns = np.array(
            [table.state_column(name) if table.has_state(name) else -1 for name in wanted], dtype=np.intp
        )
        extra = set(self.context.parameters.texts("extra_joints"))
        self._zero = np.array([name.rpartition("/")[0] in extra for name in wanted])
        self._missing = self._columns < 0
        self._any_missing = bool(self._missing.any())

    @property
    def is_local(self) -> bool:
        """Whether it publishes on topics below its own name, which nothing reads that was not made to."""
        return self.context.parameters.flag("use_local_topics")

    def listen(self) -> None:
        """Collect what is published from now on."""
        self._listened = True

    def take(self) -> tuple[JointStateBlock, ...]:
        """Hand over what was collected since the last time: one block, or one for each set of joints."""
        blocks, self._ended = (*self._ended, self._block()), []
        return blocks

    def _block(self) -> JointStateBlock:
        count = len(self._names)
        rows = _joined(self._rows) if self._rows else np.empty((0, 3 * count))
        stamps = _joined(self._stamps) if self._stamps else np.empty(0, dtype=np.int64)
        self._rows, self._stamps = [], []
        return JointStateBlock(stamps, self._names, rows[:, :count], rows[:, count : 2 * count], rows[:, 2 * count :])

    def _collect(self, times_ns: Times, state: Array) -> None:
        rows = state[:, self._columns]
        if self._any_missing:
            rows[:, self._missing] = np.where(self._zero[self._missing], 0.0, np.nan)
        self._stamps.append(times_ns)
        self._rows.append(rows)

    def update(self, cycle: Cycle) -> None:
        """Publish."""
        if self._listened:
            self._collect(np.array([cycle.time_ns], dtype=np.int64), self.context.table.state[None, :])

    def commit(self, block: Block, start: int) -> None:
        """Publish all cycles of the block."""
        if self._listened:
            self._collect(block.times_ns[start:].copy(), block.state[start:])


def _joined(pieces: list[NDArray[_Number]]) -> NDArray[_Number]:
    return pieces[0] if len(pieces) == 1 else np.concatenate(pieces)
