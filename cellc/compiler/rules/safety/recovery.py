"""Rules on what happens after a stop."""

from __future__ import annotations

from cellc.compiler.cell.site import STOPPED
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.vocabulary import NETWORK_GATES, PROMOTION_GATES, InterfaceKind


@rule(Severity.ERROR)
def automatic_recovery(graph: CellGraph) -> Findings:
    """Yield a recovery that acknowledges itself."""
    if graph.cell.safety.recovery.acknowledge == "automatic":
        path = ("safety", "recovery", "acknowledge")
        yield found(graph, path, "a person must acknowledge each recovery, got `automatic`")


@rule(Severity.ERROR)
def removed_gate(graph: CellGraph) -> Findings:
    """Yield each ladder of gates that is not complete and in order."""
    gates = graph.cell.bringup.gates
    for ladder in (PROMOTION_GATES, NETWORK_GATES):
        stated = [gate for gate in gates if gate in ladder]
        missing = [gate for gate in ladder if gate not in stated]
        if missing:
            yield found(graph, ("bringup", "gates"), f"`gates` must have {', '.join(missing)}")
        elif stated != list(ladder):
            order = ", ".join(stated)
            message = f"`gates` must be in the order {', '.join(ladder)}, got {order}"
            yield found(graph, ("bringup", "gates"), message)


@rule(Severity.ERROR)
def replayed_goal(graph: CellGraph) -> Findings:
    """Yield a recovery that resumes goals."""
    if graph.cell.safety.recovery.on_reconnect == "resume_goal":
        path = ("safety", "recovery", "on_reconnect")
        yield found(graph, path, "a goal must end when the connection is lost, got `resume_goal`")


@rule(Severity.ERROR)
def respawned_commander(graph: CellGraph) -> Findings:
    """Yield respawned nodes that send goals to a controller or to an action."""
    for node in graph.cell.nodes:
        if not node.respawn:
            continue
        commands = [
            c.action or c.name for c in graph.cell.controllers if c.client == node.name and c.command_interfaces
        ]
        commands += [
            interface.name
            for interface in graph.cell.interfaces
            if interface.kind is InterfaceKind.ACTION
            and any(e.node == node.name for e in (*interface.sinks, *interface.sources))
        ]
        if commands:
            message = f"`{node.name}` commands `{commands[0]}` and must not be restarted automatically"
            yield found(graph, (*node.path, "respawn"), message)


_EVERYWHERE = "emergency_stop"


@rule(Severity.ERROR)
def unnamed_recovery_state(graph: CellGraph) -> Findings:
    """Yield the states that are missing, in one finding; what no device has that states its own is not asked for."""
    states = graph.cell.safety.recovery.states
    known = {state.name for device in graph.cell.devices for state in device.procedures.safety.states}
    asked = [state for state in STOPPED if state in known or not known or state == _EVERYWHERE]
    missing = [state for state in asked if state not in states]
    if missing:
        names = ", ".join(f"`{state}`" for state in missing)
        yield found(graph, ("safety", "recovery", "states"), f"no recovery is named for {names}", f"add {names}")
