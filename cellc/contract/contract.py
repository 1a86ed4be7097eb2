"""``contract.json``: the cell as its artifacts promise it, for the mock, for tools and for people.

Everything is resolved: full ROS names, SI and radians. What is at the default that the schema states, null most of
all, is left out. The mock reads this file, the URDF and controllers.yaml that ros2_control would read, the pairs of the
SRDF, and nothing of the compiler.
"""

from typing import Annotated, Literal

from pydantic import Field

from cellc.contract.base import ContractModel, ContractPose
from cellc.contract.devices import ContractAdapter, ContractDevice, ContractSimulatedJoint
from cellc.contract.entities import TARGETS, ContractInterface, Kpis, Target
from cellc.contract.file_names import BesidePath, CellName, InnerPath
from cellc.contract.gates import Gates
from cellc.contract.grading import FASTER, FURTHER, GRIPPED, PLANNED, SECOND_CLIENT, UNSEEN, Graded, Rule
from cellc.contract.quantities import (
    Coordinate,
    Count,
    Drift,
    Magnitude,
    Offset,
    PositiveMagnitude,
    Rate,
    Seconds,
)
from cellc.contract.vocabulary import Behavior, Distro, ReviewArea


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
    stages: dict[str, InnerPath] = Field(
        default_factory=dict,
        description="Parameters that cap planned motion in each stage of commissioning, by its percentage in order; "
        "the mock plays the last unless another is asked for.",
    )
    packages: tuple[BesidePath, ...] = Field(
        (), description="Folders beside this one in which packages of meshes lie, relative to that of the spec."
    )


class ContractCalibration(ContractModel):
    """A measurement that transforms rest on."""

    revision: Annotated[Count, Graded(ReviewArea.CALIBRATION, rule=Rule.BACK)] = Field(
        description="Counts up with every measurement."
    )
    owner: Annotated[str, Graded(ReviewArea.OWNERS, rule=Rule.NAMED)] = Field(
        description="Person or role responsible for it."
    )


class ContractClock(ContractModel):
    """A clock that stamps are made on: of a host, or of a device with one of its own."""

    domain: str = Field(description="Clock domain.")
    synchronized_by: str | None = Field(None, description="What disciplines it.")
    max_offset_s: Annotated[
        Seconds | None, Graded(ReviewArea.TIME, "bound of its offset", Rule.CLOCK, why="its stamps may be further off")
    ] = Field(None, description="Bound of its offset; null where nothing bounds it.")
    simulated: bool = Field(False, description="Time comes from /clock.")
    offset_s: Annotated[Offset, Graded(ReviewArea.REHEARSALS, "offset on the mock")] = Field(
        0.0, description="Offset that the mock gives it."
    )
    drift: Annotated[Drift, Graded(ReviewArea.REHEARSALS, "drift on the mock")] = Field(
        0.0, description="Seconds that the mock lets it gain in a second, until the bound."
    )


class ContractBand(ContractModel):
    """Where the joint of a gripper comes to rest that holds a right part, rad or m; elsewhere it holds none."""

    joint: str = Field(description="Joint to look at when the fingers have closed, and as long as the part is held.")
    lower: Coordinate = Field(description="Least position.")
    upper: Coordinate = Field(description="Largest position.")


class ContractGrasp(ContractModel):
    """A part as fingers meet it."""

    width_m: Magnitude | None = Field(None, description="How far apart the fingers are that hold it.")
    tolerance_m: Magnitude | None = Field(None, description="How much a right part is wider or narrower.")
    mass_kg: Magnitude | None = Field(None, description="Its mass.")
    bands: dict[str, ContractBand] = Field({}, description="What the task checks, by gripper.")


