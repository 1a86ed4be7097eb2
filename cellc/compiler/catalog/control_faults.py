"""What controller managers refuse of a device, or what a real robot would not notice, from its device.yaml alone."""

from __future__ import annotations

import re
from collections.abc import Iterator

from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.tables import DistroTable
from cellc.compiler.source.document import SourceDocument
from cellc.contract.diagnostics import Diagnostic, Related, Severity, YamlPath
from cellc.robot.description.model import Description

_PRETENDS = re.compile(r"(^|_)(fake|mock|dummy|sim|simulat(e|ed|ion)|virtual)(_|$)", re.IGNORECASE)
"""Words by which vendors name the parameter that switches their plugin off: ``use_fake_hardware``, ``use_dummy``."""
_YES = ("true", "1", "yes", "on")


def control_faults(
    model: DeviceModel, description: Description, document: SourceDocument, table: DistroTable
) -> Iterator[Diagnostic]:
    """Yield followers with a command of their own, and a real target that reaches nothing.

    Args:
        table: has the plugins that touch no hardware.
    """
    yield from _commanded_followers(model, description, document)
    yield from _pretended(model, document, table)


def _commanded_followers(
    model: DeviceModel, description: Description, document: SourceDocument
) -> Iterator[Diagnostic]:
    """Yield what hardware_interface/src/component_parser.cpp of ros2_control 4.47.0 refuses of joints that mimic."""
    for name, interfaces in {} if model.control is None else model.control.joints.items():
        joint = description.joint(name)
        if joint is None or joint.mimic is None or not interfaces.command:
            continue
        message = f"`{name}` mimics `{joint.mimic.joint}` and must have no command interface, got"
        message += f" {', '.join(f'`{each}`' for each in interfaces.command)}"
        path: YamlPath = ("control", "joints", name)
        place = joint.mimic.span or joint.span
        related = () if place is None else (Related("it mimics here", place),)
        advice = f"leave out `command` of `{name}`, or its `<mimic>` where it has a drive of its own"
        key = document.locate_key(path)
        yield Diagnostic("commanded-follower", Severity.ERROR, message, key, path, advice, related)


def _pretended(model: DeviceModel, document: SourceDocument, table: DistroTable) -> Iterator[Diagnostic]:
    real = None if model.control is None else model.control.hardware.real
    if real is None:
        return
    path: YamlPath = ("control", "hardware", "real")
    package = real.plugin.partition("/")[0]
    if real.plugin in table.harmless_plugins or package in table.simulators:
        message = f"the plugin of the real target must reach the device, got `{real.plugin}`, which moves nothing"
        yield _of_real(message, (*path, "plugin"), document)
    for name, text in real.parameters.items():
        if _PRETENDS.search(name) and text.strip().lower() in _YES:
            message = f"the real target must reach the device, got `{name}: {text}`, which has the plugin pretend"
            yield _of_real(message, (*path, "parameters", name), document)


def _of_real(message: str, path: YamlPath, document: SourceDocument) -> Diagnostic:
    advice = "name the driver under `real:`, or leave `real:` out until there is one"
    return Diagnostic("pretended-hardware", Severity.WARNING, message, document.locate(path), path, advice)
