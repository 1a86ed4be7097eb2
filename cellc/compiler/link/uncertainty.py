"""Binds what sweeps draw and judge to the calibrations, objects and goals of the cell."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from cellc.compiler.cell.motion import PlanningGroup
from cellc.compiler.cell.uncertainty import Region, Uncertainty
from cellc.compiler.link.motion import Machine
from cellc.compiler.link.names import unknown_name
from cellc.compiler.link.quantities import si
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.uncertainty import RegionSpec, UncertaintySpec
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity


def link_uncertainty(
    spec: CellSpec, document: SourceDocument, machine: Machine, groups: Sequence[PlanningGroup] | None
) -> Outcome[Uncertainty | None]:
    """Bind the uncertainty of a cell; None where neither it nor a region nor a rate of success is stated.

    Args:
        groups: None where they could not be bound, which is reported elsewhere.
    """
    alone = tuple(_confidence_alone(spec, document))
    wanted = any(rehearsal.success is not None for rehearsal in spec.rehearsals.values())
    if spec.uncertainty is None and not spec.regions and not wanted:
        return Outcome(None, alone)
    uncertainty = spec.uncertainty or UncertaintySpec()
    rotations = {name: si(calibration.rotation) for name, calibration in uncertainty.calibrations.items()}
    bound = Uncertainty(
        rotations_rad=_stated(rotations),
        regions={name: _region(region) for name, region in spec.regions.items()},
        repeatability_m={name: value.si for name, value in uncertainty.repeatability.items()},
        parts_kg=_stated({name: si(load.part) for name, load in uncertainty.loads.items()}),
        compensations=_stated({name: si(load.compensation) for name, load in uncertainty.loads.items()}),
        payloads_kg=_stated({name: si(load.payload) for name, load in uncertainty.loads.items()}),
        masses_kg=_stated({name: si(part.mass) for name, part in uncertainty.parts.items()}),
        frictions=_stated({name: part.friction for name, part in uncertainty.parts.items()}),
        tolerances_m={name: value.si for name, value in uncertainty.tolerances.items()},
    )
    known = groups is not None and machine.placed
    still = _still(spec, uncertainty, document, machine, groups or ()) if known else ()
    return Outcome(bound, (*_unknown(spec, uncertainty, document), *still, *alone))


def _region(written: RegionSpec) -> Region:
    x, y, z = (edge / 2.0 for edge in written.box.si)
    return Region(half_m=(x, y, z), half_yaw_rad=(si(written.yaw) or 0.0) / 2.0)


def _stated(values: Mapping[str, float | None]) -> dict[str, float]:
    """Return what is stated, without what is zero."""
    return {name: value for name, value in values.items() if value}


def _unknown(spec: CellSpec, written: UncertaintySpec, document: SourceDocument) -> Iterator[Diagnostic]:
    places = [name for name, frame in spec.frames.items() if frame.simulated_pose is not None or not frame.dynamic]
    parts = tuple(name for name, frame in spec.frames.items() if frame.grasp is not None)
    for names, known, code, kind, path in (
        (written.calibrations, tuple(spec.calibrations), "unknown-calibration", "calibration", "calibrations"),
        (written.repeatability, tuple(spec.devices), "unknown-device", "device", "repeatability"),
        (written.loads, tuple(spec.devices), "unknown-device", "device", "loads"),
        (written.parts, parts, "unknown-frame", "frame with a grasp", "parts"),
        (written.tolerances, tuple(spec.motion.goals), "unknown-goal", "goal", "tolerances"),
    ):
        for name in names:
            if name not in known:
                yield unknown_name(code, name, kind, known, document, ("uncertainty", path, name))
    for name in spec.regions:
        if name not in places:
            kind = "fixed frame or object with a simulated pose"
            yield unknown_name("unknown-frame", name, kind, places, document, ("regions", name))


def _still(
    spec: CellSpec,
    written: UncertaintySpec,
    document: SourceDocument,
    machine: Machine,
    groups: Sequence[PlanningGroup],
) -> Iterator[Diagnostic]:
    """Yield devices whose repeatability would draw nothing: it is that of the tip of a group."""
    driven = {joint for group in groups for joint in group.joints}
    moved = [device.name for device in machine.devices if driven & {joint.name for joint in device.joints}]
    for name in written.repeatability:
        if name in spec.devices and name not in moved:
            path = ("uncertainty", "repeatability", name)
            yield Diagnostic(
                code="repeatability-of-nothing",
                severity=Severity.ERROR,
                message=f"`{name}` must be a device that a group moves; of another one no repeatability is drawn",
                span=document.locate_key(path),
                yaml_path=path,
                help=f"name one of: {', '.join(moved)}" if moved else "delete it; no group moves a device",
            )


def _confidence_alone(spec: CellSpec, document: SourceDocument) -> Iterator[Diagnostic]:
    """Yield what says how sure a verdict must be where none is asked for."""
    for name, rehearsal in spec.rehearsals.items():
        if rehearsal.confidence is not None and rehearsal.success is None:
            path = ("rehearsals", name, "confidence")
            yield Diagnostic(
                code="confidence-of-nothing",
                severity=Severity.ERROR,
                message=f"`{name}` must state `success` too; without it no verdict needs a confidence",
                span=document.locate_key(path),
                yaml_path=path,
                help="write the share of runs that must succeed, such as `success: 99 %`, or delete `confidence`",
            )
