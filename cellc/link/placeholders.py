"""Fills the placeholders of catalogue texts: ``{device}``, ``{prefix}``, ``{stem}``, ``{address}`` and the like."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from cellc.spec.cell_spec import CellSpec
from cellc.spec.devices import DeviceSpec

_PLACEHOLDER = re.compile(r"\{(\w+)\}")  # `{share:PACKAGE}` stays: only an installed workspace knows the folder
UNKNOWN = "UNKNOWN"


@dataclass(frozen=True, slots=True)
class Placeholders:
    """The values for one device of the cell."""

    values: Mapping[str, str]

    def fill(self, text: str) -> str:
        """Return the text with every known placeholder replaced; others stay as they are."""
        return _PLACEHOLDER.sub(lambda match: self.values.get(match[1], match[0]), text)


def placeholders(name: str, prefix: str, written: DeviceSpec, spec: CellSpec) -> Placeholders:
    """Collect the values for a device; what the connection does not state is UNKNOWN, never guessed."""
    connection = written.connection
    host_address = UNKNOWN
    if connection is not None and connection.nic is not None and connection.host in spec.hosts:
        nic = spec.hosts[connection.host].nics.get(connection.nic)
        host_address = UNKNOWN if nic is None else nic.address.partition("/")[0]
    return Placeholders(
        {
            "device": name,
            "prefix": prefix,
            "stem": prefix.removesuffix("_") or name,
            "address": (connection.address if connection is not None else None) or UNKNOWN,
            "port": (connection.port if connection is not None else None) or UNKNOWN,
            "host_address": host_address,
        }
    )
