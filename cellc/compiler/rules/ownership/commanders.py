"""Rules on who commands a robot."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller
from cellc.compiler.cell.motion import Servo
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, enters, found, rule
from cellc.contract.vocabulary import TRAJECTORIES, Behavior, Distro, InterfaceKind


@rule(Severity.BLOCKER)
def adapter_without_program(graph: CellGraph) -> Findings:
    """Yield direct-SDK devices that stand at an interface without a node that is started for them."""
    started = {node.full_name for node in graph.cell.nodes}
    ends = [end for interface in graph.cell.interfaces for end in (*interface.sources, *interface.sinks)]
    missing = {end.node for end in ends if end.full_name not in started}
    for device in graph.cell.devices:
        if device.architecture == "direct_sdk" and device.name in missing:
            message = f"nothing starts the adapter of `{device.name}` on the real target"
            yield found(graph, (*device.path, "architecture"), message)


_EXECUTING = frozenset({"moveit_msgs/action/MoveGroup", "moveit_msgs/action/ExecuteTrajectory"})


@rule(Severity.WARNING)
def controller_of_another_client(graph: CellGraph) -> Findings:
    """Yield trajectory controllers whose client has no goals of its own, beside a node that executes motion."""
    actions = [
        interface
        for interface in graph.cell.interfaces
        if interface.kind is InterfaceKind.ACTION and not interface.derived
    ]
    executing = {
        end.node: interface for interface in actions if interface.type in _EXECUTING for end in interface.sources
    }
    declared = {(interface.name, end.node) for interface in actions for end in interface.sinks}
    for controller in graph.cell.controllers:
        client = controller.client
        if controller.behavior not in TRAJECTORIES or client is None or not executing or client in executing:
            continue
        commands = graph.data.path_to_motion(client)[1:2] != (controller.label,)
        asks = any(
            sink == client for name, sink in declared if name in {interface.name for interface in executing.values()}
        )
        if (controller.action or "", client) not in declared and not asks and not commands:
            server, action = next(iter(executing.items()))
            message = (
                f"the client of `{controller.name}` must be `{server}`, which executes `{action.name}`, got `{client}`"
            )
            related = (Related("motion is executed here", action.span),)
            yield found(graph, (*controller.path, "client"), message, related=related)


@rule(Severity.BLOCKER)
def controller_without_client(graph: CellGraph) -> Findings:
    """Yield controllers with command interfaces and without a client."""
    for controller in graph.cell.controllers:
        if controller.command_interfaces and controller.client is None:
            message = f"controller `{controller.name}` has no declared client"
            yield found(graph, controller.path, message)


@rule(Severity.ERROR)
def direct_sdk_without_adapter(graph: CellGraph) -> Findings:
    """Yield direct-SDK devices without a topic of stamped, rated, age-limited state."""
    for device in graph.cell.devices:
        if device.architecture != "direct_sdk":
            continue
        contract = any(
            source.node == device.name and interface.rate_hz and interface.max_age_s
            for interface in graph.cell.interfaces
            for source in interface.sources
        )
        if not contract:
            message = f"`{device.name}` is driven by a direct SDK, but no interface carries its stamped state"
            path = (*device.path, "architecture")
            yield found(graph, path, message)


@rule(Severity.ERROR)
def direct_sdk_without_bounded_command(graph: CellGraph) -> Findings:
    """Yield direct-SDK devices with joints that neither a controller nor an action of the device bounds."""
    driven = {joint for controller in graph.cell.controllers for joint in controller.joints}
    bounded = {
        source.node
        for interface in graph.cell.interfaces
        if interface.kind is InterfaceKind.ACTION and interface.timeout_s
        for source in interface.sources
    }
    for device in graph.cell.devices:
        moves = any(joint.name not in driven for joint in device.actuated_joints)
        if device.architecture == "direct_sdk" and moves and device.name not in bounded:
            message = f"`{device.name}` is driven by a direct SDK, but no action bounds its commands"
            path = (*device.path, "architecture")
            yield found(graph, path, message, f"declare an action with `server: {device.name}` and a timeout")


@rule(Severity.ERROR)
def own_motion_at_start(graph: CellGraph) -> Findings:
    """Yield controllers of a device's own motion that no step switches to."""
    for controller in graph.cell.controllers:
        if controller.behavior is Behavior.OWN_MOTION and controller.active:
            message = f"`{controller.name}` moves `{controller.device}` past its joints, and is active from the start"
            yield found(graph, controller.path, message)


_SERVO_HZ = 100.0  # above it a reference stream is a servo loop, below it a set point


