"""Speed scaling: how fast the time of a trajectory runs."""

from __future__ import annotations

import math

from cellc.mock.control.block import Block
from cellc.mock.control.controllers.base import Context
from cellc.mock.control.journal import Cause


class SpeedScaling:
    """The scaling factor, from a parameter, a topic or a state interface.

    Args:
        context: the controller's context.
        scaled: whether `speed_scaling_interface_name` names the state interface where the upstream parameter does not;
            vendors' scaled controllers have the one or the other.
    """

    def __init__(self, context: Context, scaled: bool) -> None:
        parameters = context.parameters
        self._context = context
        self._state = parameters.text("speed_scaling.state_interface")
        if scaled and not self._state:
            self._state = parameters.text("speed_scaling_interface_name")
        self._command = parameters.text("speed_scaling.command_interface")
        self._column: int | None = None
        self.factor = parameters.number("speed_scaling.initial_scaling_factor")

    def state_names(self) -> tuple[str, ...]:
        """The state interface, if one is used."""
        return (self._state,) if self._state else ()

    def command_names(self) -> tuple[str, ...]:
        """The command interface, if one is used."""
        return (self._command,) if self._command else ()

    def bind(self) -> None:
        """Look up the state interface and read it."""
        self._column = self._context.table.state_column(self._state) if self._state else None
        self.read()

    def read(self) -> float:
        """The factor for this update; a value that is not known keeps the last one."""
        if self._column is not None:
            value = float(self._context.table.state[self._column])
            if not math.isnan(value):
                self._take(value)
        return self.factor

    def set(self, factor: float) -> None:
        """Take a factor of the topic `~/speed_scaling_input`; a negative one is ignored."""
        if factor < 0.0:
            return
        self._context.log.info(f"{self._context.name}.speed_scaling", f"New scaling factor will be {factor:f}")
        if self._command:
            self._context.command(self._context.table.command_column(self._command), factor)
        if self._column is None:
            self._take(factor, since_ns=1)  # it counts for the first update after this instant

    def _take(self, factor: float, since_ns: int = 0) -> None:
        if factor != self.factor:
            stamp_ns = self._context.log.now_ns + since_ns
            self._context.table.journal.note(stamp_ns, self._context.name, Cause.SCALING)
        self.factor = factor

    def unchanged(self, block: Block) -> int:
        """How many leading cycles of a block run with the present factor."""
        if self._column is None:
            return len(block)
        values = block.state[:, self._column]
        changed = (values != self.factor) & (values == values)
        index = int(changed.argmax())
        return index if changed[index] else len(block)
