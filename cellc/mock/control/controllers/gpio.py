"""gpio_controllers/GpioCommandController: commands to the interfaces of gpios, by group and name."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.mock.control.block import Block
from cellc.mock.control.controllers.base import Context, Cycle, QuietController
from cellc.mock.control.parameters import Parameter
from cellc.mock.control.parameters.requirements import longer_than_zero, unique


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
