"""Rules on the stop: who has it, what it depends on, and what shows that it works."""

from __future__ import annotations

import re
from collections.abc import Iterator

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, did_you_mean, found, rule
from cellc.contract.vocabulary import UNKNOWN, InterfaceKind


@rule(Severity.ERROR)
def dependent_stop(graph: CellGraph) -> Findings:
    """Yield hosts that a known stop path may need."""
    stop = graph.cell.safety.stop
    if stop.path == UNKNOWN and stop.authority == UNKNOWN:
        return  # nothing is known yet, which is reported as such
    needed = [host for host in graph.cell.hosts if host not in stop.independent_of]
    if needed:
        names = " and ".join(f"`{host}`" for host in needed)
        path = ("safety", "stop", "independent_of")
        yield found(graph, path, f"the stop is not declared independent of {names}")


_RELEASES = frozenset(
    ("acknowledge", "ack", "clear", "close", "recover", "recovery", "release", "reset", "restart", "resume", "unlock")
)
_STOPS = frozenset(
    ("emergency", "error", "errors", "estop", "fault", "faults", "protective", "reflex", "safeguard", "safety", "stop")
)
_BY_HAND = frozenset(("hmi", "operator", "panel", "pendant", "ui", "button"))


@rule(Severity.ERROR, assumes=("automatic-recovery",))
def software_acknowledges_stop(graph: CellGraph) -> Findings:
    """Yield clients of services and actions that release a stop, apart from those that a person presses."""
    acknowledge = ("safety", "recovery", "acknowledge")
    for interface in graph.cell.interfaces:
        words = _words(interface.name.rpartition("/")[2])
        if interface.kind is InterfaceKind.TOPIC or interface.derived:
            continue
        if words.isdisjoint(_RELEASES) or words.isdisjoint(_STOPS):
            continue
        for sink in interface.sinks:
            if _words(sink.node).isdisjoint(_BY_HAND):
                person = graph.cell.safety.recovery.acknowledge
                message = f"`{sink.node}` may call `{interface.name}`, but stops must be acknowledged by `{person}`"
                related = (Related("acknowledged by a person", graph.cell.locate(*acknowledge)),)
                yield found(graph, sink.path, message, related=related)


def _words(name: str) -> frozenset[str]:
    return frozenset(re.findall(r"[a-z]+", re.sub(r"([a-z])([A-Z])", r"\1_\2", name).lower()))


_NO_EVIDENCE = re.compile(
    r"(?i)\b(lifecycle|qos|deadline|liveliness|lease|domain|namespace|launch(ed)?|node active|topic|heartbeat|log)\b"
)


@rule(Severity.ERROR)
def software_as_safety_evidence(graph: CellGraph) -> Findings:
    """Yield pieces of evidence that name something of the software."""
    for index, text in enumerate(graph.cell.safety.stop.evidence):
        match = _NO_EVIDENCE.search(text)
        if match is not None:
            path = ("safety", "stop", "evidence", index)
            message = f"`{text}` says nothing about a safe state"
            yield found(graph, path, message)


@rule(Severity.ERROR)
def software_stop_path(graph: CellGraph) -> Findings:
    """Yield a stop path of software."""
    if graph.cell.safety.stop.path == "software":
        message = "the stop must not reach the drives through software"
        yield found(graph, ("safety", "stop", "path"), message)


_IN_THE_CELL = re.compile(
    r"(?i)\b(ros|ros2|node|workstation|laptop|moveit|move_group|controller_manager|script|software)\b"
)


@rule(Severity.ERROR)
def stop_authority_in_the_cell(graph: CellGraph) -> Findings:
    """Yield an authority that is a host, node or controller of the cell, or a word for software."""
    authority = graph.cell.safety.stop.authority
    parts = {*graph.cell.hosts, *(n.name for n in graph.cell.nodes), *(c.name for c in graph.cell.controllers)}
    if authority in parts or _IN_THE_CELL.search(authority):
        message = f"`{authority}` has the authority to stop, but is itself what must be stopped"
        yield found(graph, ("safety", "stop", "authority"), message)


@rule(Severity.ERROR)
def stop_independent_of_nothing(graph: CellGraph) -> Findings:
    """Yield names that are no host."""
    hosts = graph.cell.hosts
    for index, name in enumerate(graph.cell.safety.stop.independent_of):
        if name not in hosts:
            path = ("safety", "stop", "independent_of", index)
            yield found(graph, path, f"there is no host `{name}`", did_you_mean(name, hosts, "hosts"))


_NO_OWNER = re.compile(
    r"(?i)\b(qos|deadline|liveliness|domain(_id)?|namespace|lifecycle|watchdog|ros2?|software|node)\b"
)


@rule(Severity.ERROR)
def stop_owned_by_software(graph: CellGraph) -> Findings:
    """Yield owners of the safety that are a part of the cell or a word for software."""
    cell = graph.cell
    parts = {*cell.hosts, *(node.name for node in cell.nodes), *(c.name for c in cell.controllers)}
    for path, owner in _safety_owners(graph):
        if owner in parts or _NO_OWNER.search(owner):
            message = f"`{path[-1]}` must be owned by people, got the software `{owner}`"
            yield found(graph, path, message)


def _safety_owners(graph: CellGraph) -> Iterator[tuple[YamlPath, str]]:
    owners, recovery = graph.cell.owners, graph.cell.safety.recovery
    yield ("owners", "responsibilities", "vendor_safety"), owners.responsibilities.vendor_safety
    yield ("owners", "responsibilities", "physical_stop"), owners.responsibilities.physical_stop
    yield ("owners", "approvals", "safety"), owners.approvals.safety
    yield ("safety", "recovery", "owner"), recovery.owner
    yield ("safety", "recovery", "observer"), recovery.observer


@rule(Severity.BLOCKER)
def stop_without_evidence(graph: CellGraph) -> Findings:
    """Yield a stated stop without evidence."""
    stop = graph.cell.safety.stop
    if stop.authority != UNKNOWN and not stop.evidence:
        path = ("safety", "stop", "evidence")
        yield found(graph, path, f"nothing proves the stop of `{stop.authority}`")


@rule(Severity.BLOCKER, assumes=("unnamed-recovery-state",))
def stop_without_recovery(graph: CellGraph) -> Findings:
    """Yield the stops of a device that its vendor leads out of and the cell does not name, one finding a device."""
    named = set(graph.cell.safety.recovery.states)
    for device in graph.cell.devices:
        missing = [state for state in device.procedures.safety.recoverable_stops if state not in named]
        if missing:
            names = ", ".join(f"`{state}`" for state in missing)
            message = f"`{device.name}` can stop in {names}, and no recovery is named for it"
            related = (Related("the device", device.span),)
            yield found(graph, ("safety", "recovery", "states"), message, f"add {names}", related)
            named |= set(missing)


@rule(Severity.BLOCKER)
def unknown_stop_authority(graph: CellGraph) -> Findings:
    """Yield an unknown stop authority or path."""
    stop = graph.cell.safety.stop
    if not any(controller.command_interfaces for controller in graph.cell.controllers):
        return
    missing = [name for name, text in (("authority", stop.authority), ("path", stop.path)) if text == UNKNOWN]
    if missing:
        names = " and ".join(f"`{name}`" for name in missing)
        message = f"the stop {names} {'are' if len(missing) > 1 else 'is'} UNKNOWN"
        yield found(graph, ("safety", "stop", missing[0]), message)
