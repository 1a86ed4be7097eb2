"""``contract.json``: the cell as its artifacts promise it, for the mock, for tools and for people.

Everything is resolved: full ROS names, SI and radians. What is at the default that the schema states, null most of
all, is left out. The mock reads this file, the URDF and controllers.yaml that ros2_control would read, the pairs of the
SRDF, and nothing of the compiler.
"""

from typing import Literal

from pydantic import Field

from cellc.contract.base import ContractModel, ContractPose
from cellc.contract.control_law import ControlLaw
from cellc.contract.entities import TARGETS, ContractInterface, HardwareState, Kpis, Target
from cellc.contract.file_names import BesidePath, CellName, InnerPath
from cellc.contract.quantities import (
    Coordinate,
    Count,
    Drift,
    Magnitude,
    Offset,
    Period,
    PositiveMagnitude,
    PositiveSeconds,
    Rate,
    Seconds,
)
from cellc.contract.vocabulary import Behavior, Distro, LeftBy, ManagerLock, Moment, Motion, Need, Unmet


class ContractFiles(ContractModel):
    """Paths inside the generated folder, with forward slashes."""

    urdf_mock: InnerPath = Field(description="Robot description for the mock.")
    urdf_real: InnerPath = Field(description="Robot description for the real cell.")
    parameters: dict[str, InnerPath] = Field(description="Parameter file of each controller manager, by manager.")
    srdf: InnerPath | None = Field(
        None, description="Pairs of links whose collision is not checked, for planning groups."
    )
    rehearsals: InnerPath = Field(description="What the mock executes.")
    bring_up: InnerPath = Field(description="Steps from processes to motion, of the mock and of the real target.")
    packages: tuple[BesidePath, ...] = Field(
        (), description="Folders beside this one in which packages of meshes lie, relative to that of the spec."
    )


class ContractCalibration(ContractModel):
    """A measurement that transforms rest on."""

    revision: Count = Field(description="Counts up with every measurement.")
    owner: str = Field(description="Person or role responsible for it.")


class ContractClock(ContractModel):
    """A clock that stamps are made on: of a host, or of a device with one of its own."""

    domain: str = Field(description="Clock domain.")
    synchronized_by: str | None = Field(None, description="What disciplines it.")
    max_offset_s: Seconds | None = Field(None, description="Bound of its offset; null where nothing bounds it.")
    simulated: bool = Field(False, description="Time comes from /clock.")
    offset_s: Offset = Field(0.0, description="Offset that the mock gives it.")
    drift: Drift = Field(0.0, description="Seconds that the mock lets it gain in a second, until the bound.")


class ContractFrame(ContractModel):
    """One TF frame; a pose in the robot description is not repeated here."""

    parent: str = Field(description="Parent frame; empty for the root.")
    authority: str = Field("robot_state_publisher", description="Who publishes the edge.")
    kind: Literal["world", "link", "mount", "fixed", "scene", "dynamic"] = Field(
        "link", description="Where the frame comes from."
    )
    moving: bool = Field(False, description="Published on /tf, not once on /tf_static.")
    pose: ContractPose | None = Field(None, description="Pose in the parent of a frame that no URDF holds.")
    calibration: str | None = Field(None, description="Calibration that measured it.")
    rate_hz: Rate | None = Field(None, description="Rate of a dynamic frame.")
    buffer_s: Seconds | None = Field(None, description="History that consumers keep.")
    simulated_parent: str | None = Field(None, description="Frame in which the mock puts what a dynamic frame follows.")
    simulated_pose: ContractPose | None = Field(None, description="Pose there.")