class ContractFrame(ContractModel):
    """One TF frame; a pose in the robot description is not repeated here."""

    parent: Annotated[str, Graded(ReviewArea.FRAMES, breaking=True)] = Field(
        description="Parent frame; empty for the root."
    )
    authority: Annotated[
        str, Graded(ReviewArea.FRAMES, "publisher", Rule.DANGEROUS, why="another node publishes it")
    ] = Field("robot_state_publisher", description="Who publishes the edge.")
    kind: Literal["world", "link", "mount", "fixed", "scene", "dynamic"] = Field(
        "link", description="Where the frame comes from."
    )
    moving: bool = Field(False, description="Published on /tf, not once on /tf_static.")
    pose: ContractPose | None = Field(None, description="Pose in the parent of a frame that no URDF holds.")
    calibration: Annotated[str | None, Graded(ReviewArea.CALIBRATION, "calibration of the frame", Rule.NAMED)] = Field(
        None, description="Calibration that measured it."
    )
    rate_hz: Annotated[Rate | None, Graded(ReviewArea.FRAMES)] = Field(None, description="Rate of a dynamic frame.")
    buffer_s: Annotated[Seconds | None, Graded(ReviewArea.FRAMES, "buffered history")] = Field(
        None, description="History that consumers keep."
    )
    simulated_parent: Annotated[str | None, Graded(ReviewArea.REHEARSALS, "parent on the mock")] = Field(
        None, description="Frame in which the mock puts what a dynamic frame follows."
    )
    simulated_pose: Annotated[ContractPose | None, Graded(ReviewArea.REHEARSALS, "pose on the mock")] = Field(
        None, description="Pose there."
    )
    grasp: Annotated[ContractGrasp | None, Graded(ReviewArea.MOTION, "part to grip", Rule.DANGEROUS, why=GRIPPED)] = (
        Field(None, description="The part that lies there, or that the frame follows; null where none is stated.")
    )


class ContractController(ContractModel):
    """A controller, what it claims, and who may command it."""

    plugin: Annotated[str, Graded(ReviewArea.CONTROL, rule=Rule.DANGEROUS)] = Field(
        description="Type as the controller manager loads it."
    )
    behavior: Annotated[Behavior, Graded(ReviewArea.CONTROL, rule=Rule.DANGEROUS)] = Field(description="What it does.")
    full_name: str = Field(description="Fully qualified name of its node.")
    targets: Annotated[tuple[Target, ...], Graded(ReviewArea.CONTROL, rule=Rule.DANGEROUS, ordered=False)] = Field(
        TARGETS, description="Targets on which it is loaded."
    )
    device: str | None = Field(None, description="Device whose joints it drives.")
    joints: Annotated[tuple[str, ...], Graded(ReviewArea.CONTROL, "joints, in order", Rule.DANGEROUS)] = Field(
        description="Joints in the controller's order."
    )
    command_interfaces: tuple[str, ...] = Field(description="Interfaces it claims, as `joint/interface`.")
    real_command_interfaces: tuple[str, ...] | None = Field(
        None, description="Interfaces it claims on real hardware, where those are others."
    )
    state_interfaces: Annotated[tuple[str, ...], Graded(ReviewArea.CONTROL, ordered=False)] = Field(
        description="Interfaces it reads, as `joint/interface`."
    )
    active: Annotated[
        bool, Graded(ReviewArea.CONTROL, "active from the start", Rule.DANGEROUS, why="it commands at another time")
    ] = Field(description="Active after start-up.")
    client: Annotated[str | None, Graded(ReviewArea.CONTROL, "permitted client", Rule.DANGEROUS, why=SECOND_CLIENT)] = (
        Field(None, description="Name of the one node that may command it.")
    )
    action: Annotated[str | None, Graded(ReviewArea.INTERFACES, breaking=True)] = Field(
        None, description="Full name of its action."
    )
    action_type: Annotated[str | None, Graded(ReviewArea.INTERFACES, "type of its action", breaking=True)] = Field(
        None, description="ROS type of its action."
    )
    real_action: Annotated[str | None, Graded(ReviewArea.INTERFACES, "action on hardware", breaking=True)] = Field(
        None, description="Action that takes its goals where it is not loaded on real hardware."
    )
    real_action_type: str | None = Field(None, description="ROS type of that action.")
    goal_time_s: Annotated[Seconds | None, Graded(ReviewArea.CONTROL, "time past the end", Rule.LOOSER, why=UNSEEN)] = (
        Field(
            None,
            description="Time allowed past the end of a trajectory; null or 0 for no limit. It bounds no whole goal.",
        )
    )
    on_violation: Annotated[str, Graded(ReviewArea.CONTROL, "action on a violation", Rule.DANGEROUS)] = Field(
        description="What happens on a tolerance violation."
    )


class ContractSwitch(ContractModel):
    """A declared controller switch."""

    activate: tuple[str, ...] = Field(description="Controllers to activate.")
    deactivate: tuple[str, ...] = Field(description="Controllers to deactivate first.")


class ContractManager(ContractModel):
    """A controller manager."""

    namespace: str = Field(description="Namespace of the manager.")
    update_rate_hz: Annotated[Rate, Graded(ReviewArea.CONTROL)] = Field(description="Rate of read, update, write.")
    controllers: dict[str, ContractController] = Field(
        description="Controllers by name, by full name where managers share it."
    )
    switches: Annotated[
        dict[str, ContractSwitch],
        Graded(ReviewArea.CONTROL, "controllers in its switch", Rule.DANGEROUS, each="switch"),
    ] = Field(description="Declared switches by name.")


