"""Rules on the first motion of each robot after it was started."""

from __future__ import annotations

import math

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, did_you_mean, enters, found, rule


@rule(Severity.ERROR)
def first_motion_cannot_end(graph: CellGraph) -> Findings:
    """Yield first motions whose delta needs more time at their velocity than allowed."""
    for motion in graph.cell.bringup.first_motions:
        needed = motion.max_delta.value / motion.velocity.value
        if needed > motion.timeout_s:
            max_delta, velocity, timeout = (
                graph.cell.text(*motion.path, key) for key in ("max_delta", "velocity", "timeout")
            )
            message = f"{max_delta} at {velocity} takes {needed:.3g} s, but the timeout is {timeout}"
            related = enters(graph, "it enters here", *((*motion.path, key) for key in ("max_delta", "velocity")))
            yield found(graph, (*motion.path, "timeout"), message, f"allow at least {needed:.3g} s", related)


@rule(Severity.ERROR)
def first_motion_of_unknown_joint(graph: CellGraph) -> Findings:
    """Yield first motions whose joint no device drives."""
    driven = [f"{device.name}/{joint.local_name}" for device in graph.cell.devices for joint in device.actuated_joints]
    for motion in graph.cell.bringup.first_motions:
        if motion.name not in driven:
            message = f"no device drives a joint `{motion.name}`"
            yield found(graph, (*motion.path, "joint"), message, did_you_mean(motion.name, driven, "driven joints"))


_LARGEST_RAD = math.radians(15.0)
_LARGEST_M = 0.05


@rule(Severity.ERROR)
def first_motion_too_large(graph: CellGraph) -> Findings:
    """Yield deltas and velocities above the bound of a first motion."""
    for motion in graph.cell.bringup.first_motions:
        for field, value in (("max_delta", motion.max_delta), ("velocity", motion.velocity)):
            if value.value > (_LARGEST_M if value.linear else _LARGEST_RAD):
                largest = "50 mm" if value.linear else "15 deg"
                per = " per second" if field == "velocity" else ""
                stated = graph.cell.text(*motion.path, field)
                message = f"`{field}` of the first motion must be at most {largest}{per}, got {stated}"
                yield found(graph, (*motion.path, field), message, f"write at most {largest}{per}")


@rule(Severity.BLOCKER, assumes=("shared-prefix",))
def missing_first_motion(graph: CellGraph) -> Findings:
    """Yield cells that move joints without a first motion, and arms and axes without their own beside one."""
    motions = graph.cell.bringup.first_motions
    if not motions:
        if any(controller.command_interfaces for controller in graph.cell.controllers):
            yield found(graph, ("bringup", "first_motion"), "the single-joint move of gate G6 is not stated")
        return
    stated = {motion.device for motion in motions}
    for device in graph.cell.devices:
        moves = any(joint.name in graph.cell.trajectory_joints for joint in device.joints)
        if device.name not in stated and device.gripper is None and moves:
            message = f"the single-joint move of gate G6 is not stated for `{device.name}`"
            yield found(graph, ("bringup", "first_motion"), message)
