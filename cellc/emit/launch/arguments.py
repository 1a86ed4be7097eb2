"""Launch arguments, each with description and choices."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.cell.cell import Cell
from cellc.deploy.releases import CONFIRMATION, MOTION_CONFIRMATION
from cellc.formats.xml_text import element

EVERYWHERE = "all"
"""The choice of ``host`` that starts the whole cell on one computer, which only the mock allows."""

_NOT_YET = "no"
CONFIRM_REAL = "confirm_real"
CONFIRM_MOTION = "confirm_motion"
_RELEASES = {
    CONFIRM_REAL: (
        CONFIRMATION,
        "Stated by the person who releases the real target: gates G0 to G2 have their evidence, drives are disabled.",
    ),
    CONFIRM_MOTION: (
        MOTION_CONFIRMATION,
        "Stated by the person who releases motion on the real target: gates G0 to G6 have their evidence, the "
        "observer stands at the stop.",
    ),
}


def target_argument() -> Element:
    """Return the choice between the mock and real hardware."""
    return _argument("target", "mock", "What the hardware interfaces reach: mock or real hardware.", "mock", "real")


def release_argument(name: str) -> Element:
    """Return the argument with which a person releases something; alone it releases nothing."""
    return _argument(name, _NOT_YET, f"{_RELEASES[name][1]} Not needed on the mock.", _NOT_YET, _RELEASES[name][0])


def gate_argument(name: str) -> Element:
    """Return the same argument as a gate demands it: without a default, and with the one word that opens it."""
    return _argument(name, None, _RELEASES[name][1], _RELEASES[name][0])


def host_argument(hosts: tuple[str, ...]) -> Element:
    """Return the choice of the computer on which this is launched."""
    text = "The computer on which this is launched; the whole cell on one computer is for the mock alone."
    return _argument("host", EVERYWHERE, text, EVERYWHERE, *hosts)


def stated_host_argument(hosts: tuple[str, ...]) -> Element:
    """Return the same argument as the gate before real hardware demands it."""
    return _argument(
        "host", None, "The computer on which this is launched: real hardware is reached from its own.", *hosts
    )


def address_arguments(cell: Cell) -> Iterator[Element]:
    """Yield an argument for each device with an address; the launch refuses any other than that of the URDF."""
    for name, address in addresses(cell).items():
        device = name.removesuffix("_address")
        text = f"Address of device {device}; the URDF holds it, so that a change is made in the spec and built."
        yield _argument(name, address, text, address)


def addresses(cell: Cell) -> dict[str, str]:
    """Return the argument of each device with an address."""
    connections = ((device.name, device.spec.connection) for device in cell.devices)
    return {f"{name}_address": one.address for name, one in connections if one is not None and one.address is not None}


def _argument(name: str, default: str | None, description: str, *choices: str) -> Element:
    stated = {} if default is None else {"default": default}
    attributes = {"name": name, **stated, "description": description}
    return element("arg", attributes, [element("choice", {"value": choice}) for choice in choices])