class ContractController(ContractModel):
    """A controller, what it claims, and who may command it."""

    plugin: str = Field(description="Type as the controller manager loads it.")
    behavior: Behavior = Field(description="What it does.")
    full_name: str = Field(description="Fully qualified name of its node.")
    targets: tuple[Target, ...] = Field(TARGETS, description="Targets on which it is loaded.")
    device: str | None = Field(None, description="Device whose joints it drives.")
    joints: tuple[str, ...] = Field(description="Joints in the controller's order.")
    command_interfaces: tuple[str, ...] = Field(description="Interfaces it claims, as `joint/interface`.")
    real_command_interfaces: tuple[str, ...] | None = Field(
        None, description="Interfaces it claims on real hardware, where those are others."
    )
    state_interfaces: tuple[str, ...] = Field(description="Interfaces it reads, as `joint/interface`.")
    active: bool = Field(description="Active after start-up.")
    client: str | None = Field(None, description="Name of the one node that may command it.")
    action: str | None = Field(None, description="Full name of its action.")
    action_type: str | None = Field(None, description="ROS type of its action.")
    real_action: str | None = Field(
        None, description="Action that takes its goals where it is not loaded on real hardware."
    )
    real_action_type: str | None = Field(None, description="ROS type of that action.")
    goal_time_s: Seconds | None = Field(
        None, description="Time allowed past the end of a trajectory; null or 0 for no limit. It bounds no whole goal."
    )
    on_violation: str = Field(description="What happens on a tolerance violation.")


class ContractSwitch(ContractModel):
    """A declared controller switch."""

    activate: tuple[str, ...] = Field(description="Controllers to activate.")
    deactivate: tuple[str, ...] = Field(description="Controllers to deactivate first.")


class ContractManager(ContractModel):
    """A controller manager."""

    namespace: str = Field(description="Namespace of the manager.")
    update_rate_hz: Rate = Field(description="Rate of read, update, write.")
    controllers: dict[str, ContractController] = Field(
        description="Controllers by name, by full name where managers share it."
    )
    switches: dict[str, ContractSwitch] = Field(description="Declared switches by name.")


class ContractGripper(ContractModel):
    """A gripper in its joint's units: rad or m."""

    joint: str = Field(description="Joint that is commanded.")
    controller: str | None = Field(
        None, description="Controller that moves it; by full name where managers share names."
    )
    open: Coordinate = Field(description="Position when open.")
    closed: Coordinate = Field(description="Position when closed on nothing.")
    max_effort: Magnitude = Field(description="Largest effort, N or Nm.")
    max_velocity: PositiveMagnitude | None = Field(
        None, description="Speed of the joint as the jaws move, rad/s or m/s; null where it is not stated."
    )


class ContractCamera(ContractModel):
    """The stream that perception uses."""

    topic: str = Field(description="Full name of the image topic.")
    frame: str = Field(description="Optical frame of the images.")
    rate_hz: Rate = Field(description="Frames a second.")
    exposure_s: Seconds = Field(description="Exposure time.")
    clock: str = Field(description="Clock domain of the stamps.")


class ContractDriver(ContractModel):
    """A driver's own node, which moves a device on real hardware past every controller manager."""

    node: str = Field(description="Full name of the node.")
    program: str = Field(description="Package and executable.")
    joint_states: str | None = Field(None, description="Topic on which its program publishes joints, before remapping.")


class ContractEffect(ContractModel):
    """What one moment in the life of a real device does in the world, as far as the mock plays it."""

    motion: Motion = Field(Motion.NONE, description="What moves.")
    lock: ManagerLock = Field(ManagerLock.NONE, description="For how long its controller manager is blocked.")
    needs: dict[Need, Unmet] = Field({}, description="What must hold before it, and what happens otherwise.")
    largest_step: PositiveMagnitude | None = Field(
        None, description="Distance of a set point that is still followed, rad or m; null without bound."
    )
    leaves: HardwareState | None = Field(
        None, description="State of the component afterwards; null for the one that was asked for."
    )
    ends: tuple[Need, ...] = Field((), description="What a claim needs and no longer has afterwards.")


class ContractStop(ContractModel):
    """A state in which a device stops by itself."""

    motion: Motion = Field(Motion.NONE, description="What moves.")
    leaves: HardwareState = Field(description="State of the component meanwhile.")
    ends: tuple[Need, ...] = Field((), description="What a claim needs and does not have meanwhile.")
    left_by: LeftBy = Field(description="What ends it once its cause is gone.")