@rule(Severity.ERROR)
def scripted_servo_loop(graph: CellGraph) -> Findings:
    """Yield Python nodes that stream references to a controller at a servo rate."""
    scripted = {node.name: node for node in graph.cell.nodes if node.language == "python"}
    for interface in graph.cell.interfaces:
        commanded = any(sink.node in graph.data.commanders for sink in interface.sinks)
        if interface.kind is not InterfaceKind.TOPIC or not commanded or (interface.rate_hz or 0.0) < _SERVO_HZ:
            continue
        for source in interface.sources:
            if source.node in scripted:
                message = (
                    f"Python node `{source.node}` streams references on `{interface.name}` at {interface.rate_hz:g} Hz"
                )
                yield found(graph, source.path, message, related=enters(graph, "so fast", (*interface.path, "rate")))


@rule(Severity.ERROR)
def second_action_server(graph: CellGraph) -> Findings:
    """Yield servers of an action that a controller serves itself."""
    owners = {controller.action: controller for controller in graph.cell.controllers if controller.action}
    for interface in graph.cell.interfaces:
        owner = owners.get(interface.name)
        for source in interface.sources:
            if owner is not None and source.full_name != owner.full_name:
                message = f"`{source.node}` serves `{interface.name}`, which controller `{owner.name}` serves itself"
                related = (Related("the controller is here", owner.span),)
                yield found(graph, source.path, message, related=related)


@rule(Severity.ERROR)
def second_command_publisher(graph: CellGraph) -> Findings:
    """Yield each further publisher of a topic that a controller follows."""
    for interface in graph.cell.interfaces:
        commanded = next((sink.node for sink in interface.sinks if sink.node in graph.data.commanders), None)
        if interface.kind is not InterfaceKind.TOPIC or commanded is None:
            continue
        for source in interface.sources[1:]:
            first = interface.sources[0]
            message = f"`{source.node}` and `{first.node}` both command `{commanded}` over `{interface.name}`"
            related = (Related("first commanded here", first.span),)
            yield found(graph, source.path, message, related=related)


@rule(Severity.ERROR)
def second_commander(graph: CellGraph) -> Findings:
    """Yield each further client of an action that ends in a controller."""
    declared = {c.action: c.client for c in graph.cell.controllers if c.action and c.client}
    for interface in graph.cell.interfaces:
        if interface.kind is not InterfaceKind.ACTION or interface.derived:
            continue
        owner = declared.get(interface.name) or next((sink.node for sink in interface.sinks), "")
        for sink in interface.sinks:
            if sink.node != owner:
                message = f"`{sink.node}` sends goals to `{interface.name}`, which `{owner}` commands"
                yield found(graph, sink.path, message, f"send the goals through `{owner}`")


_SERVO_PACKAGE = "moveit_servo"
_SERVO_EXECUTABLES = {Distro.HUMBLE: "servo_node_main"}
"""What runs it where that is not ``servo_node``: moveit2 2.5.9, moveit_ros/moveit_servo/CMakeLists.txt."""


@rule(Severity.ERROR)
def unfit_servo(graph: CellGraph) -> Findings:
    """Yield what keeps Servo from commanding its controller alone, with its parameters."""
    cell, servo = graph.cell, graph.cell.servo
    if servo is None:
        return
    path = ("motion", "servo")
    (node,) = (node for node in cell.nodes if node.path == ("nodes", servo.node))
    wanted = f"{_SERVO_PACKAGE}/{_SERVO_EXECUTABLES.get(cell.distro, 'servo_node')}"
    if f"{node.package}/{node.executable}" != wanted:
        message = f"`{servo.node}` must run `{wanted}` on {cell.distro}, got `{node.package}/{node.executable}`"
        program = Related("its program is here", graph.cell.locate(*node.path, "run"))
        yield found(graph, (*path, "node"), message, related=(program,))
    if not any((node.package, node.executable) == ("moveit_ros_move_group", "move_group") for node in cell.nodes):
        yield found(graph, (*path, "node"), f"`{servo.node}` needs a node that runs move_group, whose scene it follows")
    (controller,) = (controller for controller in cell.controllers if controller.full_name == servo.controller)
    if refused := next(_refused_servo(cell, servo, controller), ""):
        places = (("its client is here", "client"), ("the controller is here", "type"))
        related = tuple(Related(text, graph.cell.locate(*controller.path, key)) for text, key in places)
        yield found(graph, (*path, "controller"), refused, related=related)


def _refused_servo(cell: Cell, servo: Servo, controller: Controller) -> Iterator[str]:
    """Yield why a controller must not be commanded by Servo."""
    streamed = controller.behavior is Behavior.FORWARD_COMMAND
    if not streamed and controller.behavior not in TRAJECTORIES:
        yield f"`{controller.name}` must take joint positions or velocities from a topic, got {controller.kind}"
    if streamed and servo.positions == servo.velocities:
        yield f"`{controller.name}` must command either position or velocity, not both"
    if controller.client != servo.node:
        client = controller.client or "no node"
        yield f"`{servo.node}` must be the client of `{controller.name}`, which is commanded by {client}"
    (group,) = (group for group in cell.groups if group.name == servo.group)
    if controller.joints != group.joints:
        yield f"`{controller.name}` must have the joints of `{group.name}` in their order"
