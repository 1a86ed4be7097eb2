"""A device of the catalog: what ``device.yaml`` says beyond what its description holds.

Texts may carry placeholders that link fills in: ``{device}`` the name in the spec, ``{prefix}`` that of its ROS names,
``{bare_prefix}`` the prefix without its last underscore, ``{prefix_namespace}`` the same as a namespace, ``{stem}`` the
same or, without one, the name, ``{address}``, ``{port}``,
``{username}`` and ``{password}`` of the connection, ``{host_address}`` of the host's
card, ``{carrier_address}`` that of the device on which this one is mounted, ``{controller_KIND}`` the full name of the
cell's controller of that kind on this device, ``{share:PACKAGE}`` the share folder of an installed package,
``{played_by}`` who starts its program, ``{thresholds}`` those of collisions as a request, ``{load}`` what
it carries beside its tool as one, ``{joint_stiffness}`` and ``{cartesian_stiffness}`` as lists, ``{tool_voltage}``,
``{tool_baud_rate}``, ``{tool_parity}``, ``{tool_stop_bits}``, ``{tool_rx_idle_chars}``, ``{tool_tx_idle_chars}``,
``{tool_port}`` and ``{tool_tcp_port}`` what the spec says of its tool connector, ``{carrier}`` the robot through whose
tool connector it has its power, ``{gripper_max_speed}``, ``{gripper_max_force}`` and ``{gripper_closed}`` figures of
a gripper. Links, joints, sensors and gpios are named without prefix.
"""

from typing import Literal, get_args

from pydantic import Field

from cellc.compiler.catalog.catalog_model import CatalogModel, Date, FileName, InnerPath, PartName, Text, Token
from cellc.compiler.catalog.device_bring_up import (
    CommissioningStep,
    JogFacts,
    NetworkFacts,
    ReadingFacts,
    RecordFacts,
    SafetyFacts,
    SpeedControlFacts,
)
from cellc.compiler.catalog.device_controller import DeviceController
from cellc.compiler.catalog.device_graph import ActionFacts, CameraFacts, NodeFacts, ServiceFacts, TopicFacts
from cellc.compiler.catalog.device_interfaces import ControlFacts, DriverFacts, SpeedScalingFacts
from cellc.compiler.catalog.device_laws import DriveFacts, LawFacts
from cellc.compiler.catalog.limit_facts import LimitFacts
from cellc.compiler.catalog.robot_facts import MountFacts, PlugFacts, RobotControllerFacts
from cellc.compiler.catalog.version_rows import VersionRow
from cellc.compiler.spec.quantity import Force, JointPosition, Length, Velocity


class VendorDescriptionFacts(CatalogModel):
    """The file of the vendor's package that has the shapes of this device.

    Attributes:
        file: Path of the URDF or xacro in the package, such as ``urdf/arm.urdf.xacro``.
        arguments: Values of the xacro arguments that give this model, by name.
        links: Links that have another name there: their name to the name in this device's description.
        source: Document or package with its version from which this was read.
    """

    file: InnerPath
    arguments: dict[Token, Text] = Field(default_factory=dict)
    links: dict[Token, Token] = Field(default_factory=dict)
    source: Text


class DescriptionFacts(CatalogModel):
    """The model of the device: a file beside ``device.yaml``, and the vendor's package that it describes.

    Attributes:
        file: URDF or xacro beside ``device.yaml``, such as ``robot.urdf``.
        package: ROS package that has the vendor's own description; its version is pinned as ``description`` in the
            spec.
        vendor: File of that package whose shapes are used where the package is found.
        arguments: Values of the xacro arguments of ``file``, by name.
    """

    file: Text
    package: Text | None = None
    vendor: VendorDescriptionFacts | None = None
    arguments: dict[Token, Text] = Field(default_factory=dict)


class KinematicsFacts(CatalogModel):
    """How the vendor's tool writes where the joints of one very robot are.

    Attributes:
        root: Key of the file below which the entries of the joints are, such as ``kinematics``.
        joints: Entries of the file and the joint that each describes: x, y, z in m and roll, pitch, yaw in rad in the
            parent link.
        hash: Key of the file that has a text which identifies the robot's own table.
        hash_parameter: Parameter of the real plugin that takes that text; its value in the catalog is that of the
            nominal table.
        tool: Command that writes the file, which it names ``FILE``; ``{address}`` is filled.
        package: ROS package that has the tool.
        state: State that the robot must be in while the tool runs.
        source: Documents or lines of code from which this was read.
    """

    root: Token
    joints: dict[Token, Token] = Field(min_length=1)
    hash: Token
    hash_parameter: Text
    tool: Text
    package: Token | None = None
    state: Text = "the robot is powered on"
    source: Text


