"""What the robot's own controller gets, and who starts its program."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Annotated

from cellc.compiler.cell.entity import ELSEWHERE, STATED, Part
from cellc.contract.frozen import dataclass
from cellc.contract.grading import OTHER_LOAD, Graded, Rule
from cellc.contract.stated import RobotProgram
from cellc.contract.transforms import Vector3
from cellc.contract.vocabulary import ReviewArea

Moments6 = tuple[float, float, float, float, float, float]
"""ixx, iyy, izz, ixy, ixz, iyz in kg m^2."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Load:
    """The part of a payload that a service tells; center of mass in the tool frame in m, inertia about it."""

    mass_kg: float
    center_of_mass: Vector3
    inertia: Moments6


@dataclass(frozen=True, slots=True, kw_only=True)
class Payload:
    """Payload set in the robot controller: everything mounted at the tool frame.

    Args:
        center_of_mass: in the tool frame, m.
        inertia: about the center of mass, in axes parallel to the tool frame; None where it is not stated.
        set_by: installation or service.
        load: the part of it that a service sets in addition to the tool, or None.
        part_kg: what the tool holds while it is closed, whether the robot knows of it or not; None where unstated.
    """

    mass_kg: float
    center_of_mass: Vector3
    inertia: Moments6 | None
    set_by: str
    load: Load | None
    part_kg: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Thresholds:
    """Values at which a contact is seen, and those at which the robot stops; SI."""

    lower: tuple[float, ...]
    upper: tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class CollisionThresholds:
    """Thresholds of collisions: torques of joints, forces and moments at the tool."""

    torque: Thresholds
    force: Thresholds
    moment: Thresholds


@dataclass(frozen=True, slots=True, kw_only=True)
class CartesianImpedance:
    """Stiffness at the tool: N/m along the axes, N m/rad about them."""

    translation: tuple[float, ...]
    rotation: tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Impedance:
    """How stiff the robot's own controller holds what it is commanded; None where unstated.

    Args:
        joint: N m/rad.
        damping: N m s/rad of the same joints.
    """

    joint: tuple[float, ...] | None
    cartesian: CartesianImpedance | None
    damping: tuple[float, ...] | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ImpedanceFacts:
    """What impedance a kind of robot takes: least and most of each, and the command interfaces on which it acts.

    None where it takes none of a kind; ``joints`` is how many of them it takes, None for all that are commanded.
    """

    joint: tuple[float, float]
    damping: tuple[float, float] | None
    translation: tuple[float, float] | None
    rotation: tuple[float, float] | None
    acts_on: tuple[str, ...]
    joints: int | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolSerial:
    """The serial line of a tool connector; ``port`` is the device node that it becomes on the driver's host.

    ``tcp_port`` is the robot's; times of silence are in characters.
    """

    port: str
    baud_rate: int
    parity: str
    stop_bits: int
    rx_idle_chars: float | None
    tx_idle_chars: float | None
    tcp_port: int | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolConnector:
    """What the connector at the tool frame gives."""

    voltage_v: float
    serial: ToolSerial | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolFacts:
    """What the tool connector of a kind of robot can give; without a serial line there are no settings of one.

    Args:
        settings: values that a setting may have; ``spans`` are the least and the most of those that are numbers.
    """

    voltages_v: tuple[float, ...]
    has_serial: bool = False
    settings: Mapping[str, tuple[str | int, ...]] = field(default_factory=dict)
    spans: Mapping[str, tuple[float, float]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class Plug:
    """What a device takes from the tool connector of a robot; ``serial`` are settings, None where it speaks none."""

    voltage_v: float
    serial: Mapping[str, str | int] | None


@dataclass(frozen=True, slots=True, kw_only=True)
class HostProgram:
    """A program on the host of a driver that is no node of ROS; ``system`` are packages by their keys of rosdep."""

    name: str
    package: str
    program: str
    arguments: tuple[str, ...]
    system: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotFacts:
    """The settings that the controller of a robot of this kind has.

    Args:
        start_modes: (starter, mode) pairs that start its program: ``driver`` or ``person``, ``local`` or ``remote``;
            empty where set points pass through no program.
        thresholds: whether it takes collision thresholds.
        payload_service: whether a service sets its payload; in local mode only while its program runs.
        tcp_kind, tcp_topic: kind of controller that publishes the pose of the TCP, and the topic below its node.
        load_service: whether a service sets the load that it carries in addition to its tool.
        impedance_facts: ranges of its impedance; None where it takes none.
        tool_facts: what the connector at its tool frame can supply; None where it has none.
    """

    start_modes: tuple[tuple[str, str], ...] = ()
    thresholds: bool = False
    payload_service: bool = False
    tcp_kind: str | None = None
    tcp_topic: str | None = None
    load_service: bool = False
    impedance_facts: ImpedanceFacts | None = None
    tool_facts: ToolFacts | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotController(Part):
    """What a robot's own controller gets, and who starts the program there; None where the spec says nothing.

    Args:
        tcp: the frame at which it holds its TCP.
        tool_connector: what the connector at its tool frame supplies.
        plug: what the device itself takes from the tool connector of a robot, where the catalog tells.
        accepts: what the controller takes.
    """

    payload: Annotated[Payload | None, STATED, Graded(ReviewArea.PAYLOAD, "payload", Rule.LOAD, why=OTHER_LOAD)] = None
    tcp: Annotated[str | None, STATED, Graded(ReviewArea.PAYLOAD, "TCP", Rule.DANGEROUS, why="the TCP moves")] = None
    program: Annotated[RobotProgram | None, STATED] = None
    collision: Annotated[CollisionThresholds | None, STATED] = None
    impedance: Annotated[Impedance | None, STATED] = None
    tool_connector: Annotated[ToolConnector | None, STATED] = None
    plug: Annotated[Plug | None, ELSEWHERE] = None
    accepts: Annotated[RobotFacts, ELSEWHERE] = field(default_factory=RobotFacts)