class ContractSwitched(ContractModel):
    """A device of a few states that digital outputs switch, or that its sensors tell."""

    states: dict[str, dict[str, bool]] = Field(description="What the sensors that are wired read in each state.")
    starts: str = Field(description="State at power-up.")
    time_s: Seconds = Field(0.0, description="Time from its outputs to the end of its way.")
    within_s: PositiveSeconds = Field(description="How long its client waits for the sensors.")
    holds: str | None = Field(None, description="State in which it holds a part or a tool.")
    outputs: dict[str, str] = Field({}, description="Command interface that drives each output.")
    inputs: dict[str, str] = Field({}, description="State interface that reads each sensor.")


class ContractDevice(ContractModel):
    """A device as the mock needs it."""

    model: str = Field(description="Catalog entry.")
    kind: str = Field(description="Kind of device.")
    prefix: str = Field(description="Put before its joint and link names.")
    root_link: str = Field(description="Link that is mounted.")
    architecture: str = Field("ros2", description="Who owns the command path.")
    hardware_component: str | None = Field(None, description="Name of its ros2_control component.")
    driver: ContractDriver | None = Field(None, description="What moves it where it has no component on real hardware.")
    speed_scaling_interface: str | None = Field(None, description="State interface of its speed scaling.")
    gripper: ContractGripper | None = Field(None, description="What a gripper adds.")
    camera: ContractCamera | None = Field(None, description="What a camera adds.")
    switched: ContractSwitched | None = Field(None, description="What a device that outputs switch adds.")
    law: ControlLaw | None = Field(
        None, description="How its real joints follow commands; null where nothing moves it on a path."
    )
    effects: dict[Moment, ContractEffect] = Field(
        {}, description="What its real hardware does as it is activated and claimed, and as its program or link ends."
    )
    stops: dict[str, ContractStop] = Field({}, description="States in which it stops by itself.")
    reports: dict[Need, str] = Field({}, description="Topic on which the cell hears whether a claim has what it needs.")
    nan_after_inactive: bool = Field(
        False, description="The driver holds NaN commands after `inactive`; activate it directly."
    )
    command_timeout_s: PositiveSeconds | None = Field(
        None, description="Longest silence of its manager before the real hardware ends its program."
    )


class ContractAdapter(ContractModel):
    """A device that its vendor's library drives behind an adapter, where no controller does."""

    joints: tuple[str, ...] = Field(description="Joints in the order of states and commands.")
    units: tuple[Literal["rad", "m"], ...] = Field(description="Unit of each joint's position.")
    action: str = Field(description="Full name of the action that takes its trajectories.")
    state_topic: str = Field(description="Full name of the topic of its stamped state.")
    client: str | None = Field(None, description="Name of the one node that may command it.")
    command_period_s: Period = Field(description="Time from one command to the next.", gt=0.0)
    command_timeout_s: PositiveSeconds = Field(description="Watchdog: silence after which it stops.", gt=0.0)
    stop_time_s: PositiveSeconds = Field(description="Longest time from a hold to standstill.", gt=0.0)
    goal_time_s: Seconds = Field(description="Time past the end of a trajectory until standstill.", gt=0.0)
    path_tolerance: PositiveMagnitude = Field(
        description="Distance from the command that ends a goal, rad or m.", gt=0.0
    )
    start_positions: tuple[Coordinate, ...] = Field(description="Where the mock's joints stand at first, rad or m.")


class ContractJointLimits(ContractModel):
    """Limits of the cell for one joint; rad or m."""

    lower: Coordinate | None = Field(None, description="Lower position; null without bound.")
    upper: Coordinate | None = Field(None, description="Upper position; null without bound.")
    velocity: PositiveMagnitude = Field(description="Largest speed.")
    acceleration: PositiveMagnitude = Field(description="Largest acceleration.")
    jerk: PositiveMagnitude = Field(description="Largest jerk.")


class ContractSimulatedJoint(ContractModel):
    """A joint that lags, saturates or is measured with noise; rad and rad/s, or m and m/s."""

    lag_s: Seconds = Field(0.0, description="Time constant of a first-order lag; 0 for no lag.")
    noise: Magnitude = Field(0.0, description="Largest error of the measured position; 0 for no error.")
    max_velocity: PositiveMagnitude | None = Field(
        None, description="Speed at which it saturates; null where it does not."
    )


