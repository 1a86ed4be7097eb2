"""Builds the plant of one rehearsal from what the folder says: nodes, topics between them, and the control stack."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from math import inf

from cellc.contract.contract import Contract, ContractClock, ContractFrame, ContractManager
from cellc.contract.devices import ContractSimulatedJoint
from cellc.contract.entities import ContractEndpoint, Target
from cellc.contract.transforms import Pose, Vector3, identity
from cellc.mock.adapter.server import AdapterServer
from cellc.mock.bus.network import EdgeName, Network, QosEvent, QosEventKind
from cellc.mock.bus.qos import hears, middleware_of, task_node
from cellc.mock.bus.stream import StreamEdge
from cellc.mock.bus.timers import StreamDeadline
from cellc.mock.bus.topic import Topic
from cellc.mock.clocks import DEFAULT, TimeJump, build_clocks
from cellc.mock.control import ControllerManager, DeclaredInterfaces, JointFault, Noise
from cellc.mock.device_view import DeviceView
from cellc.mock.effects import Effects
from cellc.mock.engine.control_stack import ControlStack
from cellc.mock.engine.simulation import Simulation
from cellc.mock.folder import GeneratedFolder
from cellc.mock.loads import Loads
from cellc.mock.nodes.executors import Executors
from cellc.mock.nodes.motion_planner import MotionPlanner, PlanMemory
from cellc.mock.nodes.observations import ObservationInbox, pose_interface
from cellc.mock.nodes.perception import (
    DEFAULT_RATE_HZ,
    TF,
    Camera,
    Image,
    ObjectPose,
    Perception,
    TfBroadcast,
)
from cellc.mock.nodes.robot_state_publisher import NODE as ROBOT_STATE_PUBLISHER
from cellc.mock.nodes.robot_state_publisher import PUBLISH_FREQUENCY_HZ, JointStateFeed, RobotStatePublisher
from cellc.mock.parts import Parts
from cellc.mock.physics.dynamics import Dynamics
from cellc.mock.physics.otherwise import make_real
from cellc.mock.physics.reading import fingers_by_gripper, planned_contacts
from cellc.mock.plant import Plant, TaskNode
from cellc.mock.real_bring_up import played
from cellc.mock.real_start import RealStart
from cellc.mock.reality import AS_STATED, Displacement, Reality
from cellc.mock.stops import Stops
from cellc.mock.task_status import ActionStatus, Milestones, TaskRequests
from cellc.mock.tf.buffer import DEFAULT_BUFFER_S, TransformBuffer
from cellc.mock.tf.sources import SampledSource
from cellc.mock.watching import ClaimWatches
from cellc.mock.world.joint_states import JOINT_STATE_TYPE
from cellc.mock.world.switches import Switches
from cellc.mock.world.world import World
from cellc.robot.description.model import Box, HardwareComponent


def joint_state_feeds(
    contract: Contract, control: ControlStack, network: Network, node: str
) -> tuple[JointStateFeed, ...]:
    """Return the joint states whose broadcaster is connected to a node."""
    topics = {
        source.node: name
        for name, interface in contract.interfaces.items()
        if interface.type == JOINT_STATE_TYPE
        for source in interface.sources
    }
    return tuple(
        JointStateFeed(history, stream_edge(contract, network, topics.get(broadcaster, ""), broadcaster, node))
        for (_, broadcaster), history in control.histories.items()
        if _reads(contract, topics.get(broadcaster, ""), broadcaster, node)
    )


def _reads(contract: Contract, topic: str, broadcaster: str, node: str) -> bool:
    """Tell whether joint states reach a node: by their QoS, and on a topic of their own only if it subscribes to it."""
    declared = contract.interfaces.get(topic)
    apart = declared is not None and topic != "/joint_states" and node not in {sink.node for sink in declared.sinks}
    return not apart and hears(contract, topic, broadcaster, node)


def watch_deadlines(contract: Contract, control: ControlStack, network: Network) -> None:
    """Watch the deadlines that the ends of joint state topics promise or rely on; none costs nothing."""
    for name, interface in contract.interfaces.items():
        if interface.type != JOINT_STATE_TYPE or not network.middleware.reports_events:
            continue
        for source in interface.sources:
            for (_, broadcaster), history in control.histories.items():
                if broadcaster == source.node and source.qos.deadline_s is not None:
                    sent = JointStateFeed(history, None)
                    _watch(network, QosEventKind.OFFERED_DEADLINE_MISSED, name, source, sent)
        for sink in interface.sinks:
            for feed in joint_state_feeds(contract, control, network, sink.node) if sink.qos.deadline_s else ():
                _watch(network, QosEventKind.REQUESTED_DEADLINE_MISSED, name, sink, feed)


def _watch(network: Network, kind: QosEventKind, topic: str, end: ContractEndpoint, feed: JointStateFeed) -> None:
    def note() -> None:
        network.events.note(QosEvent(kind, topic, end.node, network.timers.now_ns))

    if end.qos.deadline_s is not None:
        StreamDeadline(end.qos.deadline_s, network.timers, feed.newest_arrival_ns, note)


def stream_edge(contract: Contract, network: Network, topic: str, source: str, sink: str) -> StreamEdge | None:
    """Return the edge of a stream; None where the contract does not describe both of its ends."""
    interface = contract.interfaces.get(topic)
    if interface is None:
        return None
    offered = next((end.qos for end in interface.sources if end.node == source), None)
    requested = next((end.qos for end in interface.sinks if end.node == sink), None)
    if offered is None or requested is None:
        return None
    return StreamEdge(EdgeName(topic, source, sink), offered, requested, network)


def _boxes(folder: GeneratedFolder) -> Iterator[tuple[str, Vector3]]:
    """Yield the boxes of the scene about their own frames, with their edges in m: parts lie on them."""
    for link in folder.description.links:
        frame = folder.contract.frames.get(link.name)
        for shape in link.collisions if frame is not None and frame.kind == "scene" else ():
            if isinstance(shape.geometry, Box) and shape.pose == identity():
                yield link.name, shape.geometry.size


def _horizon_s(contract: Contract) -> float:
    """Return for how long transforms are kept."""
    return max([DEFAULT_BUFFER_S, *(frame.buffer_s or 0.0 for frame in contract.frames.values())])


def assemble(
    folder: GeneratedFolder,
    memory: PlanMemory,
    seed: int,
    bring_up: Target = "mock",
    reality: Reality = AS_STATED,
    standing: ControlStack | None = None,
) -> Plant:
    """Create every node of the cell at time zero; nothing runs yet.

    Args:
        bring_up: target whose steps are taken; with ``real`` devices act as those of the robot do when they start.
        reality: where the cell differs from what its folder says.
        standing: a control stack that started before; None for one that is off.

    Raises:
        ManagerAbortedError: a controller manager ended while it started.
    """
    contract, noise = folder.contract, seed if reality.noise is None else reality.noise
    horizon_s = _horizon_s(contract)
    control = standing or _control(folder, noise, horizon_s)
    simulation = Simulation(control)
    clocks = build_clocks(_read(contract.clocks, reality.offsets_s), contract.clock_of, lambda: simulation.now_ns)
    network = Network(contract.interfaces, simulation, noise, middleware_of(contract))
    task, devices = _task_node(contract, control, network), DeviceView(contract, control)
    feeds = joint_state_feeds(contract, control, network, ROBOT_STATE_PUBLISHER)
    tf_edge = stream_edge(contract, network, TF, ROBOT_STATE_PUBLISHER, task.name)
    published = RobotStatePublisher(memory.model.links, feeds, PUBLISH_FREQUENCY_HZ, horizon_s, clocks, tf_edge)
    stops, watches = Stops(control), ClaimWatches(contract, folder.watches, control, simulation)
    effects = Effects(devices, stops, watches, simulation)
    world = World(memory.model.links.displaced(reality.links), control.histories.values(), control.dynamics)
    plant = Plant(
        contract=contract,
        bring_up=folder.bring_up if bring_up == "mock" else played(folder.real_bring_up, folder.bring_up, contract),
        simulation=simulation,
        clocks=clocks,
        network=network,
        control=control,
        stops=stops,
        watches=watches,
        effects=effects,
        start=RealStart(devices, effects, simulation),
        loads=Loads(contract, control, memory.model),
        world=world,
        parts=Parts(contract, control, world, dict(_boxes(folder)), control.dynamics),
        switches=Switches(contract),
        robot_state_publisher=published,
        planner=MotionPlanner(memory, seed),
        task=task,
    )
    control.listen(watches.look)
    if standing is None:
        plant.loads.begin()
    if bring_up == "real":
        plant.start.bring_up(folder.real_bring_up)
    clocks.listen(partial(_note_jump, plant))
    _add_objects(plant, _add_cameras(plant), reality, lay_out=standing is None)
    return plant


def _lay(plant: Plant, dynamics: Dynamics) -> None:
    """Put parts that have mass where they are stated to be."""
    servers = plant.control.managers.values()
    positions = {joint: at for server in servers for joint, at in server.joint_positions().items()}
    for name in filter(dynamics.moves, plant.world.objects()):
        placed = plant.world.placements(name)[-1]
        dynamics.put(name, plant.world.posed(placed.link, positions) @ placed.pose)


def _add_objects(plant: Plant, images: dict[str, Topic[Image]], reality: Reality, *, lay_out: bool) -> None:
    tf = TfBroadcast(plant.contract.interfaces.get(TF), plant.task.name, plant.network, plant.simulation)
    executors = Executors(plant.simulation)
    for name, frame in plant.contract.frames.items():
        if frame.kind == "dynamic" and frame.simulated_parent is not None:
            _add_object(plant, executors, name, frame, images, tf, reality.objects.get(name))
        elif frame.kind == "fixed" and frame.grasp is not None:
            plant.world.place(name, name, identity(), 0)
    if plant.control.dynamics is not None and lay_out:
        _lay(plant, plant.control.dynamics)
        make_real(plant.control.dynamics, plant.contract, reality)


def _turned(pose: Pose, turn: Pose) -> Pose:
    """Return a pose turned about its own origin, in the axes that it is given in."""
    return Pose(pose.position, (turn @ Pose((0.0, 0.0, 0.0), pose.quaternion)).quaternion)


def _read(clocks: Mapping[str, ContractClock], more_s: Mapping[str, float]) -> Mapping[str, ContractClock]:
    """Return clocks that read more than is stated of them."""
    known = {name: more for name, more in more_s.items() if name in clocks}
    moved = {
        name: clocks[name].model_copy(update={"offset_s": clocks[name].offset_s + more}) for name, more in known.items()
    }
    return {**clocks, **moved}


def _task_node(contract: Contract, control: ControlStack, network: Network) -> TaskNode:
    name = task_node(contract)
    feeds = joint_state_feeds(contract, control, network, name)
    return TaskNode(name, TransformBuffer(), feeds, {}, TaskRequests(), ActionStatus(), Milestones())


def _note_jump(plant: Plant, jump: TimeJump) -> None:
    """Let the listener of the task hear of a clock that was set, and the task look at what it waits for."""
    if jump.clock is plant.clocks.of(plant.task.name):
        plant.robot_state_publisher.catch_up(jump.at_ns)
        plant.task.buffer.note_jump(jump)
    plant.task.requests.changed.fire(jump.at_ns)


def _control(folder: GeneratedFolder, seed: int, horizon_s: float) -> ControlStack:
    contract, forces = folder.contract, None
    if folder.scene is not None:
        fingers = fingers_by_gripper(contract, folder.description)
        planned, owners = planned_contacts(folder.scene, fingers), len(contract.managers) + len(contract.adapters)
        forces = Dynamics(folder.scene, planned, fingers, _leads_s(contract), owners)
    managers = _managers(folder, forces)
    control = ControlStack(managers, contract.managers, horizon_s, _adapters(contract, forces), forces)
    for joint, nature in _natures(contract, seed).items():
        for server in control.servers_of_joint(joint):
            server.disturbances.disturb(joint, nature)
    return control


def _leads_s(contract: Contract) -> dict[str, float]:
    """Return the joints behind springs whose damping brakes their error alone, each with damping over stiffness."""
    laws = [device.law for device in contract.devices.values() if device.law is not None and not device.law.lags]
    return {joint: spring.lag_s for law in laws for joint, spring in law.joints.items()}


def _managers(folder: GeneratedFolder, forces: Dynamics | None) -> Mapping[str, ControllerManager]:
    contract = folder.contract
    return {
        name: ControllerManager(
            replace(folder.description, hardware=tuple(_hardware(folder, manager))),
            folder.parameters[name],
            namespace=manager.namespace,
            distro=contract.distro,
            plugin_behaviors=contract.plugin_behaviors,
            declared={
                controller: DeclaredInterfaces(facts.command_interfaces, facts.state_interfaces)
                for controller, facts in manager.controllers.items()
            },
            forces=forces,
        )
        for name, manager in contract.managers.items()
    }


def _hardware(folder: GeneratedFolder, manager: ContractManager) -> Iterator[HardwareComponent]:
    """Yield what a manager of one part of the cell reads of: the hardware of that part; all where all is one part."""
    parts, components = folder.contract.parts, folder.description.hardware
    loops = manager.controllers.values()
    used = {name.partition("/")[0] for loop in loops for name in (*loop.command_interfaces, *loop.state_interfaces)}
    own = {
        component.name
        for component in components
        if any(item.name in used for item in (*component.joints, *component.sensors, *component.gpios))
    }
    devices = {name: device.hardware_component for name, device in folder.contract.devices.items()}
    together = [{devices.get(name) for name in part} for part in parts]
    read = own.union(*(part for part in together if not own.isdisjoint(part)))
    yield from (component for component in components if not parts or not own or component.name in read)


def _adapters(contract: Contract, forces: Dynamics | None) -> Mapping[str, AdapterServer]:
    known = contract.clocks
    clocks = {device: known[name].domain for device, name in contract.clock_of.items() if name in known}
    return {
        device: AdapterServer(device, facts, contract.joint_limits, clocks.get(device, DEFAULT), forces)
        for device, facts in contract.adapters.items()
    }


def _natures(contract: Contract, seed: int) -> dict[str, JointFault]:
    """Return how joints differ from those that follow their commands immediately, when nothing is wrong."""
    fingers = {
        device.gripper.joint: device.gripper.max_velocity for device in contract.devices.values() if device.gripper
    }
    as_they_are = ContractSimulatedJoint()
    natures: dict[str, JointFault] = {}
    for joint in dict.fromkeys((*fingers, *contract.simulated_joints)):
        facts = contract.simulated_joints.get(joint, as_they_are)
        speed = facts.max_velocity or fingers.get(joint) or inf
        noise = Noise.of_joint(joint, facts.noise, seed) if facts.noise else None
        natures[joint] = JointFault(time_constant_s=facts.lag_s, max_velocity=speed, noise=noise)
    return {joint: nature for joint, nature in natures.items() if nature != JointFault()}


def _add_cameras(plant: Plant) -> dict[str, Topic[Image]]:
    topics: dict[str, Topic[Image]] = {}
    for device, facts in plant.contract.devices.items():
        if facts.camera is None or facts.camera.topic not in plant.contract.interfaces:
            continue
        interface = plant.contract.interfaces[facts.camera.topic]
        topic = topics.setdefault(facts.camera.topic, Topic[Image](facts.camera.topic, interface, plant.network))
        source = interface.sources[0].node if interface.sources else device
        # Where the network is simulated the edge brings the latency; else the stated budget represents it.
        transport_s = interface.transport_s if interface.simulated is None else 0.0
        plant.cameras[device] = Camera(
            source, facts.camera, topic, transport_s, plant.clocks.of(device), plant.simulation
        )
    return topics


def _add_object(
    plant: Plant,
    executors: Executors,
    name: str,
    frame: ContractFrame,
    images: Mapping[str, Topic[Image]],
    tf: TfBroadcast,
    displaced: Displacement | None,
) -> None:
    """Place the object that a dynamic frame follows, with the node that sees it and the inbox of the task."""
    pose = frame.simulated_pose
    assert frame.simulated_parent is not None  # the caller asked
    position = identity() if pose is None else pose.pose
    if displaced is not None:
        position = Pose(displaced.along, (0.0, 0.0, 0.0, 1.0)) @ _turned(position, displaced.turned)
    plant.world.place(name, frame.simulated_parent, position, 0)
    transform = SampledSource(
        frame.parent, name, frame.authority, frame.buffer_s or DEFAULT_BUFFER_S, plant.task.buffer.warnings
    )
    if hears(plant.contract, TF, frame.authority, plant.task.name):
        plant.task.buffer.add(name, transform)
    stated = pose_interface(plant.contract, name)
    topic = None if stated is None else Topic[ObjectPose](*stated, plant.network)
    interface = None if stated is None else stated[1]
    inbox = ObservationInbox(interface, plant.clocks.of(plant.task.name), plant.simulation)
    plant.task.observations[name] = inbox
    if topic is not None and interface is not None and interface.sinks:
        inbox.subscribe(topic, interface.sinks[0].node, executors)

    def publish(sample: ObjectPose) -> None:
        if topic is None:
            inbox.accept(sample)  # the task hears of the frame through /tf alone
        else:
            topic.publish(frame.authority, sample)

    for image_topic, stream in images.items():
        subscription = stream.subscribe(frame.authority)
        if subscription is not None:
            max_age_s = plant.contract.interfaces[image_topic].max_age_s
            clock = plant.clocks.of(frame.authority)
            sender = tf.sender(frame.authority, name, transform)
            plant.perceptions[name] = Perception(
                name, frame, subscription, max_age_s, publish, sender, plant.world, clock, executors, plant.simulation
            )
            break


def start_nodes(plant: Plant) -> None:
    """Start cameras and perception, and what watches the deadlines of joint states."""
    watch_deadlines(plant.contract, plant.control, plant.network)
    for camera in plant.cameras.values():
        camera.start()
    for name, perception in plant.perceptions.items():
        perception.start(plant.contract.frames[name].rate_hz or DEFAULT_RATE_HZ)
