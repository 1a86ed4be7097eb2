"""Where the joints of a device begin on the mock, held against the limits of its description as both are read."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.catalog.device_model import DeviceModel
from cellc.description.model import Description, JointLimit
from cellc.diagnostics import Diagnostic, Severity
from cellc.source.document import SourceDocument

_ROUNDING = 1e-9
"""By which a home may lie beyond a limit that was written with other digits, rad or m."""


def homes_outside_limits(
    model: DeviceModel, description: Description, document: SourceDocument
) -> Iterator[Diagnostic]:
    """Yield a finding for each joint whose home its limits do not hold: the mock would begin somewhere else."""
    for name, home in (model.home or {}).items():
        joint = description.joint(name)
        limit = None if joint is None or joint.type == "continuous" else joint.limit
        if limit is not None and not _holds(limit, home.si):
            path = ("home", name)
            yield Diagnostic(
                "catalogue-entry-invalid",
                Severity.ERROR,
                f"the home of `{name}` must lie from {_shown(limit.lower)} to {_shown(limit.upper)}, got {home.si:.6g}",
                document.locate(path),
                path,
                "put the home between the limits of the description",
            )


def _holds(limit: JointLimit, position: float) -> bool:
    above = limit.lower is None or position >= limit.lower - _ROUNDING
    return above and (limit.upper is None or position <= limit.upper + _ROUNDING)


def _shown(bound: float | None) -> str:
    return "any" if bound is None else f"{bound:.6g}"
