"""What the catalogue knows of interface types."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.catalog.load import load_message_types
from cellc.catalog.tables import InterfaceTypeFacts


def interface_types() -> Mapping[str, InterfaceTypeFacts]:
    """Return the known types by full name; a cell may use others of its own packages."""
    table = load_message_types().value
    return {} if table is None else table.types
