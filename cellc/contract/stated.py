"""What a spec states and the compiler uses as it is written: one model each, of the spec and of the cell.

The keys, their words and defaults are declared here alone; ``link`` hands the models on. What needs a unit, a name to
be bound, or a default of the catalog, has a model in ``compiler/spec/`` and an entity in ``compiler/cell/``.
"""

from typing import Annotated, ClassVar, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from cellc.contract.pins import day_of
from cellc.contract.vocabulary import UNKNOWN

NAME_PATTERN = r"^[A-Za-z][A-Za-z0-9_]*$"

# Device, controller, node and interface tokens end up in ROS graph names: one token of `[A-Za-z_][A-Za-z0-9_]*`.
Name = Annotated[str, StringConstraints(pattern=NAME_PATTERN, max_length=64)]

# A pinned version, an image digest or UNKNOWN; what is written is judged by rules, not by shape.
Pin = Annotated[str, StringConstraints(min_length=1, max_length=200)]

Text = Annotated[str, StringConstraints(min_length=1, max_length=500)]


class StatedModel(BaseModel):
    """A part of the spec as written: strict, frozen, no unknown keys."""

    model_config = ConfigDict(strict=True, frozen=True, extra="forbid", defer_build=True)

    SHARED_AFTER: ClassVar[str] = ""
    """The own key behind which a file has those that the model shares with its kin; empty where they come first."""


class Rollback(StatedModel):
    """What to go back to when a new configuration fails."""

    image: Pin = Field(UNKNOWN, description="Digest of the last workstation image that ran.", examples=["sha256:9f2c"])
    configuration: Pin = Field(
        UNKNOWN, description="Configuration id of the last cell that ran.", examples=["cfg-4d1e0a77b2c9"]
    )


class Versions(StatedModel):
    """The pinned tuple. UNKNOWN is a legal answer; it blocks the real target and is listed in the audit."""

    os: Pin = Field(UNKNOWN, description="Operating system and release.", examples=["ubuntu 24.04"])
    kernel: Pin = Field(
        UNKNOWN, description="Kernel release as `uname -r` prints it.", examples=["6.8.1-1015-realtime"]
    )
    ros: Pin = Field(..., description="ROS 2 distribution: humble, jazzy, kilted or lyrical.", examples=["jazzy"])
    rmw: Pin = Field(UNKNOWN, description="RMW implementation and its version.", examples=["rmw_fastrtps_cpp 8.4.4"])
    ros2_control: Pin = Field(UNKNOWN, description="Version of ros2_control.", examples=["4.47.0"])
    moveit: Pin = Field(UNKNOWN, description="Version of MoveIt 2.", examples=["2.12.4"])
    rollback: Rollback = Field(
        default_factory=Rollback,
        description="Image and configuration to go back to.",
        examples=[{"image": "sha256:9f2c", "configuration": "cfg-4d1e0a77b2c9"}],
    )

    @property
    def rmw_name(self) -> str:
        """The middleware without its version, such as ``rmw_fastrtps_cpp``."""
        return self.rmw.split()[0]


class DiscoveryServer(StatedModel):
    """A discovery server of Fast DDS, which every node of the cell asks who else is there."""

    host: Name = Field(..., description="The host that it runs on.", examples=["control_pc"])
    nic: Name | None = Field(
        None, description="The card that it listens on; the first that carries no control if absent.", examples=["cell"]
    )
    port: int = Field(11811, ge=1024, le=65535, description="The UDP port that it listens on.", examples=[11811])


class Network(StatedModel):
    """How the nodes of the cell find each other."""

    domain_id: int = Field(0, description="ROS_DOMAIN_ID; 0 to 101 are safe on every platform.", examples=[42])
    discovery: Literal["multicast", "unicast", "server", "localhost", "off"] = Field(
        "multicast", description="Discovery of participants.", examples=["unicast"]
    )
    peers: tuple[Text, ...] = Field(
        (), description="Static peers of unicast discovery; hosts of the cell are added.", examples=[["10.10.0.11"]]
    )
    servers: tuple[DiscoveryServer, ...] = Field(
        (),
        description="Discovery servers of `discovery: server`; each node asks all of them.",
        examples=[[{"host": "control_pc"}]],
    )


class ResponsibilityOwners(StatedModel):
    """The eight responsibilities that every architecture has; UNKNOWN blocks the real target."""

    frames: Text = Field(UNKNOWN, description="Owner of frames and calibrations.", examples=["perception"])
    time: Text = Field(UNKNOWN, description="Owner of clocks and stamps.", examples=["perception"])
    limits: Text = Field(UNKNOWN, description="Owner of limits.", examples=["controls"])
    watchdogs: Text = Field(UNKNOWN, description="Owner of watchdogs and timeouts.", examples=["controls"])
    command: Text = Field(UNKNOWN, description="Owner of the command path.", examples=["integration"])
    logging: Text = Field(UNKNOWN, description="Owner of logs and attempt records.", examples=["data"])
    vendor_safety: Text = Field(UNKNOWN, description="Owner of the vendor's safety configuration.", examples=["robot"])
    physical_stop: Text = Field(UNKNOWN, description="Owner of the physical stop.", examples=["safety"])


