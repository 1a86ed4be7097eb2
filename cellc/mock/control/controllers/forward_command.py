"""Controllers that pass commands on: of joints (forward_command_controller and its relatives) and of gpio groups."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from cellc.mock.control.controllers.base import Context, Cycle, QuietController, claimed_names
from cellc.mock.control.errors import UpdateError
from cellc.mock.control.interfaces import Block
from cellc.mock.control.parameters import Parameter
from cellc.mock.control.parameters.declaration import longer_than_zero, not_empty, unique


class ForwardCommandController(QuietController):
    """A forward command controller: one kind of interface of several joints.

    Args:
        context: what the manager gives.

    Raises:
        ParameterError: from the declaration of the parameters.
    """

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        context.parameters.declare(self._declared())
        self._data: tuple[float, ...] | None = None
        self.active = False

    def _declared(self) -> tuple[Parameter, ...]:
        return (
            Parameter("joints", "string_array", None, (not_empty,), True),
            Parameter("interface_name", "string", None, (not_empty,), True),
        )

    def command_interfaces(self) -> tuple[str, ...]:
        """The commanded interfaces, in the order of the values."""
        parameters = self.context.parameters
        return claimed_names(parameters.texts("joints"), (parameters.text("interface_name"),))

    def activate(self, now_ns: int) -> None:
        """Command nothing before the first message."""
        self._columns = self.context.table.command_columns(self.command_interfaces())
        self._data = None
        self.active = True
        self.context.log.info(self.context.name, "activate successful")

    def deactivate(self, now_ns: int) -> None:
        """Forget the last message."""
        self._data = None
        self.active = False

    def receive(self, data: Sequence[float]) -> None:
        """Take a message of `~/commands`; one with a value that is not finite is dropped."""
        if not self.active:
            return
        if not all(math.isfinite(value) for value in data):
            self.context.log.warn(self.context.name, "Non-finite value received. Dropping message")
            return
        self._data = tuple(data)

    def update(self, cycle: Cycle) -> None:
        """Command the last message."""
        if self._data is None:
            return
        if len(self._data) != len(self._columns):
            text = f"command size ({len(self._data)}) does not match number of interfaces ({len(self._columns)})"
            self.context.log.error(self.context.name, text)
            raise UpdateError("")
        for column, value in zip(self._columns.tolist(), self._data, strict=True):
            self.context.command(column, value)

    def preview(self, block: Block) -> int:
        """Command the last message in every cycle."""
        if self._data is None:
            return len(block)
        if len(self._data) != len(self._columns):
            return 0
        block.command[:, self._columns] = self._data
        return len(block)


class MultiInterfaceForwardCommandController(ForwardCommandController):
    """A forward command controller: several interfaces of one joint or gpio."""

    def _declared(self) -> tuple[Parameter, ...]:
        return (
            Parameter("joint", "string", None, (not_empty,), True),
            Parameter("interface_names", "string_array", None, (not_empty,), True),
        )

    def command_interfaces(self) -> tuple[str, ...]:
        """The commanded interfaces, in the order of the values."""
        parameters = self.context.parameters
        return claimed_names((parameters.text("joint"),), parameters.texts("interface_names"))


class GpioCommandController(QuietController):
    """A gpio command controller.

    Args:
        context: what the manager gives.

    Raises:
        ParameterError: from the declaration of the parameters.
    """

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        parameters = context.parameters
        parameters.declare((Parameter("gpios", "string_array", None, (longer_than_zero, unique), True),))
        for gpio in parameters.texts("gpios"):
            parameters.declare(
                Parameter(f"{kind}_interfaces.{gpio}.interfaces", "string_array", [], (unique,), True)
                for kind in ("command", "state")
            )
        self._values: dict[int, float] = {}

    def _names(self, kind: str) -> tuple[str, ...]:
        parameters = self.context.parameters
        return tuple(
            f"{gpio}/{name}"
            for gpio in parameters.texts("gpios")
            for name in parameters.texts(f"{kind}_interfaces.{gpio}.interfaces")
        )

    def command_interfaces(self) -> tuple[str, ...]:
        """The commanded interfaces of all gpios."""
        return self._names("command")

    def state_interfaces(self) -> tuple[str, ...]:
        """The read interfaces of all gpios."""
        return self._names("state")

    def activate(self, now_ns: int) -> None:
        """Command nothing before the first message."""
        self._values = {}

    def receive(self, values: Mapping[str, float]) -> None:
        """Take a message of `~/commands`: values by full interface name; unknown names are skipped."""
        for name, value in values.items():
            if name in self.command_interfaces():
                self._values[self.context.table.command_column(name)] = value
            else:
                self.context.log.error(self.context.name, f"Interface '{name}' is not commanded by this controller.")

    def update(self, cycle: Cycle) -> None:
        """Command the last values."""
        for column, value in self._values.items():
            self.context.command(column, value)

    def preview(self, block: Block) -> int:
        """Command the last values in every cycle."""
        for column, value in self._values.items():
            block.command[:, column] = value
        return len(block)
