"""What surrounds the devices of a cell: computers, network, versions, owners, safety, bring-up, figures, records."""

from __future__ import annotations

import datetime
from collections.abc import Mapping
from dataclasses import field
from typing import Annotated

from cellc.compiler.cell.entity import Entity
from cellc.contract.frozen import dataclass
from cellc.contract.grading import Graded, Rule
from cellc.contract.stated import Stop
from cellc.contract.vocabulary import NETWORK_GATES, PROMOTION_GATES, UNKNOWN, ReviewArea

ATTEMPT_FIELDS = (
    "attempt_id",
    "version_tuple",
    "calibration_id",
    "goal_frame",
    "goal_stamp",
    "joint_state_age",
    "tf_lookup_age",
    "plan_result",
    "controller_name",
    "action_goal_id",
    "speed_scaling",
    "safety_state",
    "fault_code",
    "cancel/result",
    "operator_intervention",
)
"""What every attempt records where the spec says ``standard``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Clock:
    """A clock with its bound to the others; the mock gives it ``simulated_offset_s`` and ``simulated_drift`` in s/s."""

    domain: str = "ros"
    synchronized_by: str | None = None
    max_offset_s: float | None = None
    simulated_offset_s: float = 0.0
    simulated_drift: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class NetworkCard:
    """A card of a host: ``address`` with prefix length as written, ``interface`` as the operating system names it.

    ``speed_bps`` is that of its link in bit/s, None where it is not stated.
    """

    address: str
    interface: str | None = None
    speed_bps: float | None = None
    carries: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Host(Entity):
    """A computer; ``scheduling`` is the preemption model of its kernel, ``nics`` are its cards by name."""

    scheduling: str = UNKNOWN
    clock: Clock = field(default_factory=Clock)
    nics: Mapping[str, NetworkCard]


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibrationFile:
    """What a calibration tool wrote: its path from the spec's folder, and the hash of its bytes."""

    path: str
    sha256: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Calibration(Entity):
    """A measurement that transforms rest on: ``measured`` as written, ``measured_on`` where that is a date.

    ``file`` is what the transforms are taken from; None where the spec states them. ``serials`` are the serial numbers
    of the devices that were measured, by the names of these.
    """

    revision: int
    measured: str
    measured_on: datetime.date | None
    method: str
    samples: int | None
    residual_m: float | None
    owner: str
    serials: Mapping[str, str] = field(default_factory=dict)
    file: CalibrationFile | None


STOPPED = ("protective_stop", "emergency_stop", "fault")
"""What every robot can be stopped by; others are its vendor's."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Recovery:
    """The states that need recovery, who acknowledges, and what becomes of an old goal."""

    states: tuple[str, ...] = STOPPED
    acknowledge: str = "operator"
    on_reconnect: str = "discard_goal"
    owner: str = UNKNOWN
    observer: str = UNKNOWN


@dataclass(frozen=True, slots=True, kw_only=True)
class RiskAssessment:
    """What the risk assessment allows, m/s, m and N; None of what it does not state."""

    document: str
    velocity: float | None
    reach: float | None
    force: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Safety:
    """The safety boundary, which cellc names and never implements."""

    stop: Annotated[Stop, Graded(ReviewArea.SAFETY, "the stop", Rule.DANGEROUS, ordered=False)] = field(
        default_factory=Stop
    )
    recovery: Annotated[Recovery, Graded(ReviewArea.SAFETY, rule=Rule.DANGEROUS, ordered=False)] = field(
        default_factory=Recovery
    )
    risk_assessment: Annotated[
        RiskAssessment | None, Graded(ReviewArea.SAFETY, "what the risk assessment allows", Rule.DANGEROUS)
    ] = None


@dataclass(frozen=True, slots=True)
class JointFigure:
    """A position or speed of some joint: rad or rad/s, or m or m/s where the user wrote a length (``linear``)."""

    value: float
    linear: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class FirstMotion(Entity):
    """Small moves of gates G6 and G7; ``name`` is that of the first joint, as ``device/joint``."""

    direction: str
    max_delta: JointFigure
    velocity: JointFigure
    timeout_s: float
    stop_if: tuple[str, ...]

    @property
    def device(self) -> str:
        """The device that moves."""
        return self.name.partition("/")[0]

    @property
    def local_joint(self) -> str:
        """The joint without its device."""
        return self.name.partition("/")[2]


@dataclass(frozen=True, slots=True, kw_only=True)
class Commissioning:
    """Caps of planned motion.

    Args:
        velocity, acceleration: shares of the limits of every joint, 1 where the spec states a speed of the tip instead.
        tip_speed: what no path may give the tip of a group, m/s; None where a share is stated.
        reach: largest distance of a tip from the base of its group, m.
        force: largest grip force, N.
        stages: shares of velocity and acceleration, in order.
    """

    velocity: float
    acceleration: float
    tip_speed: float | None = None
    reach: float | None = None
    force: float | None = None
    stages: tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Bringup:
    """The gates by name, in order, the first motion of each device that has one, and the caps of planned motion."""

    gates: Annotated[tuple[str, ...], Graded(ReviewArea.GATES, rule=Rule.LOST)] = (*PROMOTION_GATES, *NETWORK_GATES)
    first_motions: tuple[FirstMotion, ...] = ()
    caps: Commissioning | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Recording:
    """What every attempt leaves behind; ``topics`` are those beyond the motion path."""

    attempt_fields: tuple[str, ...] = ATTEMPT_FIELDS
    topics: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Target:
    """What a target runs on: ``hardware`` is mock, sim or real, ``clock`` wall or sim."""

    hardware: str
    clock: str


TARGET_DEFAULTS: Mapping[str, Target] = {
    "mock": Target(hardware="mock", clock="wall"),
    "real": Target(hardware="real", clock="wall"),
}
"""The targets of every cell where the spec says nothing of them."""
