"""The whole spec of one physical cell."""

from typing import Annotated, Literal

from pydantic import Field, StringConstraints

from cellc.compiler.spec.base import PackageName
from cellc.compiler.spec.control import ManagerSpec, MotionSpec
from cellc.compiler.spec.devices import DeviceSpec
from cellc.compiler.spec.frames import AreaSpec, CalibrationSpec, FrameSpec
from cellc.compiler.spec.hosts import HostSpec
from cellc.compiler.spec.interfaces import InterfaceSpec, NodeSpec
from cellc.compiler.spec.rehearsals import KpisSpec, RecordingSpec, RehearsalSpec, TargetSpec
from cellc.compiler.spec.safety import BringupSpec, SafetySpec
from cellc.compiler.spec.scene import SolidSpec
from cellc.compiler.spec.uncertainty import RegionSpec, UncertaintySpec
from cellc.contract.stated import (
    HardwareStatement,
    Name,
    Network,
    Owners,
    StatedModel,
    Surroundings,
    Text,
    Versions,
)

PackageFolder = Annotated[str, StringConstraints(min_length=1, max_length=255)]
TopicName = Annotated[str, StringConstraints(min_length=1, max_length=255)]


class CellSpec(StatedModel):
    """One physical cell, as its integrator writes it."""

    format: Literal[1] = Field(..., description="Version of this spec language.", examples=[1])
    cell: PackageName = Field(
        ..., description="Name of the cell and of the generated package.", examples=["bench_pick"]
    )
    summary: Text = Field(
        "", description="One sentence on what the cell does.", examples=["Picks parts from fixture A"], min_length=0
    )
    versions: Versions = Field(..., description="The pinned version tuple.", examples=[{"ros": "jazzy"}])
    packages: tuple[PackageFolder, ...] = Field(
        (),
        description="Folders in which ROS packages of descriptions and meshes lie, relative to this file and in its "
        "repository. The folder of the spec is searched before them.",
        examples=[["../../vendor_ws"]],
        max_length=100,
    )
    hosts: dict[Name, HostSpec] = Field(
        default_factory=dict, description="Computers by name.", examples=[{"control_pc": {"scheduling": "preempt_rt"}}]
    )
    network: Network = Field(
        default_factory=Network, description="DDS network.", examples=[{"domain_id": 42, "discovery": "unicast"}]
    )
    devices: dict[Name, DeviceSpec] = Field(
        ...,
        description="Robots, grippers and sensors by name.",
        examples=[{"arm": {"model": "./my_arm"}}],
        min_length=1,
    )
    calibrations: dict[Name, CalibrationSpec] = Field(
        default_factory=dict, description="Measurements by id.", examples=[{"hand_eye": {"revision": 4}}]
    )
    frames: dict[Name, FrameSpec] = Field(
        default_factory=dict,
        description="Frames by name.",
        examples=[{"tcp": {"parent": "gripper/base", "xyz": "0 0 162 mm"}}],
    )
    scene: dict[Name, SolidSpec] = Field(
        default_factory=dict,
        description="Solid things that planning avoids, by name.",
        examples=[{"table": {"parent": "world", "box": "1200 800 40 mm", "xyz": "0 0 780 mm"}}],
    )
    surroundings: Surroundings = Field(
        default_factory=Surroundings,
        description="What is around the arms within their reach.",
        examples=[{"support": {"shapes": ["table"]}, "walls": {"none": "the nearest is 4 m away"}}],
    )
    areas: dict[Name, AreaSpec] = Field(
        default_factory=dict,
        description="Volumes that several arms share, by name.",
        examples=[{"exchange": {"parent": "world", "box": "400 400 400 mm", "granted_by": "safety_plc"}}],
    )
    nodes: dict[Name, NodeSpec] = Field(
        default_factory=dict,
        description="Nodes of the cell by name.",
        examples=[{"task": {"run": "cell_tasks/pick_place"}}],
    )
    interfaces: dict[TopicName, InterfaceSpec] = Field(
        default_factory=dict,
        description="Topics, services and actions by their full ROS name.",
        examples=[{"/object_pose": {"topic": "geometry_msgs/msg/PoseStamped", "from": "perception", "to": "task"}}],
    )
    control: ManagerSpec | None = Field(
        None,
        description="The controller manager of a cell with one.",
        examples=[{"update_rate": "500 Hz", "controllers": {"joint_states": {"type": "joint_state_broadcaster"}}}],
    )
    managers: dict[Name, ManagerSpec] = Field(
        default_factory=dict,
        description="Controller managers by name, for a cell with several; each has its own namespace.",
        examples=[{"left": {"update_rate": "500 Hz", "namespace": "/left", "controllers": {}}}],
    )
    motion: MotionSpec = Field(
        default_factory=MotionSpec,
        description="Groups, named poses and goals.",
        examples=[{"groups": {"manipulator": {"base": "arm/base_link", "tip": "tcp"}}}],
    )
    owners: Owners = Field(
        default_factory=Owners,
        description="Who is responsible for what.",
        examples=[{"approvals": {"graph": "integration"}}],
    )
    safety: SafetySpec = Field(
        default_factory=SafetySpec, description="The safety boundary.", examples=[{"stop": {"authority": "safety_plc"}}]
    )
    bringup: BringupSpec = Field(
        default_factory=BringupSpec, description="Gates and first motion.", examples=[{"gates": "standard"}]
    )
    rehearsals: dict[Name, RehearsalSpec] = Field(
        default_factory=dict,
        description="Runs of the mock by name.",
        examples=[{"wave": {"steps": [{"move": "home"}]}}],
    )
    uncertainty: UncertaintySpec | None = Field(
        None,
        description="What a sweep draws and judges; no sweep without it or regions.",
        examples=[{"tolerances": {"pick": "5 mm"}}],
    )
    regions: dict[Name, RegionSpec] = Field(
        default_factory=dict,
        description="Dynamic frames by name, with where the object that each follows may lie.",
        examples=[{"object": {"box": "80 120 0 mm", "yaw": "90 deg"}}],
    )
    kpis: KpisSpec = Field(default_factory=KpisSpec, description="Target figures.", examples=[{"cancel": "200 ms"}])
    recording: RecordingSpec = Field(
        default_factory=RecordingSpec,
        description="What every attempt records.",
        examples=[{"attempt_fields": "standard"}],
    )
    targets: dict[Literal["mock", "sim", "real"], TargetSpec] = Field(
        default_factory=dict, description="What differs between targets.", examples=[{"sim": {"clock": "sim"}}]
    )
    mock_plugins: dict[Text, HardwareStatement] = Field(
        default_factory=dict,
        description="Hardware plugins beside those of the catalog that may stand in for a device in the mock.",
        examples=[{"my_arm/Simulation": {"touches_no_hardware": True, "by": "controls", "date": "2026-07-01"}}],
    )
    mock_programs: dict[Text, HardwareStatement] = Field(
        default_factory=dict,
        description="Programs of devices beside those of the catalog that may run on the mock: `package/executable`.",
        examples=[{"my_camera/rectify": {"touches_no_hardware": True, "by": "perception", "date": "2026-07-01"}}],
    )
