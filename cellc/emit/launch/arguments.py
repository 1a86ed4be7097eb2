"""Launch arguments, each with description and choices."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.cell.cell import Cell
from cellc.formats.confirmation import CONFIRMATION
from cellc.formats.xml_text import element


def target_argument() -> Element:
    """Return the choice between the mock and real hardware."""
    return _argument("target", "mock", "What the hardware interfaces reach: mock or real hardware.", "mock", "real")


def gate_argument() -> Element:
    """Return the argument that a person has to give before real hardware is reached; it has no default."""
    text = "Stated by the person who releases the real target: gates G0 to G2 have their evidence, drives are disabled."
    return _argument("confirm_real", None, text, CONFIRMATION)


def address_arguments(cell: Cell) -> Iterator[Element]:
    """Yield an argument for each device with an address; the launch refuses any other than that of the URDF."""
    for device in cell.devices:
        address = None if device.spec.connection is None else device.spec.connection.address
        if address is not None:
            text = (
                f"Address of device {device.name}; the URDF holds it, so that a change is made in the spec and built."
            )
            yield _argument(f"{device.name}_address", address, text, address)


def _argument(name: str, default: str | None, description: str, *choices: str) -> Element:
    stated = {} if default is None else {"default": default}
    attributes = {"name": name, **stated, "description": description}
    return element("arg", attributes, [element("choice", {"value": choice}) for choice in choices])
