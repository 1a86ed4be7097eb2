"""What the target ``sim`` has of a cell: MuJoCo behind ros2_control, by ``mujoco_ros2_control`` 0.1.0 or newer.

One hardware component has every joint and sensor, and a node of its own runs it on the time of the simulation. What its
plugin exports are joints of ``sim/scene.xml`` by their position actuators, and force-torque sensors; cameras publish by
a plugin of the plugin. A controller that takes anything else does not exist there: a vendor's trajectory controller has
the stock one in its place, and every other is left out and named. Released for Humble, Jazzy, Kilted and Lyrical:
https://github.com/ros/rosdistro/blob/8468e88c/humble/distribution.yaml and those of the others.
Source of every rule: https://github.com/ros-controls/mujoco_ros2_control/tree/bda2b674
(mujoco_ros2_control/src/mujoco_system_interface.cpp, mujoco_ros2_control_plugins/src/camera_plugin.cpp).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller
from cellc.compiler.cell.device import CameraStream, Device, DeviceJoint
from cellc.compiler.cell.hardware import InterfaceGroup
from cellc.compiler.cell.interface import ParameterValue
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import TRAJECTORIES

SIM = "sim"
PACKAGE = "mujoco_ros2_control"
PACKAGES = (PACKAGE, f"{PACKAGE}_plugins")
LEAST_VERSION = "0.1.0"
"""The first whose cameras are a plugin."""
PLUGIN = f"{PACKAGE}/MujocoSystemInterface"
COMPONENT = "simulator"
PLUGIN_NODE = "mujoco_ros2_control_node"
"""The node of the plugin in the process of the controller manager; its cameras read their parameters from it."""
CAMERAS = "mujoco_plugins.mujoco_camera_plugin"
"""Where the cameras look for their parameters, whatever the plugin is called."""
CAMERA_PLUGIN = f"{PACKAGES[1]}/CameraPlugin"
FORCES = ("force.x", "force.y", "force.z", "torque.x", "torque.y", "torque.z")
COMMANDED = "position"
"""What a position actuator of MuJoCo takes natively; the plugin refuses velocity and effort of it."""
_MEASURED = frozenset({"position", "velocity", "effort"})
_DEPTH = frozenset({"16UC1", "32FC1"})


@dataclass(frozen=True, slots=True, kw_only=True)
class SimulatedCamera:
    """A camera of the scene, named as its optical frame; a stream that the device lacks is None."""

    frame: str
    color: CameraStream | None
    depth: CameraStream | None
    rate_hz: float

    @property
    def parameters(self) -> dict[str, str]:
        """Parameters of its plugin; images that no stream has are published below the name of the camera."""
        known = self.color or self.depth
        topics = {"info_topic": "" if known is None else known.info_topic}
        topics["image_topic"] = "" if self.color is None else self.color.topic
        topics["depth_topic"] = "" if self.depth is None else self.depth.topic
        return {"frame_name": self.frame, **{key: topic for key, topic in topics.items() if topic}}


def is_asked(cell: Cell) -> bool:
    """Tell whether the spec asks for the target ``sim``."""
    target = cell.targets.get(SIM)
    return target is not None and target.hardware == SIM


def simulated_devices(cell: Cell) -> Iterator[Device]:
    """Yield the devices whose joints the one component has: those that ros2_control moves."""
    return (device for device in cell.devices if device.control.hardware is not None)


def commands(joint: DeviceJoint) -> tuple[str, ...]:
    """Return the command interfaces of a joint on the simulator; one that follows another has none."""
    return tuple(name for name in joint.command_interfaces if name == COMMANDED and joint.mimics is None)


def states(joint: DeviceJoint) -> tuple[str, ...]:
    """Return the state interfaces of a joint on the simulator."""
    return tuple(name for name in joint.state_interfaces if name in _MEASURED)


def force_sensors(device: Device) -> Iterator[InterfaceGroup]:
    """Yield the sensors of a device that measure forces and torques, on whichever target."""
    groups = () if device.control.hardware is None else device.control.hardware.sensors
    return (group for group in groups if set(FORCES) <= set(group.state_interfaces))


def cameras(cell: Cell) -> Iterator[SimulatedCamera]:
    """Yield the cameras of the scene, each with the streams of its frame and the rate that the contract states."""
    stated = {interface.name: interface.rate_hz for interface in cell.interfaces if interface.rate_hz}
    for device in cell.devices:
        seen: dict[str, list[CameraStream]] = {}
        for stream in () if device.sensing.camera is None else device.sensing.camera.streams:
            seen.setdefault(stream.frame, []).append(stream)
        for frame, streams in seen.items():
            if any(stream.view is not None for stream in streams):
                of_depth = [stream for stream in streams if stream.encoding in _DEPTH]
                yield SimulatedCamera(
                    frame=frame,
                    color=next((stream for stream in streams if stream not in of_depth), None),
                    depth=next(iter(of_depth), None),
                    rate_hz=max(stated.get(stream.topic) or stream.rate_hz for stream in streams),
                )


def simulated(cell: Cell) -> Cell:
    """Return the cell whose mock is the simulator: one component, and the controllers that have what they take in it.

    Controllers that do not are left to the real target.
    """
    lacking = absent(cell)

    def there(controller: Controller) -> Controller:
        if controller.full_name in lacking:
            return replace(controller, targets=("real",))
        return replace(_with_stock_plugin(cell, controller), targets=("mock",))

    managers = (replace(manager, controllers=tuple(map(there, manager.controllers))) for manager in cell.managers)
    return replace(cell, managers=tuple(managers), devices=tuple(map(_behind_the_simulator, cell.devices)))


def absent(cell: Cell) -> Mapping[str, tuple[str, ...]]:
    """Return the controllers that the simulator lacks by their full names, with what they take that is not there."""
    lacking = {controller.full_name: _lacking(cell, controller) for controller in cell.controllers}
    return {name: missing for name, missing in lacking.items() if missing}


def obstacles(cell: Cell) -> Iterator[tuple[tuple[str, ...], str]]:
    """Yield what keeps the simulator from running a cell as it is: where it is stated, and why."""
    if len(cell.managers) != 1:
        yield ("managers",), f"one component has all joints, so one controller manager must, got {len(cell.managers)}"
    for adapted in cell.adapters:
        yield (
            ("devices", adapted.device),
            f"`{adapted.device}` is moved by the library of its vendor, past ros2_control, which MuJoCo is behind",
        )
    if cell.targets[SIM].clock != SIM:
        yield ("targets", SIM, "clock"), "the clock of the target must be sim, because the simulation has the time"
    for name, mesh in _unopened(cell):
        yield ("devices", name), f"`{name}` has the mesh {mesh}, which MuJoCo does not find by that name"


def _unopened(cell: Cell) -> Iterator[tuple[str, str]]:
    """Yield a mesh of each device by a name that is no path of a file: MuJoCo knows no packages."""
    for device in cell.devices:
        meshes = (mesh.filename for link in device.body.description.links for mesh in link.collision_meshes())
        first = next((mesh for mesh in meshes if "://" in mesh), None)
        if first is not None:
            yield device.name, first


def _exported(cell: Cell) -> tuple[frozenset[str], frozenset[str]]:
    """Return the command interfaces and the state interfaces of the one component, by their full names."""
    devices = tuple(simulated_devices(cell))
    joints = tuple(joint for device in devices for joint in device.joints)
    taken = (f"{joint.name}/{name}" for joint in joints for name in commands(joint))
    measured = (f"{joint.name}/{name}" for joint in joints for name in states(joint))
    forces = (f"{group.name}/{name}" for device in devices for group in force_sensors(device) for name in FORCES)
    return frozenset(taken), frozenset((*measured, *forces))


def _lacking(cell: Cell, controller: Controller) -> tuple[str, ...]:
    if not controller.command_interfaces and not controller.state_interfaces and "mock" not in controller.targets:
        return (f"what {controller.plugin} takes of the real hardware",)
    taken, measured = _exported(cell)
    commanded = (name for name in controller.command_interfaces if name not in taken)
    heard = (name for name in controller.state_interfaces if name not in measured)
    return tuple(dict.fromkeys((*commanded, *heard)))


def _behind_the_simulator(device: Device) -> Device:
    hardware = device.control.hardware
    if hardware is None:
        return device
    component = replace(hardware, name=COMPONENT, targets=("mock",), plugins={"mock": PLUGIN})
    return replace(device, control=replace(device.control, hardware=component, initial_state="active"))


def _with_stock_plugin(cell: Cell, controller: Controller) -> Controller:
    """Return a controller of trajectories with the stock plugin, without what the plugin of the vendor has besides."""
    kind = controller.declared
    stock = None if kind is None or controller.behavior not in TRAJECTORIES else kind.plugins.get(cell.distro)
    if kind is None or stock is None:
        return controller
    exported, declared = frozenset().union(*_exported(cell)), kind.parameters_in(cell.distro)

    def is_there(name: str, value: ParameterValue) -> bool:
        if name not in declared:
            return name not in controller.plugin_parameters
        named = declared[name].names in ("state interface", "command interface")
        return not named or not isinstance(value, str) or not value or value in exported

    kept = {name: value for name, value in controller.parameters.items() if is_there(name, value)}
    return replace(controller, plugin=stock.type, package=stock.package, parameters=kept)
