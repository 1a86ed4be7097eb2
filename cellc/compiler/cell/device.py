"""Devices of a cell with everything that the catalog knows of them bound and prefixed."""

from __future__ import annotations

import datetime
from collections.abc import Mapping
from dataclasses import dataclass, field

from cellc.compiler.catalog.version_rows import VersionRow
from cellc.compiler.cell.entity import Entity
from cellc.compiler.cell.frame import WORLD
from cellc.compiler.cell.hardware import Effect, HardwareComponent
from cellc.compiler.cell.kinematics import Kinematics, VendorDescription
from cellc.compiler.cell.robot import (
    CollisionThresholds,
    HostProgram,
    Impedance,
    Payload,
    Plug,
    RobotFacts,
    RobotProgram,
    ToolConnector,
)
from cellc.compiler.cell.site import Clock, JointFigure
from cellc.compiler.cell.switched import Switched
from cellc.compiler.cell.vendor import CommissioningStep, RecordSource, VendorSafety
from cellc.contract.transforms import Pose, identity
from cellc.contract.vocabulary import UNKNOWN, InterfaceKind
from cellc.robot.description.model import Description

EVERY_JOINT = "*"
"""Name of what the mock adds to every joint that is commanded."""

_CAMERA_INFO = "sensor_msgs/msg/CameraInfo"


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceJoint(Entity):
    """A movable joint: ``name`` carries the prefix, ``local_name`` does not.

    Limits are the device's own, tightened by the cell; rad and rad/s for revolute, m and m/s for prismatic joints;
    None where neither the description nor the catalog states one. ``velocity_everywhere`` is the device's own where it
    allows less in some positions. ``assumed`` are the limits, by their keys in ``device.yaml``, without a source.
    ``mimics`` names the joint that it follows.
    """

    local_name: str
    type: str
    lower: float | None
    upper: float | None
    velocity: float | None
    velocity_everywhere: float | None
    acceleration: float | None
    jerk: float | None
    effort: float | None
    assumed: tuple[str, ...]
    mimics: str | None
    command_interfaces: tuple[str, ...]
    state_interfaces: tuple[str, ...]

    @property
    def slides(self) -> bool:
        """Whether its positions are lengths."""
        return self.type == "prismatic"


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceDriver:
    """The node that moves a device on the real target past ros2_control.

    Args:
        node: its fully qualified name.
        program: ``package/executable``.
        joint_states: the topic on which the program publishes the joints of the device, or None.
        actions: kind of controller → the action, and its type, that takes such a controller's goals.
        goal_unit: what the figures of these goals are; None where they are those of the joints.
    """

    node: str
    program: str
    joint_states: str | None
    actions: Mapping[str, tuple[str, str]]
    goal_unit: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceVersions:
    """The parts of the version tuple that a device adds, as written."""

    revision: str = UNKNOWN
    serial: str = UNKNOWN
    firmware: str = UNKNOWN
    driver: str = UNKNOWN
    sdk: str = UNKNOWN
    description: str = UNKNOWN

    def part(self, name: str) -> str:
        """Return a part by its name, such as ``firmware``."""
        return str(getattr(self, name))


@dataclass(frozen=True, slots=True, kw_only=True)
class Connection:
    """How the real device is reached; texts as written, or the port of the tool connector that it goes ``through``."""

    host: str
    nic: str | None
    address: str | None
    port: str | None
    through: str | None


@dataclass(frozen=True, slots=True, kw_only=True)
class LimitShares:
    """Shares of the device's own limits that the cell allows; one that only tightens lies between 0 and 1."""

    velocity: float = 1.0
    acceleration: float = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Stamp:
    """What a sensor stamps (``source`` is hardware, driver, arrival or UNKNOWN), and the clock that it stamps with."""

    source: str
    clock: Clock


@dataclass(frozen=True, slots=True, kw_only=True)
class Adapter:
    """Watchdog and bounds of a direct SDK; None where the spec leaves them to the default."""

    command_timeout_s: float | None = None
    stop_time_s: float | None = None
    goal_time_s: float | None = None
    path_tolerance: JointFigure | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class SimulatedJoint(Entity):
    """What the mock adds to ``joints``; ``name`` is the key in the spec, ``*`` for every joint that is commanded."""

    joints: tuple[str, ...]
    lag_s: float | None
    noise: JointFigure | None = None
    velocity: JointFigure | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Gripper:
    """A gripper as its joint moves it: positions and their tolerance in rad or m, the largest force in N.

    ``max_velocity`` is that of the joint as the jaws close at the device's own speed, in rad/s or m/s; None of none.
    """

    joint: str
    open: float
    closed: float
    max_force: float
    max_velocity: float | None
    goal_tolerance: float


