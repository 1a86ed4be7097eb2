"""What a comparison of commands with limits found."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class LimitExcess:
    """A command beyond a limit of the contract; rad or m and their derivatives by seconds."""

    controller: str
    joint: str
    quantity: str
    stamp_ns: int
    value: float
    limit: float

    def __str__(self) -> str:
        return (
            f"`{self.controller}` commanded joint `{self.joint}` to {self.quantity} {self.value:.6g} at "
            f"{self.stamp_ns / 1e9:.3f} s; its limit is {self.limit:.6g}"
        )


@dataclass(frozen=True, slots=True)
class CommandStep:
    """How far a command jumped where its controller was interrupted, rad or m."""

    controller: str
    joint: str
    cause: str
    stamp_ns: int
    step: float


@dataclass(frozen=True, slots=True)
class Peak:
    """The largest share of its limit that a quantity came to, 1 at the limit."""

    quantity: str
    share: float


@dataclass(frozen=True, slots=True)
class LimitsReport:
    """Limits of one run or of many.

    Attributes:
        peaks: by quantity, position left out.
        excesses: the worst of each controller and quantity of each run.
        steps: at interruptions, that of the joint which stepped farthest.
        held_outside: holds of a position that was itself measured outside the limits, as a displaced joint's is.
        unchecked: interfaces or quantities of joints that commands say nothing of.
    """

    peaks: tuple[Peak, ...] = ()
    excesses: tuple[LimitExcess, ...] = ()
    steps: tuple[CommandStep, ...] = ()
    held_outside: tuple[LimitExcess, ...] = ()
    unchecked: tuple[str, ...] = ()

    @property
    def held(self) -> bool:
        """Tell whether no limit was exceeded."""
        return not self.excesses


def merge(reports: Iterable[LimitsReport]) -> LimitsReport:
    """Return what several reports say together."""
    known = tuple(reports)
    shares: dict[str, float] = {}
    for peak in (peak for report in known for peak in report.peaks):
        shares[peak.quantity] = max(shares.get(peak.quantity, 0.0), peak.share)
    return LimitsReport(
        peaks=tuple(Peak(quantity, share) for quantity, share in shares.items()),
        excesses=tuple(excess for report in known for excess in report.excesses),
        steps=tuple(step for report in known for step in report.steps),
        held_outside=tuple(held for report in known for held in report.held_outside),
        unchecked=tuple(sorted({name for report in known for name in report.unchecked})),
    )
