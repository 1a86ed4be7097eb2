"""Settings of the robot's own controller, and who can start the program on it."""

from typing import Literal, Union

from pydantic import Field

from cellc.compiler.catalog.catalog_model import CatalogModel, FileName, NodeName, ParameterFact, PartName, Text, Token
from cellc.compiler.spec.quantity import Position, RollPitchYaw, Voltage
from cellc.compiler.spec.tool import BaudRate, Parity, StopBits


class StartMode(CatalogModel):
    """One start mode of the program on the robot.

    Attributes:
        name: Name of the mode: from the pendant, by the dashboard server, or headless.
        by: Who starts the program; ``played_by`` of the spec chooses it.
        mode: Whether the robot is in local or remote control; ``mode`` of the spec chooses it.
        parameters: ``<param>`` values of the real plugin in this mode.
        node_parameters: Parameters of nodes of the driver in this mode, by node.
    """

    name: Literal["pendant", "dashboard", "headless"]
    by: Literal["person", "driver"]
    mode: Literal["local", "remote"]
    parameters: dict[Text, Text] = Field(default_factory=dict)
    node_parameters: dict[NodeName, dict[Text, ParameterFact]] = Field(default_factory=dict)


class ProgramFacts(CatalogModel):
    """The program on the robot through which set points pass.

    Attributes:
        start_modes: Start modes; the first is used if the spec names none.
        source: Document or line of code from which this was read.
    """

    start_modes: tuple[StartMode, ...] = Field(min_length=1)
    source: Text

    def start_mode(self, by: str, mode: str) -> StartMode | None:
        """Return the start mode of ``person`` or ``driver`` in local or remote control, or None."""
        return next((start for start in self.start_modes if (start.by, start.mode) == (by, mode)), None)


class MountFacts(CatalogModel):
    """How the vendor mounts the device on an arm, with a fixed transform.

    Attributes:
        on: Model of the arm in the catalog.
        frame: Frame of the arm, by its own name.
        xyz: Position of the base of the device in that frame, such as ``0 0 10 mm``; origin of that frame if absent.
        rpy: Fixed-axis roll, pitch and yaw of the base in that frame, such as ``0 0 -45 deg``; no rotation if absent.
        source: Package or drawing with its version.
    """

    on: Token
    frame: PartName
    xyz: Position | None = None
    rpy: RollPitchYaw | None = None
    source: Text


class CenterFacts(CatalogModel):
    """Where the robot says where its TCP is.

    Attributes:
        controller: Kind of controller of this device that publishes the topic.
        topic: Name of the topic below the node of the controller.
        source: Document or line of code from which this was read.
    """

    controller: Token
    topic: Token
    source: Text


class IdleFacts(CatalogModel):
    """A silence on a serial line, in the time that one character takes.

    Attributes:
        least: Shortest silence that can be set, in characters.
        most: Longest silence that can be set, in characters.
        usual: Silence if the spec says nothing, in characters.
    """

    least: float
    most: float
    usual: float


class ForwardFacts(CatalogModel):
    """The program that gives a computer the serial line of a tool connector, as a device node; no node of ROS.

    Attributes:
        package: ROS package of the program.
        program: Name of the program in the package.
        arguments: Arguments of the program; placeholders are filled.
        system: System packages that the program calls, by rosdep key, such as ``[socat]``.
    """

    package: Token
    program: FileName
    arguments: tuple[Text, ...] = ()
    system: tuple[Token, ...] = ()


class ToolSerialFacts(CatalogModel):
    """The serial line of a tool connector, and the parameters of the plugin that set it up.

    Attributes:
        baud_rates: Baud rates that can be set, in bit/s.
        parities: Parities that can be set, each with the plugin's word for it.
        stop_bits: Numbers of stop bits that can be set.
        rx_idle_chars: Silence after which the tool takes a received message as complete and sends it to the host.
        tx_idle_chars: Silence since the last activity on the line before the tool starts to transmit.
        tcp_port: TCP port of the robot that carries the line, if the spec says nothing.
        parameters: ``<param>`` values of the real plugin that set the line up.
        forward: Program that makes a device node of the line.
        source: Document or line of code from which this was read.
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
    """The connector at the tool frame of a robot.

    Attributes:
        voltages: Voltages that can be set, such as ``[0 V, 12 V, 24 V]``.
        serial: Serial line of the connector; absent if it has none.
        source: Manual with its version.
    """

    voltages: tuple[Voltage, ...] = Field(min_length=1)
    serial: ToolSerialFacts | None = None
    source: Text


class SerialFacts(CatalogModel):
    """Settings of the serial line of a device.

    Attributes:
        baud_rate: Baud rate in bit/s, such as ``115200``.
        parity: Parity of the line.
        stop_bits: Number of stop bits.
    """

    baud_rate: BaudRate
    parity: Parity
    stop_bits: StopBits


class PlugFacts(CatalogModel):
    """What a device takes from the tool connector of a robot.

    Attributes:
        voltage: Voltage that the device needs.
        serial: Serial line of the device; absent if it has none.
        source: Manual with its version.
    """

    voltage: Voltage
    serial: SerialFacts | None = None
    source: Text


class StiffnessSpan(CatalogModel):
    """The least and the most of a stiffness or a damping.

    Attributes:
        least: Smallest value, in N/m for a translation, N m/rad for a rotation, N m s/rad for a damping.
        most: Largest value, in the same unit.
    """

    least: float
    most: float


class ImpedanceFacts(CatalogModel):
    """What impedance the robot's own controller takes.

    Attributes:
        joint: Stiffness of a joint, in N m/rad.
        damping: Damping of a joint, in N m s/rad; absent if it cannot be set.
        translation: Stiffness along an axis of the tool, in N/m; absent if it takes none at the tool.
        rotation: Stiffness about an axis of the tool, in N m/rad; absent if it takes none at the tool.
        acts_on: Command interfaces whose set points the robot's own controller follows with this impedance, such as
            ``[position, velocity]``; commands by any other, such as ``effort``, bypass it.
        source: Document or line of code from which this was read.
    """

    joint: StiffnessSpan
    damping: StiffnessSpan | None = None
    translation: StiffnessSpan | None = None
    rotation: StiffnessSpan | None = None
    acts_on: tuple[Token, ...] = Field(min_length=1)
    source: Text


class RobotControllerFacts(CatalogModel):
    """What can be set in the robot's own controller.

    Attributes:
        program: Program on the robot that passes set points on.
        tcp: Topic that has the TCP as the robot knows it.
        payload_service: Which service sets the payload, and when it works.
        payload_entry: How people enter the payload, by what ``set_by`` of the spec says.
        rotation_vector: Whether the robot shows orientations as rotation vectors.
        thresholds: Which service sets the thresholds of collisions.
        load_service: Which service sets the load besides the tool that is installed.
        impedance: Stiffnesses that the robot's own controller takes.
        tool_connector: Connector at the tool frame.
    """

    program: ProgramFacts | None = None
    tcp: CenterFacts | None = None
    payload_service: Text | None = None
    payload_entry: dict[Literal["installation", "service"], Text] = Field(default_factory=dict)
    rotation_vector: bool = False
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
    """What people do only where one of these is so of the device.

    Attributes:
        when: What the spec may say of the device; one of them must hold.
        does: What people do; placeholders are filled.
    """

    when: tuple[StepCondition, ...] = Field(min_length=1)
    does: Text


HumanStep = Union[Text, GuardedStep]
"""What people do at a device, always or where something is so of it; placeholders are filled."""