class ContractJointLimits(ContractModel):
    """Limits of the cell for one joint; rad or m."""

    lower: Annotated[
        Coordinate | None, Graded(ReviewArea.LIMITS, "lower position", Rule.LESS, "joint", why=FURTHER)
    ] = Field(None, description="Lower position; null without bound.")
    upper: Annotated[
        Coordinate | None, Graded(ReviewArea.LIMITS, "upper position", Rule.MORE, "joint", why=FURTHER)
    ] = Field(None, description="Upper position; null without bound.")
    velocity: Annotated[PositiveMagnitude, Graded(ReviewArea.LIMITS, rule=Rule.MORE, unit="joint/s", why=FASTER)] = (
        Field(description="Largest speed.")
    )
    acceleration: Annotated[
        PositiveMagnitude, Graded(ReviewArea.LIMITS, rule=Rule.MORE, unit="joint/s^2", why=FASTER)
    ] = Field(description="Largest acceleration.")
    jerk: Annotated[PositiveMagnitude, Graded(ReviewArea.LIMITS, rule=Rule.MORE, unit="joint/s^3", why=FASTER)] = Field(
        description="Largest jerk."
    )


_EXECUTES = "another controller executes its plans"


class ContractGroup(ContractModel):
    """A planning group."""

    base_link: str = Field(description="First link of the chain.")
    tip_frame: Annotated[str, Graded(ReviewArea.MOTION, rule=Rule.DANGEROUS)] = Field(
        description="Frame that goals place."
    )
    joints: tuple[str, ...] = Field(description="Joints in chain order.")
    controller: Annotated[str | None, Graded(ReviewArea.MOTION, rule=Rule.DANGEROUS, why=_EXECUTES)] = Field(
        description="Controller, by full name where managers share it, or device behind an adapter, that executes."
    )
    start_outside: Annotated[
        Magnitude, Graded(ReviewArea.CONTROL, "tolerance of a start outside the limits", unit="joint")
    ] = Field(0.0, description="How far outside its limits a joint may begin, rad or m; it is planned from them.")


class ContractPoseTarget(ContractModel):
    """A named pose: joint positions of a group in the group's order."""

    group: str = Field(description="Group that moves.")
    positions: tuple[Coordinate, ...] = Field(description="Joint positions, rad or m.")


class ContractGoal(ContractModel):
    """A Cartesian goal of a group's tip in a frame; the approach is in the tip's own axes, m."""

    group: Annotated[str, Graded(ReviewArea.MOTION, rule=Rule.DANGEROUS)] = Field(description="Group that moves.")
    frame: Annotated[str, Graded(ReviewArea.MOTION, rule=Rule.DANGEROUS, why="the goal is somewhere else")] = Field(
        description="Frame that the goal is given in."
    )
    pose: Annotated[ContractPose, Graded(ReviewArea.MOTION, "pose in its frame", why=PLANNED)] = Field(
        description="Tip in that frame."
    )
    approach: Annotated[
        tuple[Coordinate, Coordinate, Coordinate] | None, Graded(ReviewArea.MOTION, unit="m", why=PLANNED)
    ] = Field(None, description="Offset of the pose before, in the tip's axes, m.")
    transform_at: Annotated[
        Literal["observation", "latest"],
        Graded(
            ReviewArea.MOTION, "stamp of its transforms", Rule.DANGEROUS, why="the latest transform hides stale data"
        ),
    ] = Field(description="Stamp that transforms are looked up at.")


class ContractSafety(ContractModel):
    """The boundary as declared."""

    stop_authority: Annotated[str, Graded(ReviewArea.SAFETY, "authority of the stop", Rule.DANGEROUS)] = Field(
        description="What has the authority to stop."
    )
    stop_path: Annotated[str, Graded(ReviewArea.SAFETY, "path of the stop", Rule.DANGEROUS)] = Field(
        description="How the stop reaches the drives."
    )
    recovery_states: Annotated[
        tuple[str, ...], Graded(ReviewArea.SAFETY, "states that need recovery", Rule.LOST, ordered=False)
    ] = Field(description="States that need recovery.")
    acknowledge: Annotated[str, Graded(ReviewArea.SAFETY, "person who acknowledges", Rule.DANGEROUS)] = Field(
        description="Who acknowledges before motion goes on."
    )
    on_reconnect: Annotated[
        str, Graded(ReviewArea.SAFETY, "handling of an old goal after a reconnect", Rule.DANGEROUS)
    ] = Field(description="What becomes of an old goal.")


