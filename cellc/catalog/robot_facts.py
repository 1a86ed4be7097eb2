"""What the controller of a robot can be told, and who can start the program on it."""

from typing import Literal, Union

from pydantic import Field

from cellc.catalog.catalog_model import CatalogModel, FileName, NodeName, ParameterFact, PartName, Text, Token
from cellc.spec.quantity import Position, RollPitchYaw, Voltage
from cellc.spec.tool import BaudRate, Parity, StopBits


class ProgramWay(CatalogModel):
    """One way in which the program on the robot comes to run.

    ``parameters`` are given to the hardware plugin, ``node_parameters`` to nodes of the driver, where it is chosen.
    """

    name: Literal["pendant", "dashboard", "headless"]
    by: Literal["person", "driver"]
    mode: Literal["local", "remote"]
    parameters: dict[Text, Text] = Field(default_factory=dict)
    node_parameters: dict[NodeName, dict[Text, ParameterFact]] = Field(default_factory=dict)


class ProgramFacts(CatalogModel):
    """The program on the robot through which set points pass; the first way is that of a spec that says nothing."""

    ways: tuple[ProgramWay, ...] = Field(min_length=1)
    source: Text

    def way(self, by: str, mode: str) -> ProgramWay | None:
        """Return the way of ``person`` or ``driver`` in a mode."""
        return next((one for one in self.ways if (one.by, one.mode) == (by, mode)), None)


class MountFacts(CatalogModel):
    """How the vendor hangs the device on an arm: on a frame of a model, by its own name, with a fixed transform."""

    on: Token
    frame: PartName
    xyz: Position | None = None
    rpy: RollPitchYaw | None = None
    source: Text


class CenterFacts(CatalogModel):
    """Where the robot says where its TCP is: a topic of a kind of controller."""

    controller: Token
    topic: Token
    source: Text


class IdleFacts(CatalogModel):
    """Times of silence that mark the end of a serial message, in characters; ``usual`` where a spec says nothing."""

    least: float
    most: float
    usual: float


class ForwardFacts(CatalogModel):
    """The program that gives a computer the serial line of a tool connector, as a device node; no node of ROS.

    ``system`` are what it calls, by their keys of rosdep.
    """

    package: Token
    program: FileName
    arguments: tuple[Text, ...] = ()
    system: tuple[Token, ...] = ()


class ToolSerialFacts(CatalogModel):
    """The serial line of a tool connector, and the parameters of the plugin that set it up.

    ``parities`` are what the plugin calls them, ``tcp_port`` is that of the robot where a spec says nothing.
    """

    baud_rates: tuple[BaudRate, ...] = Field(min_length=1)
    parities: dict[Parity, Text] = Field(min_length=1)
    stop_bits: tuple[StopBits, ...] = Field(min_length=1)
    rx_idle_chars: IdleFacts
    tx_idle_chars: IdleFacts
    tcp_port: int = Field(ge=1, le=65535)
    parameters: dict[Text, Text]
    forward: ForwardFacts
    source: Text


class ToolConnectorFacts(CatalogModel):
    """The connector at the tool frame of a robot: voltages that it gives, and its serial line if it has one."""

    voltages: tuple[Voltage, ...] = Field(min_length=1)
    serial: ToolSerialFacts | None = None
    source: Text


class SerialFacts(CatalogModel):
    """Settings of the serial line of a device."""

    baud_rate: BaudRate
    parity: Parity
    stop_bits: StopBits


class PlugFacts(CatalogModel):
    """What a device takes from the tool connector of a robot: its voltage, and the serial line that it speaks."""

    voltage: Voltage
    serial: SerialFacts | None = None
    source: Text


class StiffnessSpan(CatalogModel):
    """The least and the most of a stiffness, in N/m or N m/rad."""

    least: float
    most: float


class ImpedanceFacts(CatalogModel):
    """What impedance the robot's own controller takes; ``acts_on`` are the command interfaces that it controls."""

    joint: StiffnessSpan
    translation: StiffnessSpan
    rotation: StiffnessSpan
    acts_on: tuple[Token, ...] = Field(min_length=1)
    source: Text


class RobotControllerFacts(CatalogModel):
    """What the robot's own controller can be told.

    ``payload_service`` says which service tells it the payload, and when; ``thresholds`` which takes those of
    collisions; ``load_service`` tells it what it carries beside the tool that its installation has.
    """

    program: ProgramFacts | None = None
    tcp: CenterFacts | None = None
    payload_service: Text | None = None
    thresholds: Text | None = None
    load_service: Text | None = None
    impedance: ImpedanceFacts | None = None
    tool_connector: ToolConnectorFacts | None = None


StepCondition = Literal[
    "pendant",
    "dashboard",
    "headless",
    "payload_by_installation",
    "payload_by_service",
    "thresholds_stated",
    "thresholds_open",
    "load_stated",
    "joint_impedance_stated",
    "cartesian_impedance_stated",
    "tool_power",
    "tool_serial_pendant",
    "tool_serial_dashboard",
    "tool_serial_headless",
    "through_tool",
]
"""What a spec may say of a device, so that people do one thing or the other."""


DrivenBy = Literal["driver", "adapter"]
"""What reaches a device: the driver of ROS, or an adapter on the library of its vendor."""


class GuardedStep(CatalogModel):
    """What people do only where one of these is so of the device."""

    when: tuple[StepCondition, ...] = Field(min_length=1)
    does: Text


HumanStep = Union[Text, GuardedStep]
"""What people do at a device, always or where something is so of it; placeholders are filled."""
