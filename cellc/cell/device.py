"""Devices of a cell with everything that the catalogue knows of them bound and prefixed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from cellc.catalog.device_model import DeviceModel
from cellc.cell.entity import Entity
from cellc.description.model import Description
from cellc.spec.devices import DeviceSpec
from cellc.transforms import Pose


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceJoint(Entity):
    """A movable joint: ``name`` carries the prefix, ``local_name`` does not.

    Limits are the device's own, tightened by the cell; rad and rad/s for revolute, m and m/s for prismatic joints;
    None where neither the description nor the catalogue states one. ``mimics`` names the joint that it follows.
    """

    local_name: str
    type: str
    lower: float | None
    upper: float | None
    velocity: float | None
    acceleration: float | None
    jerk: float | None
    effort: float | None
    mimics: str | None
    command_interfaces: tuple[str, ...]
    state_interfaces: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class InterfaceGroup:
    """A ros2_control ``<sensor>`` or ``<gpio>``: prefixed name, interfaces, and values that a mock starts from."""

    name: str
    command_interfaces: tuple[str, ...]
    state_interfaces: tuple[str, ...]
    initial: Mapping[str, float]
    real_only: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class HardwareComponent:
    """A component of ros2_control; plugins and parameters by target (``mock``, ``real``).

    ``targets`` are those on which it becomes a ``<ros2_control>`` tag; on any other the device's driver moves it.
    """

    name: str
    targets: tuple[str, ...]
    plugins: Mapping[str, str]
    parameters: Mapping[str, Mapping[str, str]]
    sensors: tuple[InterfaceGroup, ...]
    gpios: tuple[InterfaceGroup, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceDriver:
    """The node that moves a device on the real target past ros2_control.

    Args:
        node: its fully qualified name.
        program: ``package/executable``.
        joint_states: the topic on which the program publishes the joints of the device, or None.
        actions: kind of controller → the action, and its type, that takes such a controller's goals.
    """

    node: str
    program: str
    joint_states: str | None
    actions: Mapping[str, tuple[str, str]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Device(Entity):
    """A robot, gripper or sensor where it stands.

    Args:
        spec: the device as written: versions, connection, stamp, payload.
        facts: the catalogue entry, in its own names and units.
        description: links and joints with the prefix applied; frames as URDF.
        root_link: prefixed root link; its pose in ``parent_frame`` is ``transform_root_to_parent``.
        frames: short names of the catalogue and local link names → prefixed link names.
        joints: movable joints in the order of the description, mimic joints included.
        driver: what moves it on the real target where no component of ros2_control does.
        tool_frame: prefixed link where tools mount, for an arm.
        carries: devices mounted on this one, directly or on a frame of it.
    """

    spec: DeviceSpec
    facts: DeviceModel
    prefix: str
    description: Description
    root_link: str
    parent_frame: str
    transform_root_to_parent: Pose
    frames: Mapping[str, str]
    joints: tuple[DeviceJoint, ...]
    hardware: HardwareComponent | None
    driver: DeviceDriver | None
    tool_frame: str | None
    carries: tuple[str, ...]

    def joint(self, name: str) -> DeviceJoint:
        """Return a joint by its prefixed name.

        Raises:
            KeyError: there is none of that name.
        """
        for joint in self.joints:
            if joint.name == name:
                return joint
        raise KeyError(name)

    @property
    def actuated_joints(self) -> tuple[DeviceJoint, ...]:
        """Joints with a command interface."""
        return tuple(joint for joint in self.joints if joint.command_interfaces)
