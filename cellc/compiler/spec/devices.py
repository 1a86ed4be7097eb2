"""Robots, grippers and sensors of the cell."""

from typing import Annotated, Literal

from pydantic import Field, StringConstraints

from cellc.compiler.spec.base import Day, FrameReference
from cellc.compiler.spec.quantity import (
    Drift,
    Duration,
    Force,
    JointDampings,
    JointPosition,
    JointStiffnesses,
    JointVelocity,
    Position,
    PositiveDuration,
    Ratio,
    RollPitchYaw,
    TimeShift,
    Velocity,
)
from cellc.compiler.spec.robot import CollisionSpec, ImpedanceSpec, PayloadSpec
from cellc.compiler.spec.tool import ToolConnectorSpec
from cellc.contract.stated import Name, Pin, RobotProgram, StatedModel, Text
from cellc.contract.vocabulary import UNKNOWN


class PlacementSpec(StatedModel):
    """Where something sits: a parent frame and a fixed transform."""

    parent: FrameReference = Field(
        ..., description="Parent frame: `world`, a frame, or `device/link`.", examples=["arm/tool0"]
    )
    xyz: Position | None = Field(
        None, description="Translation in the parent frame; zero if absent.", examples=["0 0 0.8 m"]
    )
    rpy: RollPitchYaw | None = Field(
        None, description="Fixed-axis roll, pitch, yaw in the parent frame (REP-103).", examples=["0 0 90 deg"]
    )
    calibration: Name | None = Field(
        None, description="Calibration that measured this transform; absent for a designed one.", examples=["hand_eye"]
    )


class MountSpec(PlacementSpec):
    """Where a device sits, and since when."""

    since: Day | None = Field(
        None,
        description="Day on which it was mounted, or taken off and mounted again, for the last time.",
        examples=["2026-06-30"],
    )


Credentials = Annotated[
    str, StringConstraints(pattern=r"^([A-Z][A-Z0-9_]*|(/[A-Za-z0-9_][A-Za-z0-9_.-]*)+)$", max_length=200)
]
"""Prefix of two environment variables, or a file: where user name and password are, never what they are."""


class ConnectionSpec(StatedModel):
    """How the real device is reached; never used by a mock or simulated target."""

    host: Name = Field(..., description="Host that runs the driver.", examples=["control_pc"])
    nic: Name | None = Field(None, description="Network card of that host.", examples=["robot"])
    address: Text | None = Field(None, description="IPv4 address of the device.", examples=["192.168.56.101"])
    port: Text | None = Field(
        None, description="Serial or bus device for one without an address.", examples=["/dev/ttyUSB0"]
    )
    through: Name | None = Field(
        None,
        description=("Robot from whose tool connector it has its power; its serial port too, where `port` is absent."),
        examples=["arm"],
    )
    credentials: Credentials | None = Field(
        None,
        description=(
            "Where its user name and password are as it is launched: `ARM` for the environment variables "
            "`ARM_USERNAME` and `ARM_PASSWORD`, or a YAML file with `username` and `password`; by its name if absent."
        ),
        examples=["ARM"],
    )
    first_port: int | None = Field(
        None,
        description="First of the ports of the host on which its driver listens; free ones if absent.",
        examples=[50101],
        ge=1024,
        le=65500,
    )


class TighterLimitsSpec(StatedModel):
    """Limits of this cell as a share of the device's own; they may only tighten."""

    velocity: Ratio | None = Field(None, description="Share of the device's joint velocities.", examples=["50 %"])
    acceleration: Ratio | None = Field(
        None, description="Share of the device's joint accelerations.", examples=["50 %"]
    )


class StampSpec(StatedModel):
    """Where a sensor's time stamps come from."""

    source: Literal["hardware", "driver", "arrival", "UNKNOWN"] = Field(
        UNKNOWN,
        description="What is stamped: exposure in hardware, the driver's read, or arrival.",
        examples=["hardware"],
    )
    clock: Text = Field(UNKNOWN, description="Clock domain of the stamps.", examples=["camera"])
    exposure: Duration | None = Field(None, description="Exposure time.", examples=["8 ms"])
    synchronized_by: Text | None = Field(
        None, description="What ties the clock to the host's.", examples=["global_time"]
    )
    max_offset: Duration | None = Field(None, description="Bound of the offset to the host's clock.", examples=["1 ms"])
    simulated_offset: TimeShift | None = Field(
        None, description="Offset that the mock gives this clock; none if absent.", examples=["0.5 ms"]
    )
    simulated_drift: Drift | None = Field(
        None, description="Drift that the mock gives this clock, up to `max_offset`.", examples=["20 ppm"]
    )


