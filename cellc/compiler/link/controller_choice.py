"""Chooses the kind of a controller for the distribution, with what to write instead where it has no such kind."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.compiler.catalog.controller_kind import ControllerKind
from cellc.compiler.catalog.device_controller import DeviceController
from cellc.compiler.catalog.load import controller_kinds, kind_behind, load_controller_kind
from cellc.compiler.link.devices import BoundDevice
from cellc.compiler.source.document import SourceDocument
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, YamlPath, did_you_mean, only_nearest
from cellc.contract.vocabulary import OF_ONE_DEVICE, Distro


def choose_kind(
    type_: str, bound: BoundDevice | None, distro: Distro, document: SourceDocument, at: YamlPath
) -> Outcome[ControllerKind]:
    """Return what the catalog says of a type that the distribution has.

    Args:
        type_: as the spec writes it, at the path ``at``.
        bound: the device that the controller is of, if it is of any; its own kinds come before the neutral ones.
    """
    facts = None if bound is None else bound.facts
    own = {} if facts is None else facts.controllers
    kind = kind_behind(type_, facts)
    if kind is None:
        return Outcome(None, (_unknown(type_, _released(own, distro), document, at),))
    plugins = own[type_].plugins if type_ in own else kind.plugins
    if distro in plugins:
        return Outcome(kind)
    others = ", ".join(f"`{other}`" for other in _acting_alike(kind, own, distro))
    problem = Diagnostic(
        code="controller-not-in-distro",
        severity=Severity.ERROR,
        message=f"`{type_}` does not exist on {distro}, only on {', '.join(plugins)}",
        span=document.locate(at),
        yaml_path=at,
        help=f"use {others}" if others else f"remove it: nothing on {distro} does the same",
    )
    return Outcome(None, (problem,))


def _released(own: Mapping[str, DeviceController], distro: Distro) -> tuple[str, ...]:
    """Return the kinds that a distribution has: those of the device, then the neutral ones."""
    neutral = {name: load_controller_kind(name).value for name in controller_kinds()}
    mine = (name for name, facts in own.items() if distro in facts.plugins)
    return (*mine, *(name for name, facts in neutral.items() if facts is not None and distro in facts.plugins))


def _acting_alike(kind: ControllerKind, own: Mapping[str, DeviceController], distro: Distro) -> tuple[str, ...]:
    """Return the kinds of a distribution that do what another does."""
    if kind.kind in OF_ONE_DEVICE:
        return ()
    acts_as = {name: facts.behavior for name, facts in own.items()}
    return tuple(name for name in _released(own, distro) if acts_as.get(name, name) == kind.kind)


def _unknown(type_: str, known: tuple[str, ...], document: SourceDocument, at: YamlPath) -> Diagnostic:
    return Diagnostic(
        code="unknown-controller-kind",
        severity=Severity.ERROR,
        message=f"there is no kind of controller `{type_}`",
        span=document.locate(at),
        yaml_path=at,
        help=did_you_mean(type_, known, "kinds of controllers"),
        fix=document.fix(document.locate(at), type_, only_nearest(type_, known), sure=False),
    )
