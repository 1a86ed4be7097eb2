"""A device of the catalog: what ``device.yaml`` says beyond what its description holds.

Texts may carry placeholders that link fills in: ``{device}`` the name in the spec, ``{prefix}`` that of its ROS names,
``{bare_prefix}`` the prefix without its last underscore, ``{prefix_namespace}`` the same as a namespace, ``{stem}`` the
same or, where there is none, the name, ``{address}`` and ``{port}`` of the connection, ``{host_address}`` of the host's
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

from pydantic import Field, model_validator

from cellc.catalog.catalog_model import CatalogModel, Date, DistroName, GateName, PartName, Text, Token
from cellc.catalog.device_controller import DeviceController
from cellc.catalog.device_interfaces import (
    ActionFacts,
    CameraFacts,
    ControlFacts,
    DriverFacts,
    NodeFacts,
    ServiceFacts,
    SpeedScalingFacts,
    TopicFacts,
)
from cellc.catalog.robot_facts import DrivenBy, HumanStep, MountFacts, PlugFacts, RobotControllerFacts, StepCondition
from cellc.catalog.version_rows import VersionRow
from cellc.spec.quantity import (
    Force,
    JointAcceleration,
    JointJerk,
    JointPosition,
    JointVelocity,
    Length,
    Mass,
    Velocity,
)
from cellc.vocabulary import GateCode


class PortFacts(CatalogModel):
    """One port; ``direction`` tells who opens the connection."""

    port: int = Field(ge=1, le=65535)
    protocol: Literal["tcp", "udp"]
    direction: Literal["host_to_device", "device_to_host"]
    service: Text


class NetworkFacts(CatalogModel):
    """What the device asks of its network."""

    ports: tuple[PortFacts, ...] = ()
    default_subnet: Text | None = None
    dedicated_link: bool
    realtime: Literal["required", "recommended", "not_needed"]
    source: Text


class SafetyStateFacts(CatalogModel):
    """A state of the device's own safety controller and how its driver reports it.

    ``gate`` is where people look for it: what only an activation or an action shows is seen in no earlier one.
    """

    name: Token
    stops: bool
    reported: Text | None = None
    gate: GateName = GateCode.G4


class StateTopicFacts(CatalogModel):
    """A topic, below the node of a controller of this kind, that says in which state the device is."""

    controller: Token
    topic: Token
    source: Text


class RecoveryFacts(CatalogModel):
    """The way out of one state: steps in order, the human ones first; ``by`` where it is that of one driver alone."""

    state: Token
    by: DrivenBy | None = None
    steps: tuple[HumanStep, ...] = Field(min_length=1)


class SafetyFacts(CatalogModel):
    """The vendor's safety boundary; no software of the cell is part of it.

    ``ending`` is what people do at the device once nothing is claimed, before its driver ends, ``ended`` after that.
    """

    stop_authority: Text
    states: tuple[SafetyStateFacts, ...] = ()
    told: tuple[StateTopicFacts, ...] = ()
    modes: tuple[Text, ...] = ()
    recovery: tuple[RecoveryFacts, ...] = ()
    ending: tuple[HumanStep, ...] = ()
    ended: tuple[HumanStep, ...] = ()
    watchdog: Text | None = None
    source: Text


class VendorDescriptionFacts(CatalogModel):
    """The file in the vendor's package, its arguments for this model, and links with other names: theirs to ours."""

    file: Text
    arguments: dict[Token, Text] = Field(default_factory=dict)
    links: dict[Token, Token] = Field(default_factory=dict)
    source: Text


class DescriptionFacts(CatalogModel):
    """The model of the device: a file beside ``device.yaml``, and the vendor's package that it stands for.

    Where that package is at hand, ``vendor`` tells which of its files has the shapes.
    """

    file: Text
    package: Text | None = None
    vendor: VendorDescriptionFacts | None = None
    arguments: dict[Token, Text] = Field(default_factory=dict)


