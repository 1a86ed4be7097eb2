"""The joint state broadcaster: names and values of /joint_states, also for whole blocks of cycles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from cellc.mock.control.block import Block
from cellc.mock.control.controllers.base import Context, Cycle, QuietController
from cellc.mock.control.interfaces import Array, Times
from cellc.mock.control.parameters import Parameter

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

    def _asked_for(self) -> tuple[str, ...]:
        parameters = self.context.parameters
        joints, kinds = parameters.texts("joints"), parameters.texts("interfaces")
        return tuple(f"{joint}/{kind}" for joint in joints for kind in kinds)

    def state_interfaces(self) -> tuple[str, ...]:
        """The interfaces that are asked for; none stands for all that exist."""
        return self._asked_for()

    def _kinds(self) -> dict[str, str]:
        """Interface name of each field of the message."""
        return {kind: self.context.parameters.text(f"map_interface_to_joint_state.{kind}") for kind in _KINDS}

    def activation_refusal(self) -> str:
        """Activation fails without any state interface."""
        if self.context.table.state_names():
            return ""
        return "None of requested interfaces exist. Controller will not run."

    def joint_names(self) -> tuple[str, ...]:
        """Names in the order of the message: as listed, else alphabetical."""
        table, parameters = self.context.table, self.context.parameters
        asked = self._asked_for()
        available = asked or tuple(
            name for name in table.state_names() if table.data_type(name) in ("double", "float32")
        )
        fields = set(self._kinds().values())
        found = {name.rpartition("/")[0] for name in available if name.rpartition("/")[2] in fields}
        if asked:
            names = [joint for joint in parameters.texts("joints") if joint in found]
        elif parameters.flag("use_urdf_to_filter"):
            names = sorted(found & set(self.context.description.joints))
        else:
            names = sorted(found)
        return (*names, *(joint for joint in parameters.texts("extra_joints") if joint not in names))

    def activate(self, now_ns: int) -> None:
        """Look up what is published."""
        table, names = self.context.table, self.joint_names()
        self._names = names
        wanted = [f"{name}/{kind}" for kind in self._kinds().values() for name in names]
        self._columns = np.array(
            [table.state_column(name) if table.has_state(name) else -1 for name in wanted], dtype=np.intp
        )
        extra = set(self.context.parameters.texts("extra_joints"))
        self._zero = np.array([name.rpartition("/")[0] in extra for name in wanted])
        self._missing = self._columns < 0
        self._any_missing = bool(self._missing.any())

    def listen(self) -> None:
        """Collect what is published from now on."""
        self._listened = True

    def take(self) -> JointStateBlock:
        """Hand over what was collected since the last time."""
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
