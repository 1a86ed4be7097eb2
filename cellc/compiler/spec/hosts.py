"""The pinned version tuple, the computers and the network."""

from typing import Literal

from pydantic import Field

from cellc.compiler.spec.base import Name, Pin, SpecModel, Text
from cellc.compiler.spec.quantity import DataRate, Drift, Duration, TimeShift
from cellc.contract.vocabulary import UNKNOWN


class RollbackSpec(SpecModel):
    """What to go back to when a new configuration fails."""

    image: Pin = Field(UNKNOWN, description="Digest of the last workstation image that ran.", examples=["sha256:9f2c"])
    configuration: Pin = Field(
        UNKNOWN, description="Configuration id of the last cell that ran.", examples=["cfg-4d1e0a77b2c9"]
    )


class VersionsSpec(SpecModel):
    """The pinned tuple. UNKNOWN is a legal answer; it blocks the real target and is listed in the audit."""

    os: Pin = Field(UNKNOWN, description="Operating system and release.", examples=["ubuntu 24.04"])
    kernel: Pin = Field(
        UNKNOWN, description="Kernel release as `uname -r` prints it.", examples=["6.8.1-1015-realtime"]
    )
    ros: Pin = Field(..., description="ROS 2 distribution: humble, jazzy, kilted or lyrical.", examples=["jazzy"])
    rmw: Pin = Field(UNKNOWN, description="RMW implementation and its version.", examples=["rmw_fastrtps_cpp 8.4.4"])
    ros2_control: Pin = Field(UNKNOWN, description="Version of ros2_control.", examples=["4.47.0"])
    moveit: Pin = Field(UNKNOWN, description="Version of MoveIt 2.", examples=["2.12.4"])
    rollback: RollbackSpec = Field(
        default_factory=RollbackSpec,
        description="Image and configuration to go back to.",
        examples=[{"image": "sha256:9f2c", "configuration": "cfg-4d1e0a77b2c9"}],
    )


Traffic = Literal["control", "camera", "bag", "ros", "internet"]


class NicSpec(SpecModel):
    """One network card of a host."""

    address: Text = Field(..., description="IPv4 address with prefix length.", examples=["192.168.56.10/24"])
    interface: Text | None = Field(None, description="Name the operating system gives the card.", examples=["enp3s0"])
    speed: DataRate | None = Field(
        None, description="Speed of its link; 1 Gbit/s is assumed if absent.", examples=["1 Gbit/s"]
    )
    carries: tuple[Traffic, ...] = Field(
        (), description="Kinds of traffic on this card; `control` shares a card with nothing.", examples=[["control"]]
    )


class ClockSpec(SpecModel):
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


class HostSpec(SpecModel):
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


class DiscoveryServerSpec(SpecModel):
    """A discovery server of Fast DDS, which every node of the cell asks who else is there."""

    host: Name = Field(..., description="The host that it runs on.", examples=["control_pc"])
    nic: Name | None = Field(
        None, description="The card that it listens on; the first that carries no control if absent.", examples=["cell"]
    )
    port: int = Field(11811, ge=1024, le=65535, description="The UDP port that it listens on.", examples=[11811])


class NetworkSpec(SpecModel):
    """How the nodes of the cell find each other."""

    domain_id: int = Field(0, description="ROS_DOMAIN_ID; 0 to 101 are safe on every platform.", examples=[42])
    discovery: Literal["multicast", "unicast", "server", "localhost", "off"] = Field(
        "multicast", description="Discovery of participants.", examples=["unicast"]
    )
    peers: tuple[Text, ...] = Field(
        (), description="Static peers of unicast discovery; hosts of the cell are added.", examples=[["10.10.0.11"]]
    )
    servers: tuple[DiscoveryServerSpec, ...] = Field(
        (),
        description="Discovery servers of `discovery: server`; each node asks all of them.",
        examples=[[{"host": "control_pc"}]],
    )
