"""Devices of a cell with everything that the catalog knows of them bound and prefixed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field, fields
from typing import Annotated

from cellc.compiler.catalog.version_rows import VersionRow
from cellc.compiler.cell.body import Body, Mount
from cellc.compiler.cell.entity import ELSEWHERE, STATED, Entity, Part
from cellc.compiler.cell.hardware import DeviceControl
from cellc.compiler.cell.robot import HostProgram, RobotController
from cellc.compiler.cell.site import Clock, JointFigure
from cellc.compiler.cell.switched import Switched
from cellc.compiler.cell.vendor import Procedures
from cellc.contract.frozen import dataclass
from cellc.contract.grading import Graded, Rule
from cellc.contract.vocabulary import UNKNOWN, InterfaceKind, ReviewArea

EVERY_JOINT = "*"
"""Name of what the mock adds to every joint that is commanded."""

_CAMERA_INFO = "sensor_msgs/msg/CameraInfo"

_REACHES = "the arm reaches where people at the cell do not expect it"


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

    def items(self) -> Iterator[tuple[str, str]]:
        """Yield each part by its name."""
        return ((field.name, getattr(self, field.name)) for field in fields(self))


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
class SimulatedJoint(Entity):
    """What the mock adds to ``joints``; ``name`` is the key in the spec, ``*`` for every joint that is commanded."""

    joints: tuple[str, ...]
    lag_s: float | None
    noise: JointFigure | None = None
    velocity: JointFigure | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Gripper:
    """A gripper as its joint moves it: positions and their tolerance in rad or m, the largest force in N.

    Its jaws are ``stroke_m`` apart when open; ``swing`` is the angle between their cranks and the fingers when
    closed, None of jaws that slide.

    ``max_velocity`` is that of the joint as the jaws close at the stated speed, else at their own, in rad/s or m/s;
    None of none. ``grip_speed_m_s`` and ``grip_force`` (N) are what the spec states; the hardware can be set from
    ``min_force`` on, and its jaws move at ``max_speed_m_s``.
    """

    joint: str
    open: float
    closed: float
    max_force: float
    max_velocity: float | None
    goal_tolerance: float
    stroke_m: float
    swing: float | None
    max_speed_m_s: float = 0.0
    min_force: float | None = None
    grip_speed_m_s: float | None = None
    grip_force: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class FieldOfView:
    """What a stream can see: whole angles in rad, distances in m."""

    horizontal: float
    vertical: float
    nearest_m: float
    farthest_m: float


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraStream:
    """One image stream; ``frame`` is a prefixed link, and what the catalog does not state of the images is None."""

    topic: str
    type: str
    info_topic: str
    frame: str
    rate_hz: float
    view: FieldOfView | None = None
    image_bytes: int | None = None
    pixels: tuple[int, int] | None = None
    encoding: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Camera:
    """A camera by what it publishes."""

    streams: tuple[CameraStream, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class NetworkNeeds:
    """What a device asks: ``realtime`` is required, recommended or not_needed; its driver ``listens`` on ports.

    It answers only while its drives are ``powered``, where that is so. A device that is reached ``by_carrier`` has no
    address of its own. The vendor's launch files expect the model at its ``usual_port``, None where they name none.
    """

    dedicated_link: bool
    by_carrier: bool
    usual_port: str | None
    powered: bool
    realtime: str
    listens: tuple[int, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Packages:
    """Packages or libraries of the vendor as they stand in the version tuple, or None.

    Args:
        sdk_package: the ROS package whose version is that of ``sdk``; None where none has it.
        sdk_debian: the Debian package that has it instead; without either the build of the driver fetches ``sdk``.
    """

    driver: str | None = None
    sdk: str | None = None
    description: str | None = None
    sdk_package: str | None = None
    sdk_debian: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceSite(Part):
    """Where the driver of a device runs, and how it reaches the device.

    Args:
        host: the computer that runs its driver; empty where the cell names none.
        network: what the device asks of its network; None where the catalog says nothing.
        programs: what runs on its host for it on the real target, and is no node.
    """

    host: str = ""
    connection: Annotated[Connection | None, STATED] = None
    network: Annotated[NetworkNeeds | None, ELSEWHERE] = None
    programs: Annotated[tuple[HostProgram, ...], ELSEWHERE] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Software(Part):
    """What the version tuple has of a device: pins as written, and the matrix of versions that go together."""

    versions: DeviceVersions = field(default_factory=DeviceVersions)
    packages: Annotated[Packages, ELSEWHERE] = field(default_factory=Packages)
    version_rows: Annotated[tuple[VersionRow, ...], ELSEWHERE] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Sensing(Part):
    """What a sensor measures; ``exposure_s`` is that of the spec, else of the catalog, else zero."""

    stamp: Annotated[Stamp | None, Graded(ReviewArea.TIME, "stamp")] = None
    exposure_s: Annotated[float, ELSEWHERE] = 0.0
    camera: Annotated[Camera | None, ELSEWHERE] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceLimits(Part):
    """What a device may do as a whole; figures are None where the catalog tells none.

    Args:
        payload_limit_kg: what may hang on the flange, tool included.
        reach_m: from the axis of the first joint, as its vendor gives it.
        repeatability_m: pose repeatability of its tip (ISO 9283).
        tilt_rad: how far from upright its controller compensates gravity.
    """

    limit_shares: LimitShares = field(default_factory=LimitShares)
    payload_limit_kg: Annotated[
        float | None, ELSEWHERE, Graded(ReviewArea.PAYLOAD, "largest payload", Rule.FEWER, "kg", share=False)
    ] = None
    reach_m: Annotated[
        float | None, ELSEWHERE, Graded(ReviewArea.LIMITS, "reach", Rule.MORE, "m", why=_REACHES, share=False)
    ] = None
    repeatability_m: Annotated[float | None, ELSEWHERE] = None
    tilt_rad: Annotated[float | None, ELSEWHERE] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceMock(Part):
    """A device on the mock.

    Args:
        home: prefixed joint → position in rad or m where the catalog says a mock begins.
        mock_cannot_prove: what no mock shows of it.
    """

    home: Annotated[Mapping[str, float], ELSEWHERE] = field(default_factory=dict)
    simulated_joints: Annotated[tuple[SimulatedJoint, ...], STATED] = ()
    mock_cannot_prove: Annotated[tuple[str, ...], ELSEWHERE] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Device(Entity):
    """A robot, gripper or sensor where it is.

    Args:
        model, vendor, kind: as the catalog names them.
        architecture: who owns the command path: ros2, direct_sdk or hybrid.
        joints: movable joints in the order of the description, mimic joints included.
        gripper, switched: what a gripper, and what a device that outputs switch has besides.
    """

    model: Annotated[str, STATED]
    vendor: Annotated[str, ELSEWHERE]
    kind: Annotated[str, ELSEWHERE]
    architecture: Annotated[str, STATED] = "ros2"
    body: Body
    joints: tuple[DeviceJoint, ...] = ()
    mount: Mount = field(default_factory=Mount)
    control: DeviceControl = field(default_factory=DeviceControl)
    site: DeviceSite = field(default_factory=DeviceSite)
    software: Software = field(default_factory=Software)
    robot: RobotController = field(default_factory=RobotController)
    sensing: Sensing = field(default_factory=Sensing)
    gripper: Annotated[Gripper | None, ELSEWHERE] = None
    switched: Switched | None = None
    limits: DeviceLimits = field(default_factory=DeviceLimits)
    procedures: Procedures = field(default_factory=Procedures)
    mock: DeviceMock = field(default_factory=DeviceMock)

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
    def is_only_switched(self) -> bool:
        """Whether outputs of others switch it and no program runs in it or for it: it has no firmware and no driver."""
        return self.switched is not None and not self.control.is_driven

    @property
    def actuated_joints(self) -> tuple[DeviceJoint, ...]:
        """Joints with a command interface."""
        return tuple(joint for joint in self.joints if joint.command_interfaces)

    @property
    def topics(self) -> Mapping[str, str]:
        """Topics that the driver publishes → their types, camera streams included."""
        streams = () if self.sensing.camera is None else self.sensing.camera.streams
        types = {offer.name: offer.type for offer in self.control.offers if offer.kind is InterfaceKind.TOPIC}
        types |= {stream.topic: stream.type for stream in streams}
        return types | {stream.info_topic: _CAMERA_INFO for stream in streams}

    def simulated(self, joint: str) -> tuple[SimulatedJoint, ...]:
        """Return what the mock adds to a joint: what is said of it alone before what is said of all."""
        matching = [item for item in self.mock.simulated_joints if joint in item.joints]
        return tuple(sorted(matching, key=lambda one: one.name == EVERY_JOINT))