class LibraryFacts(CatalogModel):
    """What shows the version of a library that is no ROS package, or whose package has another number.

    Attributes:
        debian: Debian package that installs the library; absent if the build of the driver fetches it, so that the
            version of the driver fixes it.
        source: Document or line of code from which this was read.
    """

    debian: FileName | None = None
    source: Text


class PackageFacts(CatalogModel):
    """ROS package or library names as in the version tuple; absent without one.

    Attributes:
        driver: ROS package of the driver, such as ``my_arm_driver``; its version is pinned as ``driver`` in the spec.
        sdk: Library of the vendor below the driver; its version is pinned as ``sdk`` in the spec.
        description: ROS package of the vendor's description; its version is pinned as ``description`` in the spec.
        library: What shows the version of ``sdk``; absent if a ROS package of that name has it.
    """

    driver: Token | None = None
    sdk: Text | None = None
    description: Token | None = None
    library: LibraryFacts | None = None


class GripperFacts(CatalogModel):
    """A gripper.

    Attributes:
        joint: Joint that opens and closes the gripper.
        open: Position of the joint when the gripper is open.
        closed: Position of the joint when the gripper is closed.
        stroke: How far one jaw moves relative to the other between closed and open.
        swing: Where each jaw swings on a crank: the angle between crank and fingers when closed, towards open; none of
            jaws that slide, in proportion to the joint.
        max_force: Largest grip force.
        min_force: Smallest grip force that can be set.
        max_speed: Largest speed of one jaw relative to the other.
        goal_tolerance: How far the joint may end from its goal.
        source: Data sheet or manual with its version.
    """

    joint: Token
    open: JointPosition
    closed: JointPosition
    stroke: Length
    swing: JointPosition | None = None
    max_force: Force
    min_force: Force | None = None
    max_speed: Velocity
    goal_tolerance: JointPosition
    source: Text


class SwitchedState(CatalogModel):
    """A state of a switched device.

    Attributes:
        outputs: What each output is set to for the state, such as ``{run: true}``.
        sensors: What each sensor reads in the state, such as ``{part: false}``.
    """

    outputs: dict[Token, bool] = Field(default_factory=dict)
    sensors: dict[Token, bool] = Field(default_factory=dict)


class SwitchedFacts(CatalogModel):
    """A device of a few states that digital outputs of the cell switch, or that its sensors tell.

    Which output of which device drives it, how long it takes, and what a loss of power does, is a fact of the cell.

    Attributes:
        outputs: Names of the inputs of the device that outputs of the cell switch; the spec wires each.
        sensors: Names of the sensors of the device; the spec wires each.
        states: States by name, at least two.
        holds: State in which the device holds a part or a tool.
        source: Data sheet with its version, or ``own choice``.
    """

    outputs: tuple[Token, ...] = ()
    sensors: tuple[Token, ...] = ()
    states: dict[Token, SwitchedState] = Field(min_length=2)
    holds: Token | None = None
    source: Text


class AllowedPair(CatalogModel):
    """Two links whose contact is not looked for.

    Attributes:
        links: Names of the two links, without prefix.
        because: Why contact need not be looked for, such as ``adjacent in the vendor's SRDF``.
    """

    links: tuple[PartName, PartName]
    because: Text


Excusable = Literal["impossible-inertia", "mimic-of-nothing", "missing-joint-limits", "missing-velocity-limit"]
"""Harmless codes on a description: motion is planned with no inertia tensor and with no idle joint.

What mimics nothing is then a joint of its own, as it is to MoveIt and pinocchio, and is at its home.
"""


Kind = Literal[
    "arm", "gripper", "hand", "camera", "sensor", "digital", "io", "axis", "conveyor", "base", "fixture", "plc"
]


def device_kinds() -> tuple[str, ...]:
    """Name the kinds of devices."""
    return get_args(Kind)


