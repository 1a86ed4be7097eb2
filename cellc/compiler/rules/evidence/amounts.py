"""Bounds of counts and shares: of evidence, of targets, and of what the mock adds."""

from __future__ import annotations

import math
from collections.abc import Iterator

from cellc.compiler.rules.bounds import Bound, Figure, outside, stated
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, YamlPath, rule

_Owners = Iterator[tuple[YamlPath, object]]


def _calibrations(graph: CellGraph) -> _Owners:
    return ((calibration.path, calibration) for calibration in graph.cell.calibrations.values())


def _frames(graph: CellGraph) -> _Owners:
    return ((frame.path, frame) for frame in graph.cell.frames)


def _kpis(graph: CellGraph) -> _Owners:
    yield ("kpis",), graph.cell.kpis


def _clocks(graph: CellGraph) -> _Owners:
    yield from (((*host.path, "clock"), host.clock) for host in graph.cell.hosts.values())
    for device in graph.cell.devices:
        if device.sensing.stamp is not None:
            yield (*device.path, "stamp"), device.sensing.stamp.clock


def _networks(graph: CellGraph) -> _Owners:
    for interface in graph.cell.interfaces:
        if interface.simulated is not None:
            yield (*interface.path, "simulated"), interface.simulated


def _simulated(graph: CellGraph) -> Iterator[Figure]:
    for device in graph.cell.devices:
        for joint in device.mock.simulated_joints:
            if joint.lag_s is not None:
                yield Figure((*joint.path, "lag"), joint.lag_s, most=1.0, unit="ms")
            if joint.noise is not None:
                yield Figure(
                    (*joint.path, "noise"), abs(joint.noise.value), most=0.1, unit="mm" if joint.noise.linear else "deg"
                )


def _rehearsals(graph: CellGraph) -> _Owners:
    return ((rehearsal.path, rehearsal) for rehearsal in graph.cell.rehearsals)


def _cycles(graph: CellGraph) -> Iterator[Figure]:
    """Yield how many cycles faults skip, at most those of a minute, or of the time of the rehearsal."""
    fastest = max((manager.update_rate_hz for manager in graph.cell.managers), default=1000.0)
    for rehearsal in graph.cell.rehearsals:
        for fault in rehearsal.faults:
            if fault.cycles is not None:
                yield Figure((*fault.path, "skip_cycles"), fault.cycles, 1, min(rehearsal.timeout_s, 60.0) * fastest)


def _deviations(graph: CellGraph) -> Iterator[Figure]:
    uncertainty = graph.cell.uncertainty
    if uncertainty is None:
        return
    for name, turn in uncertainty.rotations_rad.items():
        path = ("uncertainty", "calibrations", name, "rotation")
        yield Figure(path, turn, 1e-6 if turn else 0.0, math.radians(5.0))
    for name, share in uncertainty.compensations.items():
        yield Figure(("uncertainty", "loads", name, "compensation"), share, 1e-4 if share else 0.0, 0.5, unit="%")


def _frictions(graph: CellGraph) -> Iterator[Figure]:
    """Yield how much the friction of parts varies, which the friction itself bounds."""
    stated = {frame.name: frame.grasp.grips_with for frame in graph.cell.frames if frame.grasp is not None}
    uncertainty = graph.cell.uncertainty
    for name, friction in () if uncertainty is None else uncertainty.frictions.items():
        yield Figure(("uncertainty", "parts", name, "friction"), friction, 1e-4, stated.get(name, math.inf) / 2.0)


_INJECTED = ("rehearsals.*.inject", "rehearsals.*.inject.*")
BOUNDS = (
    stated("calibrations.*.samples", _calibrations, "samples", 1, 100_000, "", "what a person or a program takes"),
    stated("frames.*.reference_points", _frames, "reference_points", 0, 1000, "", "what a person touches"),
    stated("kpis.missed_cycles", _kpis, "missed_cycles", 0, 100, "", "with which a loop still is one"),
    stated("kpis.protective_stops", _kpis, "protective_stops", 0, 100, "", "in a shift in which something is made"),
    stated(
        ("hosts.*.clock.simulated_drift", "devices.*.stamp.simulated_drift"),
        *(_clocks, "simulated_drift", -1e-3, 1e-3, "ppm", "what clocks drift by"),
    ),
    stated("interfaces.*.simulated.latency", _networks, "latency_s", 0.0, 0.5, "s", "what networks take"),
    stated("interfaces.*.simulated.jitter", _networks, "jitter_s", 0.0, 0.5, "s", "what networks add"),
    stated("interfaces.*.simulated.loss", _networks, "loss", 0.0, 0.9, "%", "with which something still arrives"),
    stated("interfaces.*.simulated.reordering", _networks, "reordering", 0.0, 0.9, "%", "what networks reorder"),
    Bound(
        ("devices.*.simulated_joints.*.lag", "devices.*.simulated_joints.*.noise"),
        "what the mock adds",
        "deg",
        "with which an arm still follows",
        _simulated,
    ),
    stated("rehearsals.*.success", _rehearsals, "success", 0.5, 1.0, "%", "what more runs than not must do"),
    Bound(
        tuple(f"{place}.skip_cycles" for place in _INJECTED),
        "the number of cycles",
        "",
        "what the rehearsal has of them",
        _cycles,
    ),
    Bound(
        ("uncertainty.calibrations.*.rotation", "uncertainty.loads.*.compensation"),
        "the deviation",
        "deg",
        "which is drawn again and again",
        _deviations,
    ),
    Bound(("uncertainty.parts.*.friction",), "the deviation", "", "below the friction itself", _frictions),
)


@rule(Severity.WARNING, gives_way=True)
def implausible_amount(graph: CellGraph) -> Findings:
    """Yield counts and shares that neither a person nor a program takes."""
    yield from outside(graph, BOUNDS)
