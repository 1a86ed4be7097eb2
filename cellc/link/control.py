"""Binds controller managers: their hosts, hardware and switches; each controller is bound apart."""

from __future__ import annotations

from collections import Counter

from cellc.cell.control import Controller, ControllerManager, ControllerSwitch
from cellc.diagnostics import Diagnostic, Outcome, YamlPath
from cellc.link.controller import ControlContext, ControllerPlace, link_controller
from cellc.link.names import unknown_name
from cellc.source.document import SourceDocument
from cellc.spec.cell_spec import CellSpec
from cellc.spec.control import ManagerSpec


def link_managers(context: ControlContext) -> Outcome[tuple[ControllerManager, ...]]:
    """Bind every controller manager of the spec."""
    managers: list[ControllerManager] = []
    problems: list[Diagnostic] = []
    written_managers = _written_managers(context.spec)
    named = Counter(name for _, _, written in written_managers for name in written.controllers)
    shared = frozenset(name for name, count in named.items() if count > 1)
    for name, path, written in written_managers:
        bound = _manager(name, path, written, shared, context)
        problems += bound.diagnostics
        if bound.value is not None:
            managers.append(bound.value)
    return Outcome(tuple(managers), tuple(problems))


def _written_managers(spec: CellSpec) -> tuple[tuple[str, YamlPath, ManagerSpec], ...]:
    single: tuple[tuple[str, YamlPath, ManagerSpec], ...] = ()
    if spec.control is not None:
        single = (("control", ("control",), spec.control),)
    return single + tuple((name, ("managers", name), written) for name, written in spec.managers.items())


def _manager(
    name: str, path: YamlPath, written: ManagerSpec, shared: frozenset[str], context: ControlContext
) -> Outcome[ControllerManager]:
    controllers: list[Controller] = []
    problems: list[Diagnostic] = []
    document = context.document
    if written.host is not None and written.host not in context.spec.hosts:
        at = (*path, "host")
        problems.append(unknown_name("unknown-host", written.host, "host", context.spec.hosts, document, at))
    for key, entry in written.controllers.items():
        label = f"{written.namespace}/{key}" if key in shared else key
        place = ControllerPlace(key, label, name, written.namespace, (*path, "controllers", key))
        bound = link_controller(place, entry, context)
        problems += bound.diagnostics
        if bound.value is not None:
            controllers.append(bound.value)
    problems += _unknown_switch_members(path, written, document)
    manager = ControllerManager(
        name=name,
        path=path,
        span=document.locate(path),
        namespace=written.namespace,
        update_rate_hz=written.update_rate.si,
        host=written.host,
        devices=_managed_devices(written, context),
        controllers=tuple(controllers),
        switches=tuple(
            ControllerSwitch(
                name=key,
                path=(*path, "switches", key),
                span=document.locate((*path, "switches", key)),
                activate=entry.activate,
                deactivate=entry.deactivate,
            )
            for key, entry in written.switches.items()
        ),
    )
    return Outcome(manager, tuple(problems))


def _managed_devices(written: ManagerSpec, context: ControlContext) -> tuple[str, ...]:
    """One manager loads all hardware of the cell; several load what their own controllers drive."""
    with_hardware = tuple(name for name, bound in context.devices.items() if bound.device.hardware is not None)
    if not context.spec.managers:
        return with_hardware
    named = {entry.device for entry in written.controllers.values()}
    return tuple(name for name in with_hardware if name in named)


def _unknown_switch_members(path: YamlPath, written: ManagerSpec, document: SourceDocument) -> list[Diagnostic]:
    return [
        unknown_name(
            "unknown-controller", name, "controller", written.controllers, document, (*path, "switches", key, side, at)
        )
        for key, entry in written.switches.items()
        for side, names in (("activate", entry.activate), ("deactivate", entry.deactivate))
        for at, name in enumerate(names)
        if name not in written.controllers
    ]