class CommissioningStep(CatalogModel):
    """What a person does at the real device in a gate, by its vendor's procedure; ``only`` on some distributions.

    ``shows`` where it is what must be seen once the release of that gate has been made, ``powers`` where drives have
    power by it, so that the stop can be tried. ``log`` where it stands in the driver's log: what the lines hold of
    which the newest counts. ``run`` are commands that read; ``{address}`` in them is a word of the shell. ``when``
    where it is only done if one of these is so, ``by`` where by one driver alone.
    """

    gate: GateName
    does: Text
    log: tuple[Text, ...] = ()
    run: tuple[Text, ...] = ()
    shows: bool = False
    powers: bool = False
    only: tuple[DistroName, ...] = ()
    when: tuple[StepCondition, ...] = ()
    by: DrivenBy | None = None
    source: Text


class RecordFacts(CatalogModel):
    """Where the record of an attempt with the real device has a field from.

    ``controller`` is a kind of controller of this device, ``topic`` the name below its node, ``field`` what holds it.
    None of them where no topic of the driver has it: then ``read`` tells where a person reads it.
    """

    controller: Token | None = None
    topic: Token | None = None
    field: Token | None = None
    read: Text | None = None
    source: Text

    @model_validator(mode="after")
    def _by_a_topic_or_a_person(self) -> "RecordFacts":
        told = (self.controller, self.topic, self.field)
        if any(part is None for part in told) == (self.read is None) or (self.read and any(told)):
            raise ValueError("must have `controller`, `topic` and `field`, or `read` alone")
        return self


class JogFacts(CatalogModel):
    """How people move one joint where the driver cannot run meanwhile, so that positions are read at the device."""

    does: Text
    source: Text


class KinematicsFacts(CatalogModel):
    """How the vendor's tool writes where the joints of one very robot stand.

    In the file, each entry of ``joints`` below ``root`` gives the joint that it names x, y, z in m and roll, pitch, yaw
    in rad in its parent link. ``hash`` is the key of a text that names the robot's own table; the real plugin is told
    it as ``hash_parameter``, whose value in the catalog is that of the nominal one. ``tool`` is the command that writes
    the file ``FILE``, ``package`` where it is, and ``state`` what the robot is in meanwhile.
    """

    root: Token
    joints: dict[Token, Token] = Field(min_length=1)
    hash: Token
    hash_parameter: Text
    tool: Text
    package: Token | None = None
    state: Text = "the robot is powered on"
    source: Text


class PackageFacts(CatalogModel):
    """ROS package or library names as they stand in the version tuple; None where there is none."""

    driver: Token | None = None
    sdk: Text | None = None
    description: Token | None = None


class VelocityLimit(CatalogModel):
    """A velocity that one joint, or every joint (``*``), may have wherever it stands."""

    value: JointVelocity
    source: Text


class AccelerationLimit(CatalogModel):
    """An acceleration that one joint, or every joint (``*``), may have."""

    value: JointAcceleration
    source: Text


class JerkLimit(CatalogModel):
    """A jerk that one joint, or every joint (``*``), may have."""

    value: JointJerk
    source: Text


class PayloadLimit(CatalogModel):
    """Mass that may hang on the flange, tool included."""

    value: Mass
    source: Text


class ReachFigure(CatalogModel):
    """How far the arm reaches, as its vendor gives it: from the axis of the first joint."""

    value: Length
    source: Text


class RepeatabilityFigure(CatalogModel):
    """Pose repeatability of the tip by ISO 9283, half of what a data sheet gives as a range about zero."""

    value: Length
    source: Text


