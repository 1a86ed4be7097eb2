"""The pinned version tuple, the computers and the network."""

from typing import Literal

from pydantic import Field

from cellc.compiler.spec.quantity import DataRate, Drift, Duration, TimeShift
from cellc.contract.stated import Name, StatedModel, Text
from cellc.contract.vocabulary import UNKNOWN

Traffic = Literal["control", "camera", "bag", "ros", "internet"]


class NicSpec(StatedModel):
    """One network card of a host."""

    address: Text = Field(..., description="IPv4 address with prefix length.", examples=["192.168.56.10/24"])
    interface: Text | None = Field(None, description="Name the operating system gives the card.", examples=["enp3s0"])
    speed: DataRate | None = Field(
        None, description="Speed of its link; 1 Gbit/s is assumed if absent.", examples=["1 Gbit/s"]
    )
    carries: tuple[Traffic, ...] = Field(
        (), description="Kinds of traffic on this card; `control` shares a card with nothing.", examples=[["control"]]
    )


class ClockSpec(StatedModel):
    """The clock of a host and the bound that keeps it near the others."""

    domain: Text = Field("ros", description="Clock domain that the host's stamps belong to.", examples=["ros"])
    synchronized_by: Text | None = Field(None, description="What disciplines the clock.", examples=["chrony"])
    max_offset: Duration | None = Field(None, description="Bound of the offset to the other hosts.", examples=["1 ms"])
    simulated_offset: TimeShift | None = Field(
        None, description="Offset that the mock gives this clock; none if absent.", examples=["0.5 ms"]
    )
    simulated_drift: Drift | None = Field(
        None, description="Drift that the mock gives this clock, up to `max_offset`.", examples=["20 ppm"]
    )


class HostSpec(StatedModel):
    """A computer of the cell."""

    scheduling: Literal["preempt_rt", "lowlatency", "generic", "UNKNOWN"] = Field(
        UNKNOWN, description="Preemption model of the kernel.", examples=["preempt_rt"]
    )
    clock: ClockSpec = Field(
        default_factory=ClockSpec,
        description="Clock domain and synchronization.",
        examples=[{"domain": "ros", "synchronized_by": "chrony", "max_offset": "1 ms"}],
    )
    nics: dict[Name, NicSpec] = Field(
        default_factory=dict,
        description="Network cards by the name used in `connection`.",
        examples=[{"robot": {"address": "192.168.56.10/24", "carries": ["control"]}}],
    )
