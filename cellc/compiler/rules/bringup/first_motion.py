"""Rules on the first motion of a robot after it was started."""

from __future__ import annotations

import math

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, did_you_mean, found, rule


@rule(Severity.ERROR)
def first_motion_cannot_end(graph: CellGraph) -> Findings:
    """Yield a first motion whose delta needs more time at its velocity than allowed."""
    motion = graph.cell.bringup.first_motion
    if motion is None:
        return
    needed = motion.max_delta.value / motion.velocity.value
    if needed > motion.timeout_s:
        max_delta, velocity, timeout = (
            graph.cell.text("bringup", "first_motion", key) for key in ("max_delta", "velocity", "timeout")
        )
        message = f"{max_delta} at {velocity} takes {needed:.3g} s, but the timeout is {timeout}"
        yield found(graph, ("bringup", "first_motion", "timeout"), message, f"allow at least {needed:.3g} s")


@rule(Severity.ERROR)
def first_motion_of_unknown_joint(graph: CellGraph) -> Findings:
    """Yield a first motion whose joint no device drives."""
    motion = graph.cell.bringup.first_motion
    driven = [f"{device.name}/{joint.local_name}" for device in graph.cell.devices for joint in device.actuated_joints]
    if motion is not None and motion.joint not in driven:
        message = f"no device drives a joint `{motion.joint}`"
        yield found(
            graph, ("bringup", "first_motion", "joint"), message, did_you_mean(motion.joint, driven, "driven joints")
        )


_LARGEST_RAD = math.radians(15.0)
_LARGEST_M = 0.05


@rule(Severity.ERROR)
def first_motion_too_large(graph: CellGraph) -> Findings:
    """Yield a delta or velocity above the bound of a first motion."""
    motion = graph.cell.bringup.first_motion
    if motion is None:
        return
    for field, value in (("max_delta", motion.max_delta), ("velocity", motion.velocity)):
        if value.value > (_LARGEST_M if value.linear else _LARGEST_RAD):
            path = ("bringup", "first_motion", field)
            largest = "50 mm" if value.linear else "15 deg"
            per = " per second" if field == "velocity" else ""
            allowed, stated = f"{largest}{per}", graph.cell.text(*path)
            message = f"`{field}` of the first motion must be at most {allowed}, got {stated}"
            yield found(graph, path, message, f"write at most {largest}{per}")


@rule(Severity.BLOCKER)
def missing_first_motion(graph: CellGraph) -> Findings:
    """Yield a cell that moves joints and does not state its first motion."""
    moves = any(controller.command_interfaces for controller in graph.cell.controllers)
    if moves and graph.cell.bringup.first_motion is None:
        message = "the single-joint move of gate G6 is not stated"
        yield found(graph, ("bringup", "first_motion"), message)
