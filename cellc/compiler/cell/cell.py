"""The cell: everything that the spec and the catalog say, bound and in SI."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field
from functools import cached_property

from cellc.compiler.cell.control import AdaptedDevice, Controller, ControllerManager
from cellc.compiler.cell.device import Device, DeviceJoint, Stamp
from cellc.compiler.cell.entity import Places
from cellc.compiler.cell.frame import Frame, SharedArea, Solid
from cellc.compiler.cell.interface import Endpoint, ImpliedEndpoints, Interface, Node, NodeSource
from cellc.compiler.cell.motion import CartesianGoal, NamedPose, Octomap, Pipeline, PlanningGroup, Rehearsal, Servo
from cellc.compiler.cell.site import TARGET_DEFAULTS, Bringup, Calibration, Host, Recording, Safety, Target
from cellc.compiler.cell.uncertainty import Uncertainty
from cellc.compiler.cell.vendor import Reading, RecordSource
from cellc.contract.diagnostics import Span
from cellc.contract.entities import Kpis
from cellc.contract.frozen import dataclass
from cellc.contract.stated import HardwareStatement, Network, Owners, Surroundings, Versions
from cellc.contract.vocabulary import TRAJECTORIES, Behavior, Distro, InterfaceKind
from cellc.robot.description.model import Inertial


@dataclass(frozen=True, slots=True)
class InterfaceEnd:
    """An end of an interface; ``serves`` where it is a source: it publishes, answers or executes."""

    interface: Interface
    end: Endpoint
    serves: bool


def _is_signed(statement: HardwareStatement | None) -> bool:
    return statement is not None and statement.is_signed


# Without slots, so that what is asked for often is looked up once and kept.
@dataclass(frozen=True, kw_only=True)
class Cell:
    """A linked cell; every tuple is sorted as the user wrote it, derived entities after written ones.

    Args:
        places: where the user wrote what.
        distro: the pinned distribution.
        uncertainty: what sweeps draw; None where the cell says nothing of it.
        mock_plugins: hardware plugin → what the user says about it.
        mock_programs: package and executable of a device's node → what the user says about it.
        harmless_plugins: plugins that the catalog knows to touch no hardware.
        harmless_programs: the same of programs.
        hardware_packages: packages that the catalog knows to reach hardware.
        implied: what nodes have at the ROS graph by what they are.
        behaviors: controller plugin type string → what it does, for the plugins in use.
        packages: further folders in which packages lie, as the current folder sees them.
    """

    name: str
    places: Places
    distro: Distro
    versions: Versions
    summary: str = ""
    hosts: Mapping[str, Host] = field(default_factory=dict)
    network: Network = field(default_factory=Network)
    calibrations: Mapping[str, Calibration] = field(default_factory=dict)
    owners: Owners = field(default_factory=Owners)
    safety: Safety = field(default_factory=Safety)
    bringup: Bringup = field(default_factory=Bringup)
    kpis: Kpis = field(default_factory=Kpis)
    recording: Recording = field(default_factory=Recording)
    targets: Mapping[str, Target] = field(default_factory=lambda: dict(TARGET_DEFAULTS))
    mock_plugins: Mapping[str, HardwareStatement] = field(default_factory=dict)
    mock_programs: Mapping[str, HardwareStatement] = field(default_factory=dict)
    harmless_plugins: frozenset[str] = frozenset()
    harmless_programs: frozenset[str] = frozenset()
    hardware_packages: frozenset[str] = frozenset()
    devices: tuple[Device, ...] = ()
    frames: tuple[Frame, ...] = ()
    scene: tuple[Solid, ...] = ()
    surroundings: Surroundings = field(default_factory=Surroundings)
    areas: tuple[SharedArea, ...] = ()
    nodes: tuple[Node, ...] = ()
    interfaces: tuple[Interface, ...] = ()
    managers: tuple[ControllerManager, ...] = ()
    adapters: tuple[AdaptedDevice, ...] = ()
    groups: tuple[PlanningGroup, ...] = ()
    pipelines: tuple[Pipeline, ...] = ()
    octomap: Octomap | None = None
    servo: Servo | None = None
    poses: tuple[NamedPose, ...] = ()
    goals: tuple[CartesianGoal, ...] = ()
    rehearsals: tuple[Rehearsal, ...] = ()
    uncertainty: Uncertainty | None = None
    implied: ImpliedEndpoints = field(default_factory=ImpliedEndpoints)
    behaviors: Mapping[str, Behavior] = field(default_factory=dict)
    packages: tuple[str, ...] = ()

    def locate(self, *path: str | int) -> Span:
        """Return the place of a YAML path, or of its nearest ancestor that the user wrote.

        Where a whole section is missing that is the cell's own name, not the first line of the file.
        """
        return self.places.locate(path if self.places.has(path[:1]) else ("cell",))

    def states(self, *path: str | int) -> bool:
        """Tell whether the user wrote something at a YAML path."""
        return self.places.has(path)

    def text(self, *path: str | int) -> str:
        """Return the scalar at a YAML path as the user wrote it, such as ``5 deg``; empty where nothing is written."""
        return self.places.texts.get(path, "")

    def is_harmless_plugin(self, name: str) -> bool:
        """Whether the catalog or a signed statement says that a plugin touches no hardware."""
        return name in self.harmless_plugins or _is_signed(self.mock_plugins.get(name))

    def is_harmless_program(self, name: str) -> bool:
        """Whether the catalog or a signed statement says that a program, ``package/executable``, touches none."""
        return name in self.harmless_programs or _is_signed(self.mock_programs.get(name))

    def signed_for_mock(self) -> Iterator[tuple[Device, str, HardwareStatement]]:
        """Yield the plugins and programs that devices run on the mock, of which somebody in the spec says something."""
        for device in self.devices:
            plugin = "" if device.control.hardware is None else device.control.hardware.plugins["mock"]
            if plugin in self.mock_plugins:
                yield device, plugin, self.mock_plugins[plugin]
            for program in self.programs_on_mock(device):
                if program in self.mock_programs:
                    yield device, program, self.mock_programs[program]

    def programs_on_mock(self, device: Device) -> tuple[str, ...]:
        """Return the programs that a device runs on every target, as ``package/executable``."""
        programs = (node for node in self.nodes_of.get(device.name, ()) if not node.real_only)
        return tuple(f"{node.package}/{node.executable}" for node in programs)

    @cached_property
    def nodes_of(self) -> Mapping[str, tuple[Node, ...]]:
        """Nodes of each device that has some, by its name."""
        by_device: dict[str, list[Node]] = {}
        for node in self.nodes:
            if node.device is not None:
                by_device.setdefault(node.device, []).append(node)
        return {name: tuple(nodes) for name, nodes in by_device.items()}

    @cached_property
    def frames_by_name(self) -> Mapping[str, Frame]:
        """Frames by name, the last where a name occurs twice."""
        return {frame.name: frame for frame in self.frames}

    @cached_property
    def joints_by_name(self) -> Mapping[str, DeviceJoint]:
        """Joints of all devices by name, the first where a name occurs twice."""
        return {joint.name: joint for device in reversed(self.devices) for joint in reversed(device.joints)}

    @cached_property
    def holders(self) -> Mapping[str, str]:
        """Device of each joint, sensor and group of inputs and outputs by its name, the last where one occurs twice."""
        holders = {joint.name: device.name for device in self.devices for joint in device.joints}
        for device in self.devices:
            hardware = device.control.hardware
            if hardware is not None:
                holders |= {group.name: device.name for group in (*hardware.sensors, *hardware.gpios)}
        return holders

    @cached_property
    def controllers_of(self) -> Mapping[str, Mapping[str, str]]:
        """Full names of the controllers of each device that has some, by their kind."""
        by_device: dict[str, dict[str, str]] = {}
        for controller in self.controllers:
            if controller.device is not None:
                by_device.setdefault(controller.device, {})[controller.kind] = controller.full_name
        return by_device

    @cached_property
    def ends_of(self) -> Mapping[str, tuple[InterfaceEnd, ...]]:
        """Ends of interfaces at which a node is, by its full name."""
        by_interface: dict[str, list[InterfaceEnd]] = {}
        for interface in self.interfaces:
            for serves, ends in ((True, interface.sources), (False, interface.sinks)):
                for end in ends:
                    by_interface.setdefault(end.full_name, []).append(InterfaceEnd(interface, end, serves))
        return {name: tuple(ends) for name, ends in by_interface.items()}

    @cached_property
    def planners(self) -> tuple[Node, ...]:
        """Nodes that are MoveIt's move_group."""
        return tuple(node for node in self.nodes if node.is_planner)

    @cached_property
    def movers(self) -> tuple[Node, ...]:
        """Nodes of the spec that call actions or command controllers, and serve no action themselves."""
        actions = [interface for interface in self.interfaces if interface.kind is InterfaceKind.ACTION]
        asking = {controller.client for controller in self.controllers} | {
            end.node for action in actions for end in action.sinks
        }
        moving = asking - {end.node for action in actions for end in action.sources}
        nodes = (node for node in self.nodes if node.source is NodeSource.SPEC and not node.is_planner)
        return tuple(node for node in nodes if node.name in moving)

    @cached_property
    def started_late(self) -> frozenset[str]:
        """Full names of those that a person starts: the others are managed, and wait unactivated."""
        return frozenset(node.full_name for node in self.movers if not node.lifecycle)

    @cached_property
    def mover_names(self) -> frozenset[str]:
        """Full names of the same."""
        return frozenset(node.full_name for node in self.movers)

    @cached_property
    def managing_hosts(self) -> frozenset[str]:
        """Hosts of controller managers; an empty name where the spec states none."""
        return frozenset(manager.host for manager in self.managers)

    @cached_property
    def controllers(self) -> tuple[Controller, ...]:
        """Controllers of all managers, in order."""
        return tuple(controller for manager in self.managers for controller in manager.controllers)

    @cached_property
    def trajectory_controllers(self) -> tuple[Controller, ...]:
        """Controllers that take trajectories on the real target from the claim on."""
        takers = (controller for controller in self.controllers if controller.behavior in TRAJECTORIES)
        return tuple(taker for taker in takers if taker.active and "real" in taker.targets)

    @cached_property
    def trajectory_joints(self) -> frozenset[str]:
        """Joints that take trajectories on the real target, of a controller or an adapter."""
        taken = [taker.joints for taker in self.trajectory_controllers] + [taker.joints for taker in self.adapters]
        return frozenset(joint for joints in taken for joint in joints)

    def controllers_for(self, group: PlanningGroup) -> tuple[Controller, ...]:
        """Return the controllers that execute the plans of a group, in order."""
        places = {place for label in group.controllers for place in self._places_of_labels.get(label, ())}
        return tuple(self.controllers[place] for place in sorted(places))

    @cached_property
    def _places_of_labels(self) -> Mapping[str, tuple[int, ...]]:
        places: dict[str, tuple[int, ...]] = {}
        for place, controller in enumerate(self.controllers):
            places[controller.label] = (*places.get(controller.label, ()), place)  # one, but for a mistake
        return places

    def reporting(self, device: Device, source: RecordSource | Reading) -> Controller | None:
        """Return the controller of a device that tells something of it on the real target, if one does."""
        return self._reporters.get((device.name, source.controller_kind or ""))

    @cached_property
    def _reporters(self) -> Mapping[tuple[str, str], Controller]:
        """The first controller of a device and kind that is active on the real target."""
        return {
            (controller.device, controller.kind): controller
            for controller in reversed(self.controllers)
            if controller.device is not None and controller.active and "real" in controller.targets
        }

    def carried_mass_kg(self, device: Device) -> float:
        """Return the mass of what a device carries, as the descriptions of those say; 0 where they say nothing."""
        return sum(inertial.mass for _, inertial in self.tool_masses(device))

    def tool_masses(self, device: Device) -> Iterator[tuple[str, Inertial]]:
        """Yield the links with a mass that hang on the tool frame of a device: its own, and of what it carries."""
        hanging = {device.body.tool_frame} if device.body.tool_frame else set[str]()
        while more := {joint.child for joint in device.body.description.joints if joint.parent in hanging} - hanging:
            hanging |= more
        links = [link for link in device.body.description.links if link.name in hanging]
        carried = list(device.mount.carries)
        for name in carried:
            links += self.device(name).body.description.links
            carried += (other for other in self.device(name).mount.carries if other not in carried)
        yield from ((link.name, link.inertial) for link in links if link.inertial is not None)

    def device(self, name: str) -> Device:
        """Return a device by its name in the spec.

        Raises:
            KeyError: the name is unknown.
        """
        return self._devices[name]

    def stamp_of(self, name: str) -> Stamp | None:
        """Return what a device stamps; None of a node, which is no device."""
        return self._devices[name].sensing.stamp if name in self._devices else None

    def exposure_of(self, name: str) -> float:
        """Return the exposure time of a device, s; zero of a node, which is no device."""
        return self._devices[name].sensing.exposure_s if name in self._devices else 0.0

    @cached_property
    def _devices(self) -> Mapping[str, Device]:
        return {device.name: device for device in reversed(self.devices)}
