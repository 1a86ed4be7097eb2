"""The kind behind a type of controller: the device's own kinds come before the neutral ones."""

from __future__ import annotations

from cellc.catalog.controller_kind import ControllerKind
from cellc.catalog.device_model import DeviceModel
from cellc.catalog.load import controller_kinds, load_controller_kind


def kind_behind(type_: str, device: DeviceModel | None) -> ControllerKind | None:
    """Return what the catalogue says of a type of controller, or None where it has no such type.

    Args:
        type_: the type as the spec writes it.
        device: the device that the controller is of, if it is of any.

    Returns:
        The neutral kind, that which a device's variant acts as, or a passive kind of the device itself.
    """
    own = None if device is None else device.controllers.get(type_)
    if own is None:
        return load_controller_kind(type_).value if type_ in controller_kinds() else None
    assert device is not None  # it has the controller
    passive = own.passive_kind(device.as_of)
    return passive if passive is not None else load_controller_kind(own.behaviour).value
