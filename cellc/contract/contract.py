"""``contract.json``: the cell as its artifacts promise it, for the mock, for tools and for people.

Everything is resolved: full ROS names, SI and radians, no defaults left to the reader. The mock reads this file, the
URDF and controllers.yaml that ros2_control would read, and nothing of the compiler.
"""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from cellc.contract.base import ContractModel, ContractPose


class ContractFiles(ContractModel):
    """Paths inside the generated folder, with forward slashes."""

    urdf_mock: str
    urdf_real: str
    parameters: dict[str, str] = Field(description="Parameter file of each controller manager, by manager.")
    rehearsals: str


class ContractCalibration(ContractModel):
    """A measurement that transforms rest on."""

    revision: int
    owner: str


class ContractFrame(ContractModel):
    """One TF frame; the pose is in ``parent``, absent for dynamic frames and for links that move with a joint."""

    parent: str
    authority: str
    kind: Literal["world", "link", "mount", "fixed", "scene", "dynamic"]
    pose: ContractPose | None
    calibration: str | None
    rate_hz: float | None
    buffer_s: float | None
    simulated_parent: str | None = None
    simulated_pose: ContractPose | None = None


class ContractQos(ContractModel):
    """A resolved profile; null durations are infinite."""

    reliability: Literal["reliable", "best_effort"]
    durability: Literal["volatile", "transient_local"]
    history: Literal["keep_last", "keep_all"]
    depth: int
    deadline_s: float | None
    lifespan_s: float | None
    liveliness: Literal["automatic", "manual_by_topic"]
    lease_duration_s: float | None


class ContractEndpoint(ContractModel):
    """One end of an interface."""

    node: str
    qos: ContractQos


class ContractInterface(ContractModel):
    """A topic, service or action with what its users may rely on."""

    kind: Literal["topic", "service", "action"]
    type: str
    sources: tuple[ContractEndpoint, ...]
    sinks: tuple[ContractEndpoint, ...]
    frame: str | None
    unit: str | None
    time_source: str | None
    owner: str | None
    wants: str | None
    rate_hz: float | None
    max_age_s: float | None
    transport_s: float | None
    on_stale: str | None
    timeout_s: float | None
    on_timeout: str | None
    on_error: str | None
    cancel_within_s: float | None


class ContractController(ContractModel):
    """A controller, what it claims, and who may command it."""

    plugin: str
    behaviour: str
    device: str | None
    joints: tuple[str, ...]
    command_interfaces: tuple[str, ...]
    state_interfaces: tuple[str, ...]
    active: bool
    client: str | None
    action: str | None
    action_type: str | None
    on_violation: str


class ContractSwitch(ContractModel):
    """A declared controller switch."""

    activate: tuple[str, ...]
    deactivate: tuple[str, ...]


class ContractManager(ContractModel):
    """A controller manager."""

    namespace: str
    update_rate_hz: float
    controllers: dict[str, ContractController]
    switches: dict[str, ContractSwitch]


class ContractGripper(ContractModel):
    """A gripper in its joint's units: rad or m."""

    joint: str
    controller: str | None
    open: float
    closed: float
    max_effort: float
    held_object_position: float | None = Field(None, description="Joint position at which a grasped object stops it.")


class ContractCamera(ContractModel):
    """The stream that perception uses."""

    topic: str
    frame: str
    rate_hz: float
    exposure_s: float
    clock: str


class ContractDevice(ContractModel):
    """A device as the mock needs it."""

    model: str
    kind: str
    prefix: str
    root_link: str
    architecture: str
    hardware_component: str | None
    speed_scaling_interface: str | None
    gripper: ContractGripper | None
    camera: ContractCamera | None


class ContractJointLimits(ContractModel):
    """Limits of the cell for one joint; rad or m."""

    lower: float | None
    upper: float | None
    velocity: float
    acceleration: float
    jerk: float


class ContractGroup(ContractModel):
    """A planning group."""

    base_link: str
    tip_frame: str
    joints: tuple[str, ...]
    controller: str | None


class ContractPoseTarget(ContractModel):
    """A named pose: joint positions of a group in the group's order."""

    group: str
    positions: tuple[float, ...]


class ContractGoal(ContractModel):
    """A Cartesian goal of a group's tip in a frame; the approach is in the tip's own axes, m."""

    group: str
    frame: str
    pose: ContractPose
    approach: tuple[float, float, float] | None
    transform_at: Literal["observation", "latest"]


class ContractSafety(ContractModel):
    """The boundary as declared."""

    stop_authority: str
    stop_path: str
    recovery_states: tuple[str, ...]
    acknowledge: str
    on_reconnect: str


class ContractKpis(ContractModel):
    """Targets; null where none was set."""

    plan_to_execute_s: float | None
    cancel_s: float | None
    missed_cycles: int | None
    stale_state_rejection: float | None
    protective_stops: int | None
    recovery_time_s: float | None
    wrong_owner_events: int | None


class Contract(ContractModel):
    """The whole contract of one cell."""

    format: Literal[1]
    cell: str
    summary: str
    configuration_id: str
    distro: str
    version_tuple: dict[str, str]
    files: ContractFiles
    root_frame: str
    calibrations: dict[str, ContractCalibration]
    frames: dict[str, ContractFrame]
    interfaces: dict[str, ContractInterface]
    managers: dict[str, ContractManager]
    plugin_behaviours: dict[str, str]
    devices: dict[str, ContractDevice]
    joint_limits: dict[str, ContractJointLimits]
    groups: dict[str, ContractGroup]
    poses: dict[str, tuple[ContractPoseTarget, ...]]
    goals: dict[str, ContractGoal]
    responsibilities: dict[str, str]
    approvals: dict[str, str]
    safety: ContractSafety
    kpis: ContractKpis
    attempt_fields: tuple[str, ...]
