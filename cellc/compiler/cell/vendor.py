"""What the vendor of a device says of the real one: its safety boundary, what people do at it, what it reports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Annotated

from cellc.compiler.cell.entity import ELSEWHERE, Part
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import GateCode, LeftBy, Moment, Need, RobotSetting


@dataclass(frozen=True, slots=True, kw_only=True)
class SafetyState:
    """A state of the device's safety controller, how it is noticed, and the gate that looks for it.

    Args:
        reported: how the driver reports it.
        seen: what people see at the device, where the driver does not report it.
        moment: the one whose effect says what the stop does.
        ends: what a claim needs and no longer has in this state, besides what that effect ends.
        left_by: what ends the stop once its cause is gone.
        trip: how people trip it while the device moves, from out of its reach; None where no source says.
    """

    name: str
    stops: bool
    reported: str | None
    gate: GateCode
    seen: str | None = None
    moment: Moment = Moment.STOP
    ends: tuple[Need, ...] = ()
    left_by: LeftBy = LeftBy.ACTIVATION
    trip: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class RecoveryProcedure:
    """The way out of one state: steps in order, the human ones first; ``by`` as of a step of commissioning."""

    state: str
    steps: tuple[str, ...]
    by: str | None


@dataclass(frozen=True, slots=True, kw_only=True)
class VendorSafety:
    """The vendor's safety boundary; no software of the cell is part of it.

    Args:
        stop_authority: what stops the device, by its vendor; None where no source says.
        topics: what says in which state the device is, where the cell has the controller that publishes it, each with
            the field that says it; the whole message where that is empty.
        stopping: which times and distances of a stop are published, and where; None where no public source has them.
        ending, ended: what people do at the device once nothing is claimed, before and after its driver ends.
        power_off: what they do after a loss that leaves its drives powered.
    """

    stop_authority: str | None = None
    states: tuple[SafetyState, ...] = ()
    topics: tuple[tuple[str, str], ...] = ()
    ending: tuple[str, ...] = ()
    ended: tuple[str, ...] = ()
    power_off: tuple[str, ...] = ()
    modes: tuple[str, ...] = ()
    recovery: tuple[RecoveryProcedure, ...] = ()
    watchdog: str | None = None
    stopping: tuple[str, str] | None = None

    @property
    def recoverable_stops(self) -> tuple[str, ...]:
        """The states that stop the device and that its vendor tells the way out of."""
        led_out = {way.state for way in self.recovery}
        return tuple(state.name for state in self.states if state.stops and state.name in led_out)


@dataclass(frozen=True, slots=True, kw_only=True)
class CommissioningStep:
    """What a person does at the real device in a gate, by its vendor's procedure.

    ``after_release`` where it comes once the release of that gate has been made, ``powers`` where drives have power by
    it, so that the stop can be tried, ``moves`` where a program of the vendor moves the device. ``sets`` is what it
    sets in the robot. ``log`` where it is in the driver's log: what the lines hold of which the newest counts. ``run``
    are commands that read; ``{address}`` in them is that of the device. ``by`` is the ``driver`` or the
    ``adapter`` where it belongs to one of both alone.
    """

    gate: GateCode
    does: str
    after_release: bool
    powers: bool
    moves: bool
    sets: RobotSetting | None
    log: tuple[str, ...]
    run: tuple[str, ...]
    by: str | None


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordSource:
    """Where the record of an attempt has a field from: a topic of a kind of controller, or what a person reads.

    Args:
        attempt_field: the field of the record.
        controller_kind, topic, field: the controller of the device, the name below its node, the part of the message.
        read: where a person reads it, where no topic has it.
    """

    attempt_field: str
    controller_kind: str | None
    topic: str | None
    field: str | None
    read: str | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Reading:
    """What the running device says of itself, by a topic or a service without an argument.

    Args:
        name: what it is.
        controller_kind, below: the controller of the device, and the name of topic or service below its node.
        fields: of message or answer, joined by dots.
        values: by name; empty for a figure.
        expected: names of which one must show, by the gate from which on it must.
        version: the part of the version tuple that must be the value.
    """

    name: str
    controller_kind: str
    below: str
    fields: tuple[str, ...]
    values: Mapping[str, bool | int]
    expected: Mapping[GateCode, tuple[str, ...]]
    version: str | None


@dataclass(frozen=True, slots=True, kw_only=True)
class SpeedControl:
    """What slows every motion of a device down: its ``name``, how it is set, and the share for first motions.

    Where the device has none, ``name`` is empty, ``low`` is 1, and ``does`` says why.
    """

    name: str
    does: str
    low: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Procedures(Part):
    """What people do and read at the real device, by its vendor.

    Args:
        record: where the record of an attempt has fields from that the real one alone can tell.
        readings: what its topics and services report.
        jog: how people move one joint by hand; None where no source says.
        jog_begins, jog_ends: what they do before it, and then, before the driver is started again.
        driver_runs: the driver reads positions meanwhile.
        speed_control: None where no source says whether there is one.
        payload_entry: how people enter the payload of the spec; empty where no source says.
        rotation_vector: the robot shows orientations as rotation vectors.
        commissioning: steps in the vendor's order.
    """

    safety: Annotated[VendorSafety, ELSEWHERE] = field(default_factory=VendorSafety)
    record: Annotated[tuple[RecordSource, ...], ELSEWHERE] = ()
    readings: Annotated[tuple[Reading, ...], ELSEWHERE] = ()
    jog: str | None = None
    jog_begins: Annotated[str, ELSEWHERE] = ""
    jog_ends: Annotated[str, ELSEWHERE] = ""
    driver_runs: bool = True
    speed_control: Annotated[SpeedControl | None, ELSEWHERE] = None
    payload_entry: Annotated[str, ELSEWHERE] = ""
    rotation_vector: Annotated[bool, ELSEWHERE] = False
    commissioning: Annotated[tuple[CommissioningStep, ...], ELSEWHERE] = ()