class KinematicsSpec(StatedModel):
    """Where the joints of this very robot stand, as its vendor's tool has read it off."""

    file: Text = Field(
        ..., description="What the tool wrote, beside this file or below.", examples=["arm_kinematics.yaml"]
    )
    measured: Pin = Field(UNKNOWN, description="Date on which it was read, YYYY-MM-DD.", examples=["2026-07-01"])
    owner: Text = Field(UNKNOWN, description="Person or role responsible for it.", examples=["robot"])


class AdapterSpec(StatedModel):
    """The adapter of a direct SDK: the program that it is, and what guards its commands."""

    run: Pin = Field(
        UNKNOWN,
        description="Package and executable of its managed node, which has the name of the device. Configured it "
        "reads, active it takes goals. It runs on the real target alone, with the parameters `address` or `port`, and "
        "in rad, m and s `joints` and the four that stand here.",
        examples=["my_arm_adapter/adapter"],
    )
    command_timeout: TimeShift | None = Field(
        None, description="Watchdog: silence after which the device stops.", examples=["20 ms"]
    )
    stop_time: TimeShift | None = Field(
        None, description="Longest time from a hold to standstill.", examples=["100 ms"]
    )
    goal_time: TimeShift | None = Field(
        None,
        description="Time past the end of a trajectory within which the device must be at standstill.",
        examples=["0.5 s"],
    )
    path_tolerance: JointPosition | None = Field(
        None, description="Largest distance of a joint from its command.", examples=["0.05 rad"]
    )
    stiffness: JointStiffnesses | None = Field(
        None,
        description="Of the springs by which its loop holds the joints, in the order of the description; how far they "
        "droop is not known if absent.",
        examples=["600 600 600 600 250 150 50 N m/rad"],
    )
    damping: JointDampings | None = Field(
        None,
        description="By which its loop brakes their errors; no lag if absent.",
        examples=["30 30 30 30 10 10 5 N m s/rad"],
    )


class SwitchingSpec(StatedModel):
    """How a device of a few states is wired, and what it does without power."""

    outputs: dict[Name, Text] = Field(
        default_factory=dict,
        description="Its outputs → the command interface that drives each, as `device/gpio/interface`.",
        examples=[{"valve": "plc/io/out_0"}],
    )
    inputs: dict[Name, Text] = Field(
        default_factory=dict,
        description="Its sensors → the state interface that reads each, as `device/gpio/interface`.",
        examples=[{"closed": "plc/io/in_0"}],
    )
    starts: Name | None = Field(
        None, description="State at power-up; the one with every output off if absent.", examples=["open"]
    )
    time: Duration | None = Field(
        None, description="Time from the output to the end of travel; none if absent.", examples=["150 ms"]
    )
    within: PositiveDuration | None = Field(
        None, description="How long its client waits for the sensors; 1 s if absent.", examples=["500 ms"]
    )
    power_lost: Literal["holds", "drops", "UNKNOWN"] = Field(
        UNKNOWN, description="What becomes of what it holds when air or power is lost.", examples=["holds"]
    )
    accepted_by: Text | None = Field(None, description="Who accepts that it drops what it holds.", examples=["safety"])


EVERY_JOINT = "*"
"""Key of `simulated_joints` for every joint that is commanded."""


class SimulatedJointSpec(StatedModel):
    """How a joint of the mock differs from one that follows its command without delay."""

    lag: TimeShift | None = Field(None, description="Time constant of a first-order lag.", examples=["20 ms"])
    noise: JointPosition | None = Field(
        None, description="Largest error of the measured position, evenly distributed.", examples=["0.0002 rad"]
    )
    velocity: JointVelocity | None = Field(
        None, description="Speed at which the joint saturates.", examples=["1.5 rad/s"]
    )


class GripSpec(StatedModel):
    """How a gripper takes a part: no faster and no stronger than its hardware can."""

    speed: Velocity | None = Field(
        None, description="Speed of one jaw relative to the other; as fast as it can if absent.", examples=["50 mm/s"]
    )
    force: Force | None = Field(
        None, description="Force between its jaws; as strong as it can if absent.", examples=["40 N"]
    )


