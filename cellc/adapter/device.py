"""What a device that is driven by its vendor's library offers the rest of the cell."""

from __future__ import annotations

from typing import Protocol

from cellc.adapter.messages import DeviceState, JointCommand, Refusal
from cellc.adapter.model import AdapterModel


class DeviceAdapter(Protocol):
    """One device behind its library; vendor structs stay on the far side.

    Calls return at once and never wait for motion. One client commands at a time: whoever serves the device's action.
    An implementation passes `cellc.adapter.conformance`.
    """

    @property
    def model(self) -> AdapterModel:
        """Joints, units, bounds, rates and watchdog; the same before and after connecting."""
        ...

    def now_ns(self) -> int:
        """Return the present time on the clock of the model, which stamps states and is asked of commands."""
        ...

    def connect(self) -> None:
        """Open the connection and read: unconfigured to inactive. Nothing may move, and no old command returns.

        Raises:
            ConnectionError: the device does not answer or is not the one of the model.
        """
        ...

    def activate(self) -> None:
        """Take commands from now on: inactive to active. The device holds where it stands until the first one.

        Raises:
            RuntimeError: the device is not inactive: a stop has to be acknowledged first.
        """
        ...

    def deactivate(self) -> None:
        """Hold, and refuse commands from now on: active to inactive."""
        ...

    def acknowledge(self) -> None:
        """Leave a stop after a person has looked: stopped to inactive, if the vendor's safety allows.

        Raises:
            RuntimeError: the device is not stopped, or still has reason to be.
        """
        ...

    def disconnect(self) -> None:
        """Hold and close the connection for good: finalized."""
        ...

    def read(self) -> DeviceState:
        """Return the newest state, measured at its stamp; in every phase but unconfigured.

        Raises:
            ConnectionError: there is no connection.
        """
        ...

    def command(self, command: JointCommand) -> Refusal | None:
        """Go towards a command, or refuse it whole; the first one opens a stream that the watchdog guards.

        A stream that is silent for longer than `command_timeout_s` ends in a stop.
        """
        ...

    def hold(self) -> None:
        """End the stream: come to a standstill within `stop_time_s` and stay; the phase remains."""
        ...
