"""Chooses what a type of controller is: its kind, and its plugin for the distribution."""

from __future__ import annotations

from cellc.catalog.catalog_model import Distro
from cellc.catalog.controller_kind import ControllerKind
from cellc.catalog.device_control import PluginUse
from cellc.catalog.kind_of import kind_behind
from cellc.catalog.load import controller_kinds
from cellc.cell.device import Device
from cellc.diagnostics import Diagnostic, Outcome, Severity, YamlPath, did_you_mean
from cellc.source.document import SourceDocument


def choose_plugin(
    type_: str, path: YamlPath, device: Device | None, distro: Distro, document: SourceDocument
) -> Outcome[tuple[PluginUse, ControllerKind]]:
    """Choose the plugin of a type for the distribution: the device's own kinds come before the neutral ones."""
    own = {} if device is None else device.facts.controllers
    kind = kind_behind(type_, None if device is None else device.facts)
    at = (*path, "type")
    if kind is None:
        return Outcome(None, (_unknown_kind(type_, (*own, *controller_kinds()), document, at),))
    plugins = own[type_].plugins if type_ in own else kind.plugins
    if distro in plugins:
        return Outcome((plugins[distro], kind))
    problem = Diagnostic(
        code="controller-not-in-distro",
        severity=Severity.ERROR,
        message=f"`{type_}` does not exist on {distro}, only on {', '.join(plugins)}",
        span=document.locate(at),
        yaml_path=at,
        help="choose a kind that the pinned distribution has",
    )
    return Outcome(None, (problem,))


def behaviour_of(plugin: PluginUse, device: Device | None, kind: ControllerKind, distro: Distro) -> str:
    """Return the neutral kind; a trajectory controller that is told of the device's speed scaling follows it."""
    neutral = kind.plugins.get(distro)
    scaling = None if device is None else device.facts.speed_scaling
    if scaling is None or (neutral is not None and neutral.type == plugin.type):
        return kind.kind  # where the upstream plugin is used it takes the factor by parameters of its own
    return f"scaled_{kind.kind}" if scaling.state_interface in plugin.parameters.values() else kind.kind


def _unknown_kind(type_: str, known: tuple[str, ...], document: SourceDocument, at: YamlPath) -> Diagnostic:
    return Diagnostic(
        code="unknown-controller-kind",
        severity=Severity.ERROR,
        message=f"there is no kind of controller `{type_}`",
        span=document.locate(at),
        yaml_path=at,
        help=did_you_mean(type_, known, "kinds of controllers"),
    )
