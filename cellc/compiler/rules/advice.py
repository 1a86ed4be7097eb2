"""Help that can be followed in the distribution of the cell."""

from __future__ import annotations

from collections.abc import Collection

from cellc.compiler.cell.device import Device
from cellc.contract.vocabulary import Distro


def add_controllers(device: Device, kinds: Collection[str], distro: Distro) -> str:
    """Return the help where controllers of a device are missing; a distribution has not every one of them."""
    helps = [
        f"{distro} has no `{kind}`, which {' and '.join(others)} have: place an observer instead"
        for kind, others in device.control.controller_kinds.items()
        if kind in kinds and distro not in others
    ]
    there = [kind for kind in kinds if distro in device.control.controller_kinds.get(kind, (distro,))]
    if there:
        types = " and of ".join(f"`type: {kind}`" for kind in there)
        helps.insert(0, f"add a controller of {types} with `device: {device.name}`")
    return "; ".join(helps)
