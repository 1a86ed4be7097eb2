"""Rules on how attempts end, and on the figures that they are judged by."""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def kpi_beyond_contract(graph: CellGraph) -> Findings:
    """Yield actions whose cancel may take longer than the target."""
    target = graph.cell.kpis.cancel_s
    for interface in graph.cell.interfaces if target is not None else ():
        bound = interface.cancel_within_s
        if target is not None and bound is not None and bound > target and not interface.derived:
            allowed = graph.cell.text("kpis", "cancel")
            message = (
                f"`cancel_within` of `{interface.name}` must be at most the target of {allowed}, got {bound * 1e3:g} ms"
            )
            related = (Related("the target is here", graph.cell.locate("kpis", "cancel")),)
            yield found(graph, (*interface.path, "cancel_within"), message, related=related)


@rule(Severity.WARNING)
def kpi_without_target(graph: CellGraph) -> Findings:
    """Yield the figures without a target in one finding."""
    missing = graph.cell.kpis.without_target()
    if missing:
        names = ", ".join(f"`{name}`" for name in missing)
        yield found(graph, ("kpis",), f"{names} {'have' if len(missing) > 1 else 'has'} no target")


@rule(Severity.ERROR)
def merged_failure_layers(graph: CellGraph) -> Findings:
    """Yield rehearsals that expect a failure which belongs to none of their faults."""
    for rehearsal in graph.cell.rehearsals:
        layers = [layer for fault in rehearsal.faults for layer in fault.kind.layers]
        if layers and rehearsal.expect != "succeeded" and rehearsal.expect not in layers:
            faults = " and ".join(f"`{fault.kind}`" for fault in rehearsal.faults)
            message = f"`{rehearsal.name}` injects {faults} but expects `{rehearsal.expect}`"
            fitting = " or ".join(f"`{layer}`" for layer in dict.fromkeys(layers))
            yield found(graph, (*rehearsal.path, "expect"), message, f"expect {fitting}, or `succeeded`")


@rule(Severity.ERROR)
def tolerated_wrong_owner(graph: CellGraph) -> Findings:
    """Yield a target above zero wrong owners, and below all stale samples rejected."""
    kpis = graph.cell.kpis
    if kpis.wrong_owner_events:
        message = f"`wrong_owner_events` must be 0, got {kpis.wrong_owner_events}"
        yield found(graph, ("kpis", "wrong_owner_events"), message, "write 0")
    if kpis.stale_state_rejection is not None and kpis.stale_state_rejection < 1.0:
        path = ("kpis", "stale_state_rejection")
        message = f"`stale_state_rejection` must be 100 %, got {graph.cell.text(*path)}"
        yield found(graph, path, message, "write 100 %")


@rule(Severity.WARNING)
def unrehearsed_failure(graph: CellGraph) -> Findings:
    """Yield a cell with observed goals that rehearses no stale state, or no cancel, in one finding."""
    dynamic = {frame.name for frame in graph.cell.frames if frame.kind is FrameKind.DYNAMIC}
    if not graph.cell.rehearsals or not any(goal.frame in dynamic for goal in graph.cell.goals):
        return
    expected = {rehearsal.expect for rehearsal in graph.cell.rehearsals}
    missing = [outcome for outcome in ("stale_state", "canceled") if outcome not in expected]
    if missing:
        names = " and ".join(f"`{outcome}`" for outcome in missing)
        yield found(graph, ("rehearsals",), f"no rehearsal ends in {names}")