class DeviceSpec(StatedModel):
    """One device: a catalog entry, where it is mounted, and the exact hardware."""

    model: Text = Field(
        ...,
        description="Catalog entry, or a folder beside this file with your own device.yaml.",
        examples=["./my_arm"],
    )
    prefix: str | None = Field(
        None,
        description="Put before every joint, link and interface name; `<device>_` if absent, may be empty.",
        pattern=r"^([A-Za-z][A-Za-z0-9_]*)?$",
        max_length=64,
        examples=["left_"],
    )
    mount: MountSpec | None = Field(
        None,
        description="Where the device's root link sits; `world` origin if absent.",
        examples=[{"parent": "world", "xyz": "0 0 0.8 m"}],
    )
    architecture: Literal["ros2", "direct_sdk", "hybrid"] = Field(
        "ros2", description="Who owns the command path down to the servo loop.", examples=["hybrid"]
    )
    adapter: AdapterSpec | None = Field(
        None,
        description="Program and watchdog of a direct SDK.",
        examples=[{"run": "my_arm_adapter/adapter", "command_timeout": "20 ms", "stop_time": "100 ms"}],
    )
    simulated_joints: dict[Text, SimulatedJointSpec] = Field(
        default_factory=dict,
        description="What the mock adds to joints, by their names in the description; `*` is every joint.",
        examples=[{"*": {"lag": "20 ms"}}],
    )
    revision: Pin = Field(UNKNOWN, description="Hardware revision.", examples=["UNKNOWN"])
    serial: Pin = Field(UNKNOWN, description="Serial number on the nameplate.", examples=["20235500001"])
    firmware: Pin = Field(UNKNOWN, description="Controller software or firmware.", examples=["controller 5.21.0"])
    driver: Pin = Field(UNKNOWN, description="ROS 2 driver package and version.", examples=["my_arm_driver 3.8.0"])
    sdk: Pin = Field(UNKNOWN, description="Vendor library and version.", examples=["my_arm_sdk 2.14.1"])
    description: Pin = Field(
        UNKNOWN, description="Description package and version.", examples=["my_arm_description 3.5.1"]
    )
    connection: ConnectionSpec | None = Field(
        None,
        description="How the real device is reached.",
        examples=[{"host": "control_pc", "nic": "robot", "address": "192.168.56.101"}],
    )
    limits: TighterLimitsSpec | None = Field(
        None, description="Tighter joint limits of this cell.", examples=[{"velocity": "50 %", "acceleration": "50 %"}]
    )
    stamp: StampSpec | None = Field(
        None,
        description="Time stamps of a sensor.",
        examples=[{"source": "hardware", "clock": "camera", "exposure": "8 ms"}],
    )
    calibration: KinematicsSpec | None = Field(
        None,
        description="Kinematics of this very robot; those of its type if absent, which keeps the real cell closed.",
        examples=[{"file": "arm_kinematics.yaml", "measured": "2026-07-01", "owner": "robot"}],
    )
    initial_state: Literal["unconfigured", "inactive", "active"] | None = Field(
        None,
        description="State in which its hardware component starts; the vendor's default if absent.",
        examples=["inactive"],
    )
    payload: PayloadSpec | None = Field(
        None,
        description="Load set in the arm, tool included.",
        examples=[{"mass": "0.93 kg", "center_of_mass": "0 0 58 mm"}],
    )
    grip: GripSpec | None = Field(
        None, description="Speed and force of a gripper.", examples=[{"speed": "50 mm/s", "force": "40 N"}]
    )
    switching: SwitchingSpec | None = Field(
        None,
        description="Wiring of a device that digital outputs switch.",
        examples=[{"outputs": {"valve": "plc/io/out_0"}, "inputs": {"closed": "plc/io/in_0"}, "power_lost": "holds"}],
    )
    tcp: FrameReference | None = Field(
        None, description="Frame at which the robot's own controller holds its TCP.", examples=["tcp"]
    )
    program: RobotProgram | None = Field(
        None,
        description="Who starts the program on the robot's own controller; a person at the device if absent.",
        examples=[{"played_by": "operator", "mode": "local"}],
    )
    impedance: ImpedanceSpec | None = Field(
        None,
        description="How stiff the robot's own controller holds what it is commanded; as the robot has it if absent.",
        examples=[{"joint": "3000 3000 3000 2500 2500 2000 2000 N m/rad"}],
    )
    tool_connector: ToolConnectorSpec | None = Field(
        None,
        description="What the connector at the robot's tool frame gives.",
        examples=[{"voltage": "24 V", "serial": {"port": "/run/user/1000/arm_tool", "baud_rate": 115200}}],
    )
    collision: CollisionSpec | None = Field(
        None,
        description="Thresholds at which the robot's own controller sees a collision.",
        examples=[
            {
                "torque": {"lower": "25 25 22 20 19 17 14 N m", "upper": "35 35 32 30 29 27 24 N m"},
                "force": {"lower": "30 30 30 N", "upper": "40 40 40 N"},
                "moment": {"lower": "25 25 25 N m", "upper": "35 35 35 N m"},
            }
        ],
    )