class LimitFacts(CatalogModel):
    """Limits that URDF cannot hold; keys are joint names or ``*`` for all others.

    ``velocity_everywhere`` where the device allows less near the ends of a joint than its description says.
    """

    velocity_everywhere: dict[Text, VelocityLimit] = Field(default_factory=dict)
    acceleration: dict[Text, AccelerationLimit] = Field(default_factory=dict)
    jerk: dict[Text, JerkLimit] = Field(default_factory=dict)
    payload: PayloadLimit | None = None
    reach: ReachFigure | None = None
    repeatability: RepeatabilityFigure | None = None

    def velocity_of(self, joint: str) -> VelocityLimit | None:
        """Return the velocity that a joint, named without prefix, may have everywhere."""
        return self.velocity_everywhere.get(joint, self.velocity_everywhere.get("*"))

    def acceleration_of(self, joint: str) -> AccelerationLimit | None:
        """Return the limit of a joint, named without prefix."""
        return self.acceleration.get(joint, self.acceleration.get("*"))

    def jerk_of(self, joint: str) -> JerkLimit | None:
        """Return the limit of a joint, named without prefix."""
        return self.jerk.get(joint, self.jerk.get("*"))


class GripperFacts(CatalogModel):
    """A gripper: ``open`` and ``closed`` are joint positions, ``stroke`` and ``max_speed`` are of jaw against jaw."""

    joint: Token
    open: JointPosition
    closed: JointPosition
    stroke: Length
    max_force: Force
    min_force: Force | None = None
    max_speed: Velocity
    goal_tolerance: JointPosition
    source: Text


class SwitchedState(CatalogModel):
    """A state of a switched device: what its outputs are set to for it, and what its sensors read in it."""

    outputs: dict[Token, bool] = Field(default_factory=dict)
    sensors: dict[Token, bool] = Field(default_factory=dict)


class SwitchedFacts(CatalogModel):
    """A device of a few states that digital outputs of the cell switch, or that its sensors tell.

    Which output of which device drives it, how long it takes, and what a loss of power does, is a fact of the cell.
    ``holds`` is the state in which it holds a part or a tool.
    """

    outputs: tuple[Token, ...] = ()
    sensors: tuple[Token, ...] = ()
    states: dict[Token, SwitchedState] = Field(min_length=2)
    holds: Token | None = None
    source: Text


class AllowedPair(CatalogModel):
    """Two links whose contact is looked for nowhere, and why: the vendor's SRDF, or a person, says so."""

    links: tuple[PartName, PartName]
    because: Text


Excusable = Literal["impossible-inertia", "mimic-of-nothing", "missing-joint-limits", "missing-velocity-limit"]
"""Codes on a description that endanger nobody: no motion is planned with a tensor, nor with an idle joint.

What mimics nothing is then a joint of its own, as it is to MoveIt and pinocchio, and stands at its home.
"""


Kind = Literal[
    "arm", "gripper", "hand", "camera", "sensor", "digital", "io", "axis", "conveyor", "base", "fixture", "plc"
]


def device_kinds() -> tuple[str, ...]:
    """Name the kinds of devices."""
    return get_args(Kind)


class DeviceModel(CatalogModel):
    """One ``device.yaml``.

    ``format`` is the version of this format. ``family`` names the file that the model's own was laid over, where it
    has one. ``model`` is the name of the device in specs. ``vendor`` is who makes it. ``summary`` is what it is, in one
    line for who chooses. ``kind`` is what it is to a cell. ``as_of`` is the day on which the facts were read, and
    ``sources`` are what they were read from.

    ``base`` is the link that a mount places. ``frames`` are the links that a spec may name, by the names that it uses.
    ``tool_frame`` is the link that carries tools. ``optical_frames`` are links in which a camera sees, z ahead.
    ``home`` has the position of each joint in which it rests. ``allowed_collisions`` are pairs of links that may touch.
    ``excused`` are findings on its description that endanger nobody and that who uses it cannot mend, each with why.

    ``controllers`` are the kinds that the vendor ships. ``record`` has what of its state is recorded.
    ``mock_cannot_prove`` is what only the real device shows: it stands in the audit.
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
    packages: PackageFacts
    control: ControlFacts | None = None
    driver: DriverFacts | None = None
    controllers: dict[Token, DeviceController] = Field(default_factory=dict)
    speed_scaling: SpeedScalingFacts | None = None
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
    commissioning: tuple[CommissioningStep, ...] = ()
    versions: tuple[VersionRow, ...] = ()
    mock_cannot_prove: tuple[Text, ...] = ()
