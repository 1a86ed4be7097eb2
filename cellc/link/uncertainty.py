"""Binds what sweeps draw and judge to the calibrations, objects and goals of the cell."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.uncertainty import Region, Uncertainty
from cellc.diagnostics import Diagnostic, Outcome
from cellc.link.names import unknown_name
from cellc.link.quantities import si
from cellc.source.document import SourceDocument
from cellc.spec.cell_spec import CellSpec
from cellc.spec.uncertainty import RegionSpec, UncertaintySpec


def link_uncertainty(spec: CellSpec, document: SourceDocument) -> Outcome[Uncertainty | None]:
    """Bind the uncertainty of a cell; None where neither it nor a region nor a rate of success is stated."""
    wanted = any(one.success is not None for one in spec.rehearsals.values())
    if spec.uncertainty is None and not spec.regions and not wanted:
        return Outcome(None)
    written = spec.uncertainty or UncertaintySpec()
    rotations = {name: si(one.rotation) for name, one in written.calibrations.items()}
    bound = Uncertainty(
        rotations_rad={name: value for name, value in rotations.items() if value},
        regions={name: _region(region) for name, region in spec.regions.items()},
        repeatability_m={name: value.si for name, value in written.repeatability.items()},
        tolerances_m={name: value.si for name, value in written.tolerances.items()},
    )
    return Outcome(bound, tuple(_unknown(spec, written, document)))


def _region(written: RegionSpec) -> Region:
    x, y, z = (abs(edge) / 2.0 for edge in written.box.si)
    return Region(half_m=(x, y, z), half_yaw_rad=(si(written.yaw) or 0.0) / 2.0)


def _unknown(spec: CellSpec, written: UncertaintySpec, document: SourceDocument) -> Iterator[Diagnostic]:
    places = [name for name, frame in spec.frames.items() if frame.simulated_pose is not None or not frame.dynamic]
    for names, known, code, kind, path in (
        (written.calibrations, tuple(spec.calibrations), "unknown-calibration", "calibration", "calibrations"),
        (written.repeatability, tuple(spec.devices), "unknown-device", "device", "repeatability"),
        (written.tolerances, tuple(spec.motion.goals), "unknown-goal", "goal", "tolerances"),
    ):
        for name in names:
            if name not in known:
                yield unknown_name(code, name, kind, known, document, ("uncertainty", path, name))
    for name in spec.regions:
        if name not in places:
            kind = "fixed frame, or dynamic one with `simulated_pose`,"
            yield unknown_name("unknown-frame", name, kind, places, document, ("regions", name))