class Contract(ContractModel):
    """The whole contract of one cell."""

    format: Literal[2] = Field(description="Version of this format.")
    cell: Annotated[CellName, Graded(ReviewArea.INTERFACES, "name of the cell and its package", breaking=True)] = Field(
        description="Name of the cell and its package."
    )
    summary: Annotated[str, Graded(ReviewArea.DOCUMENTS, rule=Rule.SAFE)] = Field(description="What the cell does.")
    configuration_id: str = Field(description="Id over all that evidence rests on.")
    distro: Distro = Field(description="ROS 2 distribution.")
    version_tuple: Annotated[dict[str, str], Graded(ReviewArea.VERSIONS, "pinned version", Rule.NAMED, each="part")] = (
        Field(description="Pinned versions by part.")
    )
    files: ContractFiles = Field(description="Files beside this one.")
    root_frame: Annotated[str, Graded(ReviewArea.FRAMES, "root of the tree", Rule.DANGEROUS, breaking=True)] = Field(
        description="Root of the frame tree."
    )
    calibrations: Annotated[
        dict[str, ContractCalibration], Graded(ReviewArea.CALIBRATION, "calibration", each="calibration")
    ] = Field(description="Calibrations by id.")
    frames: Annotated[dict[str, ContractFrame], Graded(ReviewArea.FRAMES, "kind", each="frame")] = Field(
        description="Frames by name."
    )
    interfaces: dict[str, ContractInterface] = Field(description="Interfaces by full ROS name.")
    managers: dict[str, ContractManager] = Field(description="Controller managers by name.")
    clocks: Annotated[dict[str, ContractClock], Graded(ReviewArea.TIME, "clock", each="clock")] = Field(
        default_factory=dict, description="Clocks by host or device."
    )
    clock_of: Annotated[dict[str, str], Graded(ReviewArea.TIME, "clock of its stamps", each="node")] = Field(
        default_factory=dict, description="Clock of each node, controller and device that makes or ages stamps."
    )
    plugin_behaviors: dict[str, Behavior] = Field(description="Behavior of each controller plugin.")
    devices: Annotated[dict[str, ContractDevice], Graded(ReviewArea.DEVICES, "device", each="device")] = Field(
        description="Devices by name."
    )
    simulated_joints: Annotated[
        dict[str, ContractSimulatedJoint], Graded(ReviewArea.REHEARSALS, "joints on the mock")
    ] = Field(default_factory=dict, description="What the mock adds to joints, by joint.")
    adapters: Annotated[dict[str, ContractAdapter], Graded(ReviewArea.CONTROL, "adapter", each="device")] = Field(
        default_factory=dict, description="Devices behind an adapter, by name."
    )
    joint_limits: Annotated[dict[str, ContractJointLimits], Graded(ReviewArea.LIMITS, "limits", each="joint")] = Field(
        description="Limits by joint."
    )
    parts: Annotated[
        tuple[tuple[str, ...], ...],
        Graded(ReviewArea.MOTION, "robots that can reach each other", Rule.REVIEW, ordered=False, why=PLANNED),
    ] = Field(
        (),
        description="Devices and things of the scene by what can meet: robots that can reach each other, with what is "
        "in their reach; each part is planned by itself. Empty where all is one part.",
    )
    groups: Annotated[
        dict[str, ContractGroup], Graded(ReviewArea.MOTION, "planning group", Rule.DANGEROUS, each="group")
    ] = Field(description="Planning groups by name.")
    poses: dict[str, tuple[ContractPoseTarget, ...]] = Field(description="Named poses.")
    goals: Annotated[dict[str, ContractGoal], Graded(ReviewArea.MOTION, "goal", each="goal")] = Field(
        description="Cartesian goals by name."
    )
    responsibilities: Annotated[
        dict[str, str], Graded(ReviewArea.OWNERS, "owner", Rule.NAMED, each="responsibility")
    ] = Field(description="Owner of each responsibility.")
    approvals: Annotated[
        dict[str, str], Graded(ReviewArea.OWNERS, "owner of the approval", Rule.NAMED, each="area")
    ] = Field(description="Owner of each approval area.")
    safety: ContractSafety = Field(description="Safety boundary.")
    kpis: Annotated[Kpis, Graded(ReviewArea.FIGURES, "target figure", Rule.STRICTER, each="figure")] = Field(
        description="Target figures."
    )
    attempt_fields: Annotated[
        tuple[str, ...], Graded(ReviewArea.FIGURES, "recorded fields of an attempt", Rule.LOST, ordered=False)
    ] = Field(description="What every attempt records.")
    gates: Gates | None = Field(
        None, description="What gates set, and what is known of the versions; null in contracts of an older cellc."
    )
