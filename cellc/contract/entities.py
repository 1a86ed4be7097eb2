"""Entities that are equal on both sides: linked from a spec, checked by rules, written to and read from contract.json.

What a file leaves out is stated in the annotation, so that only a reader of files has it as a default.
"""

from __future__ import annotations

from dataclasses import fields
from typing import Annotated, ClassVar, Literal

from pydantic import ConfigDict, Field

from cellc.contract.frozen import dataclass
from cellc.contract.grading import LONGER, STALE, UNSEEN, Graded, Rule
from cellc.contract.quantities import Count, PositiveSeconds, Rate, Seconds, Share
from cellc.contract.vocabulary import InterfaceKind, ReviewArea

Target = Literal["mock", "real"]
TARGETS: tuple[Target, ...] = ("mock", "real")
"""Every cell has them."""

LaunchTarget = Literal["mock", "sim", "real"]
"""What the launch files start: a simulator where the spec asks for one."""
"""What the hardware interfaces of a cell reach."""
HardwareState = Literal["unconfigured", "inactive", "active"]
"""A state of a hardware component of ros2_control."""
Reliability = Literal["reliable", "best_effort"]
Durability = Literal["volatile", "transient_local"]

_READ = ConfigDict(extra="forbid", allow_inf_nan=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Qos:
    """A resolved profile; null durations are infinite."""

    __pydantic_config__: ClassVar[ConfigDict] = _READ

    reliability: Annotated[Reliability, Field(description="Every sample, or what arrives.")]
    durability: Annotated[Durability, Field(description="Whether a late joiner gets history.")]
    history: Annotated[Literal["keep_last", "keep_all"], Field(default="keep_last", description="What is queued.")]
    depth: Annotated[Count, Field(description="Queue length of keep_last.")]
    deadline_s: Annotated[Seconds | None, Field(default=None, description="Longest time between samples.")]
    lifespan_s: Annotated[Seconds | None, Field(default=None, description="Age at which a sample is dropped.")]
    liveliness: Annotated[
        Literal["automatic", "manual_by_topic"],
        Field(default="automatic", description="Who asserts that the publisher lives."),
    ]
    lease_duration_s: Annotated[Seconds | None, Field(default=None, description="Bound of the assertion.")]


@dataclass(frozen=True, slots=True, kw_only=True)
class Processing:
    """What a node executes for each sample of a topic."""

    __pydantic_config__: ClassVar[ConfigDict] = _READ

    line: Annotated[str, Field(description="What executes one after the other has one name; empty for none.")]
    takes_s: Annotated[Seconds, Field(description="Longest time that it executes.")]


@dataclass(frozen=True, kw_only=True)
class ContractEndpoint:
    """One end of an interface."""

    __pydantic_config__: ClassVar[ConfigDict] = _READ

    node: Annotated[str, Field(description="Name of the node, controller or device, which no other end has.")]
    full_name: Annotated[
        str,
        Field(description="Fully qualified name of the node in the ROS graph."),
        Graded(ReviewArea.INTERFACES, "name of the node"),
    ]
    targets: Annotated[
        tuple[Target, ...],
        Field(description="Targets on which it is present."),
        Graded(ReviewArea.INTERFACES, ordered=False),
    ] = TARGETS
    qos: Annotated[Qos, Field(description="Its profile."), Graded(ReviewArea.QOS, "quality of service")]
    processing: Annotated[
        Processing | None,
        Field(description="What it executes for each sample; null where that is not stated."),
        Graded(ReviewArea.TIME, "execution for each sample"),
    ] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class SimulatedNetwork:
    """What the mock's network does to each sample of a topic."""

    __pydantic_config__: ClassVar[ConfigDict] = _READ

    latency_s: Annotated[Seconds, Field(description="Shortest time from publishing to arrival.")] = 0.0
    jitter_s: Annotated[Seconds, Field(description="Up to so much more.")] = 0.0
    loss: Annotated[Share, Field(description="Share of samples lost on their way, 0 to 1.")] = 0.0
    reordering: Annotated[Share, Field(description="Share of samples overtaken by the next one, 0 to 1.")] = 0.0


@dataclass(frozen=True, kw_only=True)
class ContractInterface:
    """A topic, service or action with what its users may rely on."""

    __pydantic_config__: ClassVar[ConfigDict] = _READ

    kind: Annotated[
        InterfaceKind,
        Field(description="Kind of exchange."),
        Graded(ReviewArea.INTERFACES, rule=Rule.DANGEROUS, breaking=True),
    ]
    type: Annotated[
        str, Field(description="ROS type."), Graded(ReviewArea.INTERFACES, rule=Rule.DANGEROUS, breaking=True)
    ]
    sources: Annotated[tuple[ContractEndpoint, ...], Field(description="Publishers, or the server.")]
    sinks: Annotated[tuple[ContractEndpoint, ...], Field(default=(), description="Subscribers, or the clients.")]
    frame: Annotated[
        str | None,
        Field(description="Frame of the payload."),
        Graded(ReviewArea.INTERFACES, "frame of the payload", Rule.DANGEROUS, breaking=True),
    ] = None
    unit: Annotated[
        str | None,
        Field(description="Unit of the payload."),
        Graded(ReviewArea.INTERFACES, "unit of the payload", Rule.DANGEROUS, breaking=True),
    ] = None
    time_source: Annotated[
        str | None, Field(description="Clock of the stamps."), Graded(ReviewArea.TIME, "clock of the stamps")
    ] = None
    owner: Annotated[
        str | None,
        Field(description="Person or role responsible for it."),
        Graded(ReviewArea.OWNERS, rule=Rule.NAMED),
    ] = None
    wants: Annotated[
        str | None,
        Field(description="What the consumer needs: newest or every_sample."),
        Graded(ReviewArea.INTERFACES, "need of the consumer"),
    ] = None
    rate_hz: Annotated[Rate | None, Field(description="Publishing rate."), Graded(ReviewArea.INTERFACES)] = None
    max_age_s: Annotated[
        Seconds | None,
        Field(description="Oldest sample that may be used."),
        Graded(ReviewArea.TIME, "oldest sample that may be used", Rule.LOOSER, why=STALE),
    ] = None
    transport_s: Annotated[
        Seconds | None,
        Field(description="Budget from publishing to use."),
        Graded(ReviewArea.TIME, "budget of the transport"),
    ] = None
    on_stale: Annotated[
        str | None,
        Field(description="What happens on an older sample."),
        Graded(ReviewArea.TIME, "action on an older sample", Rule.DANGEROUS),
    ] = None
    timeout_s: Annotated[
        PositiveSeconds | None,
        Field(description="Bound of a response or a whole goal."),
        Graded(ReviewArea.INTERFACES, rule=Rule.LOOSER, why=UNSEEN),
    ] = None
    on_timeout: Annotated[
        str | None,
        Field(description="What the client does then."),
        Graded(ReviewArea.INTERFACES, "action on a timeout", Rule.DANGEROUS),
    ] = None
    on_error: Annotated[
        str | None,
        Field(description="How an error is reported."),
        Graded(ReviewArea.INTERFACES, "error reporting"),
    ] = None
    cancel_within_s: Annotated[
        Seconds | None,
        Field(description="Bound from cancel to hold."),
        Graded(ReviewArea.INTERFACES, "time from cancel to hold", Rule.LOOSER, why=LONGER, asks=("controller",)),
    ] = None
    simulated: Annotated[
        SimulatedNetwork | None,
        Field(description="How the mock carries it; null for no delay."),
        Graded(ReviewArea.REHEARSALS, "transport on the mock"),
    ] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Kpis:
    """Targets; null where none was set."""

    __pydantic_config__: ClassVar[ConfigDict] = _READ

    plan_to_execute_s: Annotated[Seconds | None, Field(description="Longest time from plan to execution.")] = None
    cancel_s: Annotated[Seconds | None, Field(description="Longest time from cancel to hold.")] = None
    missed_cycles: Annotated[Count | None, Field(description="Missed cycles allowed in a run.")] = None
    stale_state_rejection: Annotated[Share | None, Field(description="Share of stale samples rejected, 0 to 1.")] = None
    protective_stops: Annotated[Count | None, Field(description="Protective stops allowed in a shift.")] = None
    recovery_time_s: Annotated[Seconds | None, Field(description="Longest time from stop to ready.")] = None
    wrong_owner_events: Annotated[Count | None, Field(description="Commands of a wrong owner allowed.")] = None

    def without_target(self) -> tuple[str, ...]:
        """Name the figures without a target by their keys in the spec."""
        return tuple(field.name.removesuffix("_s") for field in fields(self) if getattr(self, field.name) is None)
