"""What a listener writes to its log about the transforms it hears, in the words of tf2."""

from __future__ import annotations

import math

from cellc.mock.tf.failure import in_seconds
from cellc.transforms import Pose

QUATERNION_TOLERANCE = 10e-3
"""tf2 QUATERNION_NORMALIZATION_TOLERANCE, on the squared length."""


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
        """Return the lines in the order in which they came first, with how often where that is more than once."""
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