class ContractGroup(ContractModel):
    """A planning group."""

    base_link: str = Field(description="First link of the chain.")
    tip_frame: str = Field(description="Frame that goals place.")
    joints: tuple[str, ...] = Field(description="Joints in chain order.")
    controller: str | None = Field(
        description="Controller, by full name where managers share names, or device behind an adapter, that executes."
    )
    start_outside: Magnitude = Field(
        0.0,
        description="How far outside its limits a joint may begin, rad or m; it is planned from them.",
    )


class ContractPoseTarget(ContractModel):
    """A named pose: joint positions of a group in the group's order."""

    group: str = Field(description="Group that moves.")
    positions: tuple[Coordinate, ...] = Field(description="Joint positions, rad or m.")


class ContractGoal(ContractModel):
    """A Cartesian goal of a group's tip in a frame; the approach is in the tip's own axes, m."""

    group: str = Field(description="Group that moves.")
    frame: str = Field(description="Frame that the goal is given in.")
    pose: ContractPose = Field(description="Tip in that frame.")
    approach: tuple[Coordinate, Coordinate, Coordinate] | None = Field(
        None, description="Offset of the pose before, in the tip's axes, m."
    )
    transform_at: Literal["observation", "latest"] = Field(description="Stamp that transforms are looked up at.")


class ContractSafety(ContractModel):
    """The boundary as declared."""

    stop_authority: str = Field(description="What has the authority to stop.")
    stop_path: str = Field(description="How the stop reaches the drives.")
    recovery_states: tuple[str, ...] = Field(description="States that need recovery.")
    acknowledge: str = Field(description="Who acknowledges before motion goes on.")
    on_reconnect: str = Field(description="What becomes of an old goal.")


class Contract(ContractModel):
    """The whole contract of one cell."""

    format: Literal[2] = Field(description="Version of this format.")
    cell: CellName = Field(description="Name of the cell and its package.")
    summary: str = Field(description="What the cell does.")
    configuration_id: str = Field(description="Id over all that evidence rests on.")
    distro: Distro = Field(description="ROS 2 distribution.")
    version_tuple: dict[str, str] = Field(description="Pinned versions by part.")
    files: ContractFiles = Field(description="Files beside this one.")
    root_frame: str = Field(description="Root of the frame tree.")
    calibrations: dict[str, ContractCalibration] = Field(description="Calibrations by id.")
    frames: dict[str, ContractFrame] = Field(description="Frames by name.")
    interfaces: dict[str, ContractInterface] = Field(description="Interfaces by full ROS name.")
    managers: dict[str, ContractManager] = Field(description="Controller managers by name.")
    clocks: dict[str, ContractClock] = Field(default_factory=dict, description="Clocks by host or device.")
    clock_of: dict[str, str] = Field(
        default_factory=dict, description="Clock of each node, controller and device that makes or ages stamps."
    )
    plugin_behaviors: dict[str, Behavior] = Field(description="Behavior of each controller plugin.")
    devices: dict[str, ContractDevice] = Field(description="Devices by name.")
    simulated_joints: dict[str, ContractSimulatedJoint] = Field(
        default_factory=dict, description="What the mock adds to joints, by joint."
    )
    adapters: dict[str, ContractAdapter] = Field(
        default_factory=dict, description="Devices behind an adapter, by name."
    )
    joint_limits: dict[str, ContractJointLimits] = Field(description="Limits by joint.")
    groups: dict[str, ContractGroup] = Field(description="Planning groups by name.")
    poses: dict[str, tuple[ContractPoseTarget, ...]] = Field(description="Named poses.")
    goals: dict[str, ContractGoal] = Field(description="Cartesian goals by name.")
    responsibilities: dict[str, str] = Field(description="Owner of each responsibility.")
    approvals: dict[str, str] = Field(description="Owner of each approval area.")
    safety: ContractSafety = Field(description="Safety boundary.")
    kpis: Kpis = Field(description="Target figures.")
    attempt_fields: tuple[str, ...] = Field(description="What every attempt records.")
