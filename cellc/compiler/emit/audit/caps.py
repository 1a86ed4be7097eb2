"""What caps planned motion in each stage of commissioning, and what does not: two lists of the audit."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.deploy.files import stage_files
from cellc.compiler.formats.escape import code, markdown
from cellc.compiler.formats.markdown_table import table
from cellc.compiler.formats.numbers import at_most, shortest
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.commissioning import LINEAR_M_S, stages
from cellc.contract.vocabulary import Feature, features


def caps_section(graph: CellGraph) -> str:
    """Write the stages, what each cap rests on, and what goes past them."""
    files, bounds = stage_files(graph.cell), _bounds(graph.cell)
    head = ("stage", "tip at most, on any path", "straight lines at most", "accelerations", "parameters")
    rows = (
        (
            f"{stage.percent} %",
            ", ".join(f"{name} {at_most(speed)} m/s" for name, speed in stage.tips.items()),
            f"{stage.of_straight(LINEAR_M_S) * LINEAR_M_S:.3g} m/s",
            f"{stage.acceleration:.3g} of each limit",
            code(files[stage.percent]),
        )
        for stage in stages(graph)
    )
    lines = [*bounds, *_past(graph.cell)]
    return table(head, rows) + "\n\n" + "\n".join(f"- {markdown(line)}" for line in lines)


def _bounds(cell: Cell) -> Iterator[str]:
    caps = cell.bringup.caps
    yield (
        "The tip column is a bound: all joints of the group at their caps, and all between joint and tip straightened."
    )
    yield "move_group plans within these limits. A request can only scale them down."
    if cell.servo is not None:
        by = "its scales are capped too" if cell.servo.commands == "unitless" else "its scales do not apply to units"
        yield f"{cell.servo.node} (MoveIt Servo) slows down to the joint limits; {by}."
    if caps is not None and caps.reach is not None:
        reach = shortest(caps.reach)
        yield f"Reach {reach} m: poses and goals are checked. No MoveIt parameter keeps a path within it."
    if caps is not None and caps.force is not None:
        yield f"Grip force {shortest(caps.force)} N: the contract has it as the largest effort that the task asks for."


def _past(cell: Cell) -> Iterator[str]:
    """Yield what no stage caps, each with what is left to stop it."""
    for controller in cell.trajectory_controllers:
        yield (
            f"Not capped: a goal that a client sends directly to {controller.action}, with its own times. "
            f"{_enforced(cell)}{_scaled(cell, controller.device)}"
        )
    yield "Not capped: a trajectory that a client has move_group execute without planning it."
    for node in cell.movers:
        yield f"{node.name} is a motion client: what it sends past move_group is as fast as its own code makes it."


def _enforced(cell: Cell) -> str:
    unlimited = any(
        device.control.hardware is not None and device.control.hardware.enforce_command_limits is False
        for device in cell.devices
    )
    if Feature.LIMITED_BY_DEFAULT in features(cell.distro) and not unlimited:
        return "The controller manager enforces the limits of the URDF, which no stage changes."
    return "No limit is enforced below it."


def _scaled(cell: Cell, device: str | None) -> str:
    scales = device is not None and cell.device(device).control.speed_scaling is not None
    return f" The speed setting of {device} slows it down." if scales else ""
