"""Binds the interfaces that the user wrote to the nodes, devices and controllers at their ends."""

from __future__ import annotations

from cellc.compiler.cell.interface import Endpoint, Interface
from cellc.compiler.link.endpoints import EndName, EndpointNames
from cellc.compiler.link.frames import FrameNames
from cellc.compiler.link.hopeless import until_hopeless
from cellc.compiler.link.names import unknown_name
from cellc.compiler.link.quantities import si
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.interfaces import (
    ActionSpec,
    Endpoints,
    InterfaceFields,
    QosSpec,
    ServiceSpec,
    SimulatedNetworkSpec,
    TopicSpec,
)
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, YamlPath
from cellc.contract.entities import SimulatedNetwork
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import InterfaceKind


def link_interfaces(
    spec: CellSpec, document: SourceDocument, ends: EndpointNames, frames: FrameNames
) -> Outcome[tuple[Interface, ...]]:
    """Bind every interface that the user wrote."""
    interfaces: list[Interface] = []
    problems: list[Diagnostic] = []
    for name, interface in until_hopeless(spec.interfaces.items(), problems):
        bound = _interface(name, interface, document, ends, frames)
        problems += bound.diagnostics
        if bound.value is not None:
            interfaces.append(bound.value)
    return Outcome(tuple(interfaces), tuple(problems))


def _interface(
    name: str,
    written: TopicSpec | ServiceSpec | ActionSpec,
    document: SourceDocument,
    ends: EndpointNames,
    frames: FrameNames,
) -> Outcome[Interface]:
    path = ("interfaces", name)
    frame: Outcome[str] = Outcome(None)
    if written.frame is not None:
        frame = frames.bind(written.frame, (*path, "frame"))
    source_key, sink_key = ("from", "to") if isinstance(written, TopicSpec) else ("server", "client")
    written_sources = written.from_ if isinstance(written, TopicSpec) else written.server
    written_sinks = written.to if isinstance(written, TopicSpec) else written.client
    sources = _endpoints(name, written_sources, document, (*path, source_key), ends, serves=True)
    sinks = _endpoints(name, written_sinks, document, (*path, sink_key), ends, serves=False)
    problems = (*frame.diagnostics, *sources.diagnostics, *sinks.diagnostics)
    bound_sources = sources.value or ()
    owner = written.owner or (ends.known[bound_sources[0].node].owner if bound_sources else None)
    common = _Common(name, path, document, frame.value, owner, bound_sources, sinks.value or ())
    if isinstance(written, TopicSpec):
        return Outcome(_topic(common, written), problems)
    return Outcome(_call(common, written), problems)


@dataclass(frozen=True, slots=True)
class _Common:
    """What topics, services and actions share once bound."""

    name: str
    path: YamlPath
    document: SourceDocument
    frame: str | None
    owner: str | None
    sources: tuple[Endpoint, ...]
    sinks: tuple[Endpoint, ...]


def _topic(common: _Common, written: TopicSpec) -> Interface:
    return Interface(
        name=common.name,
        path=common.path,
        span=common.document.locate(common.path),
        kind=InterfaceKind.TOPIC,
        type=written.topic,
        sources=common.sources,
        sinks=common.sinks,
        frame=common.frame,
        unit=written.unit,
        time_source=_time_source(written),
        owner=common.owner,
        wants=written.wants,
        rate_hz=si(written.rate),
        max_age_s=si(written.max_age),
        transport_s=si(written.transport),
        on_stale=written.on_stale,
        simulated=_simulated(written.simulated),
    )


def _simulated(written: SimulatedNetworkSpec | None) -> SimulatedNetwork | None:
    if written is None:
        return None
    return SimulatedNetwork(
        latency_s=si(written.latency) or 0.0,
        jitter_s=si(written.jitter) or 0.0,
        loss=si(written.loss) or 0.0,
        reordering=si(written.reordering) or 0.0,
    )


def _call(common: _Common, written: ServiceSpec | ActionSpec) -> Interface:
    is_action = isinstance(written, ActionSpec)
    return Interface(
        name=common.name,
        path=common.path,
        span=common.document.locate(common.path),
        kind=InterfaceKind.ACTION if is_action else InterfaceKind.SERVICE,
        type=written.action if isinstance(written, ActionSpec) else written.service,
        sources=common.sources,
        sinks=common.sinks,
        frame=common.frame,
        unit=written.unit,
        time_source=_time_source(written),
        owner=common.owner,
        timeout_s=si(written.timeout),
        on_timeout=written.on_timeout,
        on_error=written.on_error if isinstance(written, ServiceSpec) else None,
        cancel_within_s=si(written.cancel_within) if isinstance(written, ActionSpec) else None,
    )


def _endpoints(
    interface: str, written: Endpoints, document: SourceDocument, path: YamlPath, ends: EndpointNames, *, serves: bool
) -> Outcome[tuple[Endpoint, ...]]:
    endpoints: list[Endpoint] = []
    problems: list[Diagnostic] = []
    for node, qos, at in until_hopeless(_written_endpoints(written, path), problems):
        bound = _end_name(node, document, at, ends)
        problems += bound.diagnostics
        if bound.value is not None:
            endpoints.append(bound.value.end(interface, at, document.locate_key(at), qos, serves=serves))
    return Outcome(tuple(endpoints), tuple(problems))


def _end_name(node: str, document: SourceDocument, at: YamlPath, ends: EndpointNames) -> Outcome[EndName]:
    if node in ends.known:
        return Outcome(ends.known[node])
    if node not in ends.shared:
        return Outcome(None, (unknown_name("unknown-node", node, "node", ends.known, document, at),))
    full_names = " or ".join(f"`{name}`" for name in ends.shared[node])
    problem = Diagnostic(
        code="ambiguous-node",
        severity=Severity.ERROR,
        message=f"`{node}` is the name of {len(ends.shared[node])} controllers",
        span=document.locate(at),
        yaml_path=at,
        help=f"write {full_names}",
    )
    return Outcome(None, (problem,))


def _written_endpoints(written: Endpoints, path: YamlPath) -> tuple[tuple[str, QosSpec, YamlPath], ...]:
    plain = QosSpec()
    if isinstance(written, str):
        return ((written, plain, path),)
    if isinstance(written, tuple):
        return tuple((node, plain, (*path, index)) for index, node in enumerate(written))
    return tuple((node, qos, (*path, node)) for node, qos in written.items())


def _time_source(written: InterfaceFields) -> str:
    return written.time_source or "ros"
