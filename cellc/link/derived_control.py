"""What controllers execute, publish and serve, and what stands in for them on real hardware."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.catalog.controller_kind import ControllerService, ControllerTopic
from cellc.cell.control import Controller
from cellc.cell.interface import Endpoint, Interface, InterfaceKind
from cellc.link.derivation import Derivation
from cellc.vocabulary import PASSIVE


def control_interfaces(source: Derivation) -> Iterator[Interface]:
    """Yield the actions of all controllers, and the topics and services of the passive ones."""
    for manager in source.managers:
        for controller in manager.controllers:
            yield from _actions(source, controller)
            if controller.behaviour in PASSIVE:
                yield from _passive(source, controller)


def _actions(source: Derivation, controller: Controller) -> Iterator[Interface]:
    if controller.action is not None and controller.action_type is not None:
        server = source.end(controller.label, controller.action, controller.path)
        yield _action(source, controller, controller.action, controller.action_type, server)
    other = controller.stand_in
    if other is not None and controller.device is not None:
        server = source.driver_end(controller.device, other.node, other.action, controller.path)
        yield _action(source, controller, other.action, other.action_type, server)


def _action(source: Derivation, controller: Controller, name: str, type_: str, server: Endpoint) -> Interface:
    return Interface(
        name=name,
        path=controller.path,
        span=controller.span,
        kind=InterfaceKind.ACTION,
        type=type_,
        sources=(server,),
        sinks=_clients(source, controller, name),
        derived=True,
        frame=None,
        unit="rad, s",
        time_source="ros",
        owner=source.spec.owners.responsibilities.command,
        goal_time_s=controller.goal_time_s,
        on_error=controller.on_violation,
        cancel_within_s=None if source.spec.kpis.cancel is None else source.spec.kpis.cancel.si,
    )


def _clients(source: Derivation, controller: Controller, interface: str) -> tuple[Endpoint, ...]:
    if controller.client is None:
        return ()
    return (source.end(controller.client, interface, (*controller.path, "client")),)


def _passive(source: Derivation, controller: Controller) -> Iterator[Interface]:
    kind = controller.declared
    if kind is None:
        return
    for topic in kind.topics:
        if topic.direction == "publish" and (not topic.only or source.distro in topic.only):
            yield _topic(source, controller, topic)
    yield from (_service(source, controller, service) for service in kind.services)


def _topic(source: Derivation, controller: Controller, topic: ControllerTopic) -> Interface:
    name = _absolute(controller, topic.name)
    qos = source.resolver.writer(topic.qos)
    return Interface(
        name=name,
        path=controller.path,
        span=controller.span,
        kind=InterfaceKind.TOPIC,
        type=topic.type,
        sources=(source.end(controller.label, name, controller.path, qos),),
        sinks=(),
        derived=True,
        time_source="ros",
        owner=source.spec.owners.responsibilities.command,
        wants="newest",
    )


def _service(source: Derivation, controller: Controller, service: ControllerService) -> Interface:
    name = _absolute(controller, service.name)
    return Interface(
        name=name,
        path=controller.path,
        span=controller.span,
        kind=InterfaceKind.SERVICE,
        type=service.type,
        sources=(source.end(controller.label, name, controller.path),),
        sinks=_clients(source, controller, name),
        derived=True,
        owner=source.spec.owners.responsibilities.command,
    )


def _absolute(controller: Controller, name: str) -> str:
    """Return a name of the catalogue in full: below the controller's own, or in its namespace."""
    return f"{controller.full_name}{name[1:]}" if name.startswith("~/") else f"{controller.namespace}/{name}"
