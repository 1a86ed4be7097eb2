"""Binds what MoveIt does beyond planning: the occupancy map, and servoing."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from cellc.compiler.cell.control import Controller
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.interface import Node
from cellc.compiler.cell.motion import POINT_CLOUD, Octomap, PlanningGroup, Servo
from cellc.compiler.link.names import unknown_name
from cellc.compiler.link.quantities import si
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.interfaces import TopicSpec
from cellc.compiler.spec.moveit import OctomapSpec, ServoSpec
from cellc.contract.diagnostics import Outcome
from cellc.contract.vocabulary import Behavior

_MADE_OF_IMAGES = ("model_depth", "filtered_label", "octomap_input_without_robot")
_MADE_OF_CLOUDS = ("octomap_input_without_robot",)
_PERIOD_S, _TIMEOUT_S = 0.01, 0.1
_UPDATES_HZ = 1.0
_NEAREST_M = 0.1


def link_octomap(written: OctomapSpec | None, devices: Iterable[Device]) -> Octomap | None:
    """Return the occupancy map; whether anything feeds it is asked by a rule."""
    if written is None:
        return None
    cameras = (device.sensing.camera for device in devices if device.sensing.camera is not None)
    views = (stream.view for camera in cameras for stream in camera.streams if stream.topic == written.source)
    nearest = next((view.nearest_m for view in views if view is not None), _NEAREST_M)
    return Octomap(
        source=written.source,
        resolution_m=written.resolution.si,
        range_m=written.range.si,
        padding_m=written.padding.si,
        rate_hz=si(written.rate) or _UPDATES_HZ,
        nearest_m=nearest,
    )


def with_octomap(node: Node, spec: CellSpec) -> Node:
    """Return a node with what the occupancy map publishes, where it is the one that keeps it.

    Source: moveit2@2.12.4 moveit_ros/perception/depth_image_octomap_updater/src/depth_image_octomap_updater.cpp:84-100,
    moveit_ros/perception/pointcloud_octomap_updater/src/pointcloud_octomap_updater.cpp:112; @2.5.9 :82-94, :116.
    Further transports of an image, which follow from installed plugins, are left out.
    """
    octomap = spec.motion.octomap
    if octomap is None or (node.package, node.executable) != ("moveit_ros_move_group", "move_group"):
        return node
    source = spec.interfaces.get(octomap.source)
    names = [*_MADE_OF_CLOUDS]
    if not isinstance(source, TopicSpec) or source.topic != POINT_CLOUD:
        names = [name for image in _MADE_OF_IMAGES for name in (image, f"{image.rpartition('/')[0]}camera_info")]
    publishes = (*node.endpoints.publishes, *dict.fromkeys(names))
    return replace(node, endpoints=replace(node.endpoints, publishes=publishes))


def link_servo(
    spec: CellSpec, document: SourceDocument, groups: Iterable[PlanningGroup], controllers: Iterable[Controller]
) -> Outcome[Servo | None]:
    """Bind servoing to its node, group and controller; whether they fit each other is asked by a rule."""
    servo, path = spec.motion.servo, ("motion", "servo")
    if servo is None:
        return Outcome(None)
    known = {controller.name: controller for controller in controllers}
    group = _group(spec, servo)
    names: tuple[tuple[str, str, Iterable[str]], ...] = (
        ("node", servo.node, tuple(spec.nodes)),
        ("group", group, tuple(spec.motion.groups)),
        ("controller", servo.controller, tuple(known)),
    )
    unknown = [
        unknown_name(f"unknown-{kind}", name, kind, there, document, (*path, kind))
        for kind, name, there in names
        if name not in there
    ]
    if unknown or group not in {group.name for group in groups}:
        return Outcome(None, tuple(unknown))
    controller = known[servo.controller]
    streamed = controller.behavior is Behavior.FORWARD_COMMAND
    kinds = {name.rpartition("/")[2] for name in controller.all_claims}
    return Outcome(
        Servo(
            node=servo.node,
            group=group,
            controller=controller.full_name,
            topic=f"{controller.full_name}/{'commands' if streamed else 'joint_trajectory'}",
            type="std_msgs/msg/Float64MultiArray" if streamed else "trajectory_msgs/msg/JointTrajectory",
            positions=not streamed or "position" in kinds,
            velocities=not streamed or "velocity" in kinds,
            commands=servo.commands,
            linear=servo.linear.si,
            rotational=servo.rotational.si,
            joint=servo.joint.si,
            period_s=si(servo.period) or _PERIOD_S,
            command_timeout_s=si(servo.command_timeout) or _TIMEOUT_S,
        )
    )


def _group(spec: CellSpec, written: ServoSpec) -> str:
    alone = next(iter(spec.motion.groups), "") if len(spec.motion.groups) == 1 else ""
    return written.group or alone
