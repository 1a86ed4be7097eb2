"""``config/observe.json``: what must run on each target, for the program that compares it with the running graph.

Types, QoS, rates and ages are in ``contract.json``; values of parameters in their files.
"""

from __future__ import annotations

from pydantic import Field

from cellc.contract.base import ContractModel
from cellc.contract.bring_up import ManagedState
from cellc.contract.entities import HardwareState
from cellc.contract.vocabulary import UNKNOWN


class ObservedEnds(ContractModel):
    """Both sides of an interface: full name of a node → gate that starts it, empty where the first launch does."""

    sources: dict[str, str] = Field(description="Publishers or servers.")
    sinks: dict[str, str] = Field(description="Subscribers or clients.")


class ObservedManager(ContractModel):
    """Components and controllers before a person releases a claim; on the mock after all steps of the bring-up."""

    hardware: dict[str, HardwareState] = Field(description="State of each hardware component.")
    controllers: dict[str, ManagedState] = Field(description="State of each controller.")
    reports: bool = Field(False, description="Its release publishes what its cycles took, and diagnostics of them.")


class ObservedReading(ContractModel):
    """What a device says of itself, by a topic or by a service without an argument."""

    name: str = Field(description="What it is.")
    device: str = Field(description="Of which device.")
    interface: str = Field(description="Full name of the topic or the service.")
    fields: tuple[str, ...] = Field(description="Fields of message or answer, joined by dots.")
    values: dict[str, bool | int] = Field(default_factory=dict, description="Values by name; none for a figure.")
    expected: dict[str, tuple[str, ...]] = Field(
        default_factory=dict, description="Names of which one must show, by the gate from which on it must."
    )
    version: str | None = Field(None, description="The part of the version tuple that must be the value.")


class ObservedTarget(ContractModel):
    """What runs on a target."""

    nodes: tuple[str, ...] = Field(description="Full names of all nodes, those that a later gate starts among them.")
    hosts: dict[str, tuple[str, ...]] = Field(
        default_factory=dict, description="Full names of the nodes of each host; empty where all runs in one place."
    )
    inside: dict[str, tuple[str, ...]] = Field(description="Patterns of further nodes in the process of a node.")
    ends: dict[str, ObservedEnds] = Field(description="By interface.")
    states: dict[str, ObservedManager] = Field(description="By full name of a controller manager.")
    lifecycle: dict[str, ManagedState] = Field(description="State of each managed node.")
    lifecycle_claimed: dict[str, ManagedState] = Field(description="The same from the claims on.")
    late_joints: tuple[str, ...] = Field(description="Joints without states until a person activates their hardware.")
    readings: tuple[ObservedReading, ...] = Field((), description="What the devices say of themselves.")


class ObservedCard(ContractModel):
    """A network card."""

    address: str = Field(description="IPv4 address with prefix length.")
    interface: str | None = Field(None, description="Its name in the operating system, if stated.")
    speed_bps: float | None = Field(None, description="Least speed of its link, bit/s, if stated.")


class ObservedRoute(ContractModel):
    """How a device is reached."""

    address: str = Field(description="IPv4 address of the device.")
    card: str = Field(description="Network card that leads to it.")


class ObservedComputer(ContractModel):
    """What a computer must show before anything runs on it."""

    versions: tuple[str, ...] = Field(description="Parts of the version tuple, as `installed_versions.py` takes them.")
    cards: dict[str, ObservedCard] = Field(default_factory=dict, description="Network cards, by name.")
    routes: dict[str, ObservedRoute] = Field(default_factory=dict, description="By device.")
    environment: dict[str, str] = Field(description="Variables by which nodes find each other.")
    scheduling: str = Field(UNKNOWN, description="Preemption model of the kernel.")
    controls: bool = Field(description="Whether a controller manager runs on it.")
    max_offset_s: float | None = Field(None, description="Bound of the offset of its clock, as chrony knows it, s.")


class Observation(ContractModel):
    """The file."""

    enclave: str = Field(description="SROS2 enclave of the program.")
    recorded: tuple[str, ...] = Field(description="Topics that an attempt records.")
    computers: dict[str, ObservedComputer] = Field(description="By host; an empty name where the spec states none.")
    mock: ObservedTarget = Field(description="On the mock.")
    real: ObservedTarget = Field(description="On the real target.")
