"""Why a transform could not be looked up; texts in the words of tf2, so that a log reads the same as on the robot."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class TfFailureKind(str, Enum):
    """The exceptions of tf2; ExtrapolationException is told apart by what was asked of the buffer."""

    INVALID_ARGUMENT = "invalid_argument"  # InvalidArgumentException: no frame can have this name
    LOOKUP = "lookup"  # LookupException: a frame that nobody has ever published
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
    """Return the failure of a lookup in a tree that is none."""
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