@dataclass(frozen=True, slots=True, kw_only=True)
class FieldOfView:
    """What a stream can see: whole angles in rad, distances in m."""

    horizontal: float
    vertical: float
    nearest_m: float
    farthest_m: float


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraStream:
    """One image stream; ``frame`` is a prefixed link, ``view`` and ``image_bytes`` are None where not stated."""

    topic: str
    type: str
    info_topic: str
    frame: str
    rate_hz: float
    view: FieldOfView | None = None
    image_bytes: int | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Camera:
    """A camera by what it publishes."""

    streams: tuple[CameraStream, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class OfferedInterface:
    """What a driver offers whether the spec names it or not; ``node`` is the full name of the node behind it.

    ``effect`` is what a call does where it acts past every controller.
    """

    kind: InterfaceKind
    name: str
    type: str
    node: str
    effect: Effect | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class VendorMount:
    """How the vendor hangs a device on an arm of one model: on its frame of a short name, in this pose."""

    model: str
    frame: str
    pose: Pose


@dataclass(frozen=True, slots=True, kw_only=True)
class NetworkNeeds:
    """What a device asks: ``realtime`` is required, recommended or not_needed; its driver ``listens`` on ports."""

    dedicated_link: bool
    realtime: str
    listens: tuple[int, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Packages:
    """Packages or libraries of the vendor as they stand in the version tuple, or None."""

    driver: str | None = None
    sdk: str | None = None
    description: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Device(Entity):
    """A robot, gripper or sensor where it is.

    Args:
        model, vendor, kind: as the catalog names them.
        architecture: who owns the command path: ros2, direct_sdk or hybrid.
        description: links and joints with the prefix applied; frames as URDF.
        vendor_description: that of the vendor's package, whose shapes the links have; None where none is known.
        root_link: prefixed root link; its pose in ``parent_frame`` is ``transform_root_to_parent``.
        frames: short names of the catalog and local link names → prefixed link names.
        mounted_on: the day on which it was mounted for the last time; None where the spec does not say.
        vendor_mounts: how its vendor mounts it on arms, where the catalog has it.
        joints: movable joints in the order of the description, mimic joints included.
        driver: what moves it on the real target where no component of ros2_control does.
        tool_frame: prefixed link where tools mount, for an arm.
        carries: devices mounted on this one, directly or on a frame of it.
        host: the computer that runs its driver; empty where the cell names none.
        versions, connection, initial_state, limit_shares, stamp, adapter, simulated_joints: what the spec states of it.
        exposure_s: exposure time of what it measures: of the spec, else of the catalog, else zero.
        payload, tcp, program, collision, impedance: settings of its own controller, and who starts the program there.
        robot: the settings that its own controller has.
        tool_connector: what the connector at its tool frame supplies; None where the spec says nothing.
        plug: what it takes from the tool connector of a robot, where the catalog has it.
        programs: what runs on its host for it on the real target, and is no node.
        home: prefixed joint → position where the catalog says a mock begins.
        optical_frames: short names of frames that look along z.
        kinematics: whose joints the description has; None where robots of the type do not differ.
        payload_limit_kg: what may hang on the flange, tool included.
        repeatability_m: pose repeatability of its tip (ISO 9283); None where the catalog has none.
        update_rates_hz: those that the device accepts; any where empty.
        controller_kinds: kinds of controllers that only this device has.
        speed_scaling: full name of the state interface that reports how far trajectories are slowed down.
        offers: what the driver offers whether the spec names it or not.
        starts: full name of a node of the driver → what the start of its process does.
        version_rows: the matrix of versions that go together.
        record: where the record of an attempt has fields from that the real one alone can tell.
        jog: how people move one joint where the driver cannot run meanwhile; None where it can.
        commissioning: what people do at the real one, in the vendor's order.
        allowed_collisions: pairs of links, prefix applied, whose contact is not looked for.
        excused: codes of findings on its description that its folder excuses, and why.
        mock_cannot_prove: what no mock shows of it.
    """

    model: str
    vendor: str
    kind: str
    description: Description
    root_link: str
    vendor_description: VendorDescription | None = None
    prefix: str = ""
    parent_frame: str = WORLD
    transform_root_to_parent: Pose = field(default_factory=identity)
    mounted_on: datetime.date | None = None
    vendor_mounts: tuple[VendorMount, ...] = ()
    frames: Mapping[str, str] = field(default_factory=dict)
    joints: tuple[DeviceJoint, ...] = ()
    hardware: HardwareComponent | None = None
    driver: DeviceDriver | None = None
    tool_frame: str | None = None
    architecture: str = "ros2"
    carries: tuple[str, ...] = ()
    versions: DeviceVersions = field(default_factory=DeviceVersions)
    connection: Connection | None = None
    initial_state: str | None = None
    host: str = ""
    limit_shares: LimitShares = field(default_factory=LimitShares)
    stamp: Stamp | None = None
    exposure_s: float = 0.0
    payload: Payload | None = None
    tcp: str | None = None
    program: RobotProgram | None = None
    collision: CollisionThresholds | None = None
    impedance: Impedance | None = None
    robot: RobotFacts = field(default_factory=RobotFacts)
    tool_connector: ToolConnector | None = None
    plug: Plug | None = None
    programs: tuple[HostProgram, ...] = ()
    kinematics: Kinematics | None = None
    adapter: Adapter | None = None
    simulated_joints: tuple[SimulatedJoint, ...] = ()
    home: Mapping[str, float] = field(default_factory=dict)
    optical_frames: tuple[str, ...] = ()
    payload_limit_kg: float | None = None
    repeatability_m: float | None = None
    update_rates_hz: tuple[float, ...] = ()
    controller_kinds: tuple[str, ...] = ()
    speed_scaling: str | None = None
    gripper: Gripper | None = None
    camera: Camera | None = None
    switched: Switched | None = None
    offers: tuple[OfferedInterface, ...] = ()
    starts: Mapping[str, Effect] = field(default_factory=dict)
    network: NetworkNeeds | None = None
    safety: VendorSafety = field(default_factory=VendorSafety)
    packages: Packages = field(default_factory=Packages)
    record: tuple[RecordSource, ...] = ()
    jog: str | None = None
    commissioning: tuple[CommissioningStep, ...] = ()
    version_rows: tuple[VersionRow, ...] = ()
    allowed_collisions: tuple[tuple[str, str], ...] = ()
    excused: Mapping[str, str] = field(default_factory=dict)
    mock_cannot_prove: tuple[str, ...] = ()

    def joint(self, name: str) -> DeviceJoint:
        """Return a joint by its prefixed name.

        Raises:
            KeyError: the name is unknown.
        """
        for joint in self.joints:
            if joint.name == name:
                return joint
        raise KeyError(name)

    @property
    def startup_state(self) -> str:
        """Lifecycle state in which the controller manager starts its component, on every target."""
        if self.initial_state is not None or self.hardware is None:
            return self.initial_state or "active"
        return "unconfigured" if self.hardware.moves_as_it_is_activated else self.hardware.initial_state

    @property
    def unknown_effects(self) -> tuple[str, ...]:
        """The moments at which the real device starts, and with no statement of what they do in the world."""
        activation = self.hardware is not None and not self.hardware.is_activation_known
        start = self.driver is not None and self.driver.node not in self.starts
        return (*(("the activation",) if activation else ()), *(("the start of the driver",) if start else ()))

    @property
    def is_only_switched(self) -> bool:
        """Whether outputs of others switch it and no program runs in it or for it: it has no firmware and no driver."""
        return self.switched is not None and self.hardware is None and self.driver is None

    @property
    def is_driven(self) -> bool:
        """Whether hardware of ros2_control or a node of its own reaches its drives, which the stop cuts off."""
        return self.hardware is not None or self.driver is not None

    @property
    def actuated_joints(self) -> tuple[DeviceJoint, ...]:
        """Joints with a command interface."""
        return tuple(joint for joint in self.joints if joint.command_interfaces)

    @property
    def topics(self) -> Mapping[str, str]:
        """Topics that the driver publishes → their types, camera streams included."""
        streams = () if self.camera is None else self.camera.streams
        types = {offer.name: offer.type for offer in self.offers if offer.kind is InterfaceKind.TOPIC}
        types |= {stream.topic: stream.type for stream in streams}
        return types | {stream.info_topic: _CAMERA_INFO for stream in streams}

    def simulated(self, joint: str) -> tuple[SimulatedJoint, ...]:
        """Return what the mock adds to a joint: what is said of it alone before what is said of all."""
        matching = [item for item in self.simulated_joints if joint in item.joints]
        return tuple(sorted(matching, key=lambda one: one.name == EVERY_JOINT))
