"""In the words of tf2: why a lookup fails, and what a listener logs, so that a log reads as on the robot."""

from __future__ import annotations

import math
from enum import Enum

from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose

QUATERNION_TOLERANCE = 10e-3
"""tf2 QUATERNION_NORMALIZATION_TOLERANCE, on the squared length."""


class TfFailureKind(str, Enum):
    """The exceptions of tf2; ExtrapolationException is distinguished by what was asked of the buffer."""

    INVALID_ARGUMENT = "invalid_argument"  # InvalidArgumentException: no frame can have this name
    LOOKUP = "lookup"  # LookupException: a frame that was never published
    CONNECTIVITY = "connectivity"  # ConnectivityException: no chain of published edges between the frames
    EXTRAPOLATION_PAST = "extrapolation_into_the_past"
    EXTRAPOLATION_FUTURE = "extrapolation_into_the_future"
    EXTRAPOLATION_ONE_SAMPLE = "extrapolation_of_one_sample"
    EXTRAPOLATION_NO_DATA = "extrapolation_without_data"  # the edge is known, and its history was cleared

    @property
    def may_pass(self) -> bool:
        """Tell whether the next transforms may answer: a lookup with a timeout waits for them."""
        return self in (
            TfFailureKind.EXTRAPOLATION_FUTURE,
            TfFailureKind.EXTRAPOLATION_ONE_SAMPLE,
            TfFailureKind.EXTRAPOLATION_NO_DATA,
        )


@dataclass(frozen=True, slots=True)
class TfFailure:
    """A failed lookup."""

    kind: TfFailureKind
    text: str


@dataclass(frozen=True, slots=True)
class Outside:
    """A stamp that one edge has no transform for; the text is that of tf2's time cache, empty without any data."""

    kind: TfFailureKind
    text: str

    def between(self, target: str, source: str) -> TfFailure:
        """Return the failure of the lookup that needed the edge."""
        return TfFailure(self.kind, f"{self.text}, when looking up transform from frame [{source}] to frame [{target}]")


def refused_name(argument: str, frame: str) -> TfFailure | None:
    """Return the failure of a lookup that names what no frame can be called; None where the name is possible."""
    if frame and not frame.startswith("/"):
        return None
    reason = "cannot start with a '/'" if frame else "cannot be empty"
    text = f'Invalid argument "{frame}" passed to lookupTransform argument {argument} - in tf2 frame_ids {reason}'
    return TfFailure(TfFailureKind.INVALID_ARGUMENT, text)


def unknown_frame(argument: str, frame: str) -> TfFailure:
    """Return the failure of a lookup that names a frame without any data."""
    return TfFailure(TfFailureKind.LOOKUP, f'"{frame}" passed to lookupTransform argument {argument} does not exist. ')


def loop() -> TfFailure:
    """Return the failure of a lookup in a TF graph with a loop."""
    return TfFailure(TfFailureKind.LOOKUP, "The tf tree is invalid because it contains a loop.")


def not_connected(target: str, source: str) -> TfFailure:
    """Return the failure of a lookup between two trees."""
    return TfFailure(
        TfFailureKind.CONNECTIVITY,
        f"Could not find a connection between '{target}' and '{source}' because they are not part of the same tree."
        "Tf has two or more unconnected trees.",
    )


def no_data() -> Outside:
    """Return what an edge without any stored transform answers."""
    return Outside(TfFailureKind.EXTRAPOLATION_NO_DATA, "")


def one_sample(requested_ns: int, only_ns: int) -> Outside:
    """Return what an edge answers that has one transform of another stamp."""
    return Outside(
        TfFailureKind.EXTRAPOLATION_ONE_SAMPLE,
        f"Lookup would require extrapolation at time {in_seconds(requested_ns)}, but only time {in_seconds(only_ns)} "
        "is in the buffer",
    )


def into_the_future(requested_ns: int, latest_ns: int) -> Outside:
    """Return what an edge answers to a stamp after its newest transform."""
    return Outside(
        TfFailureKind.EXTRAPOLATION_FUTURE,
        f"Lookup would require extrapolation into the future.  Requested time {in_seconds(requested_ns)} but the "
        f"latest data is at time {in_seconds(latest_ns)}",
    )


