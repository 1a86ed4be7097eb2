"""The lifecycle of an adapted device."""

from __future__ import annotations

from enum import Enum


class Phase(str, Enum):
    """Where a device stands; the first three and the last are states of a managed node (REP-2002 names).

    None of them says that the device is safe: that is the business of the vendor's safety controller and of the cell.
    """

    UNCONFIGURED = "unconfigured"  # no connection
    INACTIVE = "inactive"  # connected: state is read, every command is refused
    ACTIVE = "active"  # takes commands, holds while there are none
    STOPPED = "stopped"  # held by the watchdog, a fault or the vendor's safety; a person acknowledges
    FINALIZED = "finalized"  # disconnected for good