class DeviceModel(CatalogModel):
    """One ``device.yaml``.

    Attributes:
        format: Version of this format.
        family: Name of ``FAMILY.family.yaml``, beside this file or in the folder above, over which this file is laid.
        model: Name of the device, as a spec names it in ``model``.
        vendor: Who makes the device.
        summary: What the device is, in one line for the person who chooses.
        kind: What the device is for.
        as_of: Day on which the facts were read, such as ``2026-07-23``.
        sources: Documents and packages with their versions from which the facts were read.
        description: Links, joints and shapes of the device.
        base: Link that a mount places in the cell.
        frames: Links that a spec may name, each by the name that the spec uses, such as ``{tool0: tool0}``.
        tool_frame: Link that carries tools.
        mounts: How the vendor mounts the device on an arm; a mount of the spec that differs is reported.
        optical_frames: Links in which a camera sees, with z ahead.
        home: Position of each joint at which the device rests, by joint name.
        allowed_collisions: Pairs of links that may touch.
        excused: Codes of findings on the description that are accepted, each with the reason.
        kinematics: How a calibration of one very robot is read.
        jog: How people move a joint by hand; every arm of the catalog states it.
        limits: Limits that the description lacks or has wrong, and payload, reach and repeatability.
        laws: How the joints of the real device follow what they are commanded, by the command interface.
        drives: What motors and gears add to the joints that they turn.
        packages: Packages and libraries whose versions the spec pins.
        control: The ``<ros2_control>`` tag: plugins, joints, sensors and gpios.
        driver: Node that moves the device on the real target without ros2_control.
        controllers: Kinds of controllers that only this device has, by name.
        speed_scaling: How the device reports that it slows trajectories down.
        speed_control: What of the device slows every motion down; every arm of the catalog states it.
        gripper: Figures of a gripper; absent for other devices.
        camera: Streams of a camera; absent for other devices.
        switched: States that outputs switch or sensors report; absent for other devices.
        nodes: Nodes of the driver.
        topics: Topics that the device publishes besides those of its controllers.
        services: Services that the device answers.
        actions: Actions that the device executes.
        network: Ports, links and kernel that the device needs.
        safety: Safety states of the device, and the way out of each.
        robot: What can be set in the robot's own controller.
        plug: What the device takes from the tool connector of a robot.
        record: Where the record of a real attempt has the state of the device from.
        readings: What topics and services of the running device report, and what the gates expect.
        commissioning: What people do at the real device in each gate.
        versions: Versions of driver, library, description and firmware that go together.
        mock_cannot_prove: What only the real device shows, one sentence each; it is listed in the audit.
    """

    format: Literal[1]
    family: Token | None = None
    model: Token
    vendor: Text
    summary: Text
    kind: Kind
    as_of: Date
    sources: tuple[Text, ...] = Field(min_length=1)
    description: DescriptionFacts
    base: PartName
    frames: dict[PartName, PartName]
    tool_frame: PartName | None = None
    mounts: tuple[MountFacts, ...] = ()
    optical_frames: tuple[PartName, ...] = ()
    home: dict[PartName, JointPosition] | None = None
    allowed_collisions: tuple[AllowedPair, ...] = ()
    excused: dict[Excusable, Text] = Field(default_factory=dict)
    kinematics: KinematicsFacts | None = None
    jog: JogFacts | None = None
    limits: LimitFacts = Field(default_factory=LimitFacts)
    laws: tuple[LawFacts, ...] = ()
    drives: DriveFacts | None = None
    packages: PackageFacts
    control: ControlFacts | None = None
    driver: DriverFacts | None = None
    controllers: dict[Token, DeviceController] = Field(default_factory=dict)
    speed_scaling: SpeedScalingFacts | None = None
    speed_control: SpeedControlFacts | None = None
    gripper: GripperFacts | None = None
    camera: CameraFacts | None = None
    switched: SwitchedFacts | None = None
    nodes: tuple[NodeFacts, ...] = ()
    topics: tuple[TopicFacts, ...] = ()
    services: tuple[ServiceFacts, ...] = ()
    actions: tuple[ActionFacts, ...] = ()
    network: NetworkFacts | None = None
    safety: SafetyFacts | None = None
    robot: RobotControllerFacts = Field(default_factory=RobotControllerFacts)
    plug: PlugFacts | None = None
    record: dict[Literal["speed_scaling", "safety_state", "fault_code"], RecordFacts] = Field(default_factory=dict)
    readings: tuple[ReadingFacts, ...] = ()
    commissioning: tuple[CommissioningStep, ...] = ()
    versions: tuple[VersionRow, ...] = ()
    mock_cannot_prove: tuple[Text, ...] = ()