class ApprovalOwners(StatedModel):
    """The seven approval areas of the checkpoint; UNKNOWN blocks the real target."""

    graph: Text = Field(
        UNKNOWN, description="Is there one command publisher or action server?", examples=["integration"]
    )
    time_tf: Text = Field(
        UNKNOWN, description="Which stamp and calibration produced the goal?", examples=["perception"]
    )
    controller: Text = Field(
        UNKNOWN, description="Are joints, interfaces, tolerance and hold defined?", examples=["controls"]
    )
    vendor: Text = Field(UNKNOWN, description="Are firmware, driver, mode and scaling pinned?", examples=["robot"])
    network: Text = Field(UNKNOWN, description="Do discovery and data use controlled paths?", examples=["network"])
    safety: Text = Field(UNKNOWN, description="Are stop, recovery and observer independent?", examples=["safety"])
    data: Text = Field(UNKNOWN, description="Can failures be replayed by layer?", examples=["data"])


class Owners(StatedModel):
    """Owners by responsibility and by approval area."""

    responsibilities: ResponsibilityOwners = Field(
        default_factory=ResponsibilityOwners,
        description="Owner of each responsibility.",
        examples=[{"frames": "perception"}],
    )
    approvals: ApprovalOwners = Field(
        default_factory=ApprovalOwners, description="Owner of each approval area.", examples=[{"graph": "integration"}]
    )


class Stop(StatedModel):
    """Who stops the machine, and by which path."""

    authority: Text = Field(
        UNKNOWN, description="What has the authority to stop; never a computer of the cell.", examples=["safety_plc"]
    )
    path: Literal["hardwired", "safety_bus", "software", "UNKNOWN"] = Field(
        UNKNOWN, description="How the stop reaches the drives.", examples=["hardwired"]
    )
    independent_of: tuple[Name, ...] = Field(
        (), description="Hosts that the path does not need.", examples=[["control_pc"]]
    )
    evidence: tuple[Text, ...] = Field((), description="What proves it.", examples=[["injected-stop result"]])


class RobotProgram(StatedModel):
    """The program on the robot's own controller through which set points pass."""

    played_by: Text = Field(
        ..., description="Role of the person who starts it, or `driver` where it does.", examples=["operator"]
    )
    mode: Literal["local", "remote"] = Field(
        "local", description="Whether it is started at the device, or from elsewhere.", examples=["local"]
    )


class HardwareStatement(StatedModel):
    """What somebody signs of a plugin or program that `device.yaml` has run on the mock; UNKNOWN signs nothing."""

    touches_no_hardware: bool = Field(..., description="Whether it opens no connection to a device.", examples=[True])
    by: Text = Field(UNKNOWN, description="Who says so.", examples=["controls"])
    date: Pin = Field(UNKNOWN, description="Since when, YYYY-MM-DD.", examples=["2026-07-01"])

    @property
    def is_signed(self) -> bool:
        """Whether somebody says, with a date, that it touches no hardware."""
        return self.touches_no_hardware and day_of(self.date) is not None and self.by.strip() not in ("", UNKNOWN)


class OpenUntil(StatedModel):
    """Who finds something out, and by when."""

    person: Text = Field(..., description="Person or role.", examples=["integration"])
    date: Pin = Field(..., description="Day by which it is known, YYYY-MM-DD.", examples=["2026-12-01"])

    @property
    def is_named(self) -> bool:
        """Whether it names somebody and a day."""
        return day_of(self.date) is not None and self.person.strip() not in ("", UNKNOWN)


class Surrounding(StatedModel):
    """What is known of one part of the surroundings; with `open` the rest is a question."""

    shapes: tuple[Name, ...] = Field((), description="Things of `scene` that are it.", examples=[["table"]])
    none: Text | None = Field(
        None, description="Why there is nothing of it within reach.", examples=["the nearest is 4 m away"]
    )
    open: OpenUntil | None = Field(
        None,
        description="Who finds it out, by when.",
        examples=[{"person": "integration", "date": "2026-12-01"}],
    )

    @property
    def is_stated(self) -> bool:
        """Whether it says something: shapes, why there is nothing, or who finds it out."""
        return bool(self.shapes or self.none or (self.open is not None and self.open.is_named))


class Surroundings(StatedModel):
    """What is around the arms within their reach; what is not stated blocks the real target."""

    support: Surrounding = Field(
        default_factory=Surrounding,
        description="What carries each arm; something of it ends at its mount.",
        examples=[{"shapes": ["table"]}],
    )
    floor: Surrounding = Field(default_factory=Surrounding, description="The floor.", examples=[{"shapes": ["floor"]}])
    walls: Surrounding = Field(
        default_factory=Surrounding,
        description="Walls, fences and the ceiling.",
        examples=[{"none": "the nearest is 4 m away"}],
    )
    fittings: Surrounding = Field(
        default_factory=Surrounding,
        description="Brackets and cables, on the arms and beside them.",
        examples=[{"open": {"person": "integration", "date": "2026-12-01"}}],
    )