def into_the_past(requested_ns: int, earliest_ns: int) -> Outside:
    """Return what an edge answers to a stamp before its oldest transform."""
    return Outside(
        TfFailureKind.EXTRAPOLATION_PAST,
        f"Lookup would require extrapolation into the past.  Requested time {in_seconds(requested_ns)} but the "
        f"earliest data is at time {in_seconds(earliest_ns)}",
    )


def in_seconds(stamp_ns: int) -> str:
    """Return a stamp as tf2 prints it: seconds with six digits after the point, rounded."""
    return f"{stamp_ns // 1_000_000_000 + 1e-9 * (stamp_ns % 1_000_000_000):.6f}"


class TfWarnings:
    """Log lines by what they complain of: each first line is kept, and the rest are counted."""

    def __init__(self) -> None:
        self._lines: dict[tuple[str, str, str], str] = {}
        self._counts: dict[tuple[str, str, str], int] = {}

    def note(self, kind: str, frame: str, authority: str, text: str) -> None:
        """Note a line; further ones of the same kind on a frame of an authority only count."""
        key = (kind, frame, authority)
        self._lines.setdefault(key, text)
        self._counts[key] = self._counts.get(key, 0) + 1

    def lines(self) -> tuple[str, ...]:
        """Return the lines in the order of their first occurrence, with how often where that is more than once."""
        return tuple(
            text if self._counts[key] == 1 else f"{text} ({self._counts[key]} times)"
            for key, text in self._lines.items()
        )

    def old_data(self, frame: str, authority: str, stamp_ns: int) -> None:
        """Note a transform older than the buffer's length before the newest one."""
        text = (
            f"TF_OLD_DATA ignoring data from the past for frame {frame} at time {in_seconds(stamp_ns)} "
            f"according to authority {authority}"
        )
        self.note("TF_OLD_DATA", frame, authority, text)

    def cleared(self, reason: str, authority: str) -> None:
        """Note that the buffer was emptied."""
        self.note("cleared", "", f"{authority} {reason}", f"{reason} Clearing TF buffer.")


def refusal(parent: str, child: str, authority: str, pose: Pose) -> tuple[str, str] | None:
    """Return the kind and text with which tf2 refuses a transform; None for one that it stores."""
    x, y, z = pose.position
    excess = abs(sum(part * part for part in pose.quaternion) - 1.0)
    if parent and child and parent != child and excess < QUATERNION_TOLERANCE and not math.isnan(x + y + z):
        return None
    return _reason(parent, child, authority, pose, excess)


def _reason(parent: str, child: str, authority: str, pose: Pose, excess: float) -> tuple[str, str] | None:
    numbers = (*pose.position, *pose.quaternion)
    if parent == child:
        return "TF_SELF_TRANSFORM", (
            f'TF_SELF_TRANSFORM: Ignoring transform from authority "{authority}" with frame_id and  child_frame_id '
            f'"{child}" because they are the same'
        )
    if not child:
        return "TF_NO_CHILD_FRAME_ID", (
            f'TF_NO_CHILD_FRAME_ID: Ignoring transform from authority "{authority}" because child_frame_id not set '
        )
    if not parent:
        return "TF_NO_FRAME_ID", (
            f'TF_NO_FRAME_ID: Ignoring transform with child_frame_id "{child}"  from authority "{authority}" '
            "because frame_id not set"
        )
    if any(math.isnan(number) for number in numbers):
        values = "({} {} {}) ({} {} {} {})".format(*(f"{number:f}" for number in numbers))
        return "TF_NAN_INPUT", (
            f'TF_NAN_INPUT: Ignoring transform for child_frame_id "{child}" from authority "{authority}" because '
            f"of a nan value in the transform {values}"
        )
    if excess >= QUATERNION_TOLERANCE:
        values = " ".join(f"{part:f}" for part in pose.quaternion)
        return "TF_DENORMALIZED_QUATERNION", (
            f'TF_DENORMALIZED_QUATERNION: Ignoring transform for child_frame_id "{child}" from authority "{authority}" '
            f"because of an invalid quaternion in the transform ({values})"
        )
    return None
