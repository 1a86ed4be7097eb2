"""Why a transform could not be looked up; texts in the words of tf2, so that a log reads the same as on the robot."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class TfFailureKind(str, Enum):
    """The exceptions of tf2, and a buffer that has nothing yet."""

    LOOKUP = "lookup"  # a frame that nobody has ever published
    CONNECTIVITY = "connectivity"  # no chain of published edges between the frames
    EXTRAPOLATION_PAST = "extrapolation_into_the_past"
    EXTRAPOLATION_FUTURE = "extrapolation_into_the_future"


@dataclass(frozen=True, slots=True)
class TfFailure:
    """A failed lookup; a future stamp may still be answered a moment later, the others will not."""

    kind: TfFailureKind
    text: str


def unknown_frame(argument: str, frame: str) -> TfFailure:
    """Return the failure of a lookup that names a frame without any data."""
    return TfFailure(TfFailureKind.LOOKUP, f'"{frame}" passed to lookupTransform argument {argument} does not exist. ')


def not_connected(target: str, source: str) -> TfFailure:
    """Return the failure of a lookup between two trees."""
    return TfFailure(
        TfFailureKind.CONNECTIVITY,
        f"Could not find a connection between '{target}' and '{source}' because they are not part of the same tree."
        "Tf has two or more unconnected trees.",
    )


def extrapolation(kind: TfFailureKind, requested_ns: int, limit_ns: int, target: str, source: str) -> TfFailure:
    """Return the failure of a lookup outside the buffered time; ``limit_ns`` is the nearest buffered stamp."""
    if kind is TfFailureKind.EXTRAPOLATION_FUTURE:
        where, which = "into the future", "latest"
    else:
        where, which = "into the past", "earliest"
    return TfFailure(
        kind,
        f"Lookup would require extrapolation {where}.  Requested time {_seconds(requested_ns)} but the {which} data is "
        f"at time {_seconds(limit_ns)}, when looking up transform from frame [{source}] to frame [{target}]",
    )


def _seconds(stamp_ns: int) -> str:
    return f"{stamp_ns // 1_000_000_000}.{stamp_ns % 1_000_000_000 // 1000:06d}"
