"""Help that can be followed in the distribution of the cell."""

from __future__ import annotations

from collections.abc import Iterable

from cellc.compiler.cell.device import Device
from cellc.contract.vocabulary import Distro


def add_controllers(device: Device, kinds: Iterable[str], distro: Distro) -> str:
    """Return the help where controllers of a device are missing; a distribution has not every one of them."""
    unreleased = device.control.unreleased_kinds
    advice = [f"`type: {kind}`" for kind in kinds if kind not in unreleased]
    missing = {kind: unreleased[kind] for kind in kinds if kind in unreleased}
    helps = [f"add a controller of {' and of '.join(advice)} with `device: {device.name}`"] if advice else []
    for kind, others in missing.items():
        helps.append(f"{distro} has no `{kind}`, which {' and '.join(others)} have: place an observer instead")
    return "; ".join(helps)
