"""``config/cell.rviz``: what RViz 2 shows: the robot, its transforms, the planned scene and path, images.

A file of ``rviz2 -d``, Humble to Lyrical, in YAML. It shows and never commands. MoveIt's display that plans and
executes is left out: its button is a second client of move_group past the gates. The tools that publish goals and
initial poses are left out too.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.frame import WORLD
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.files import RVIZ, plans
from cellc.compiler.formats.yaml_text import Tree, render
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.vocabulary import InterfaceKind

_IMAGE = "sensor_msgs/msg/Image"
_TOOLS = ("Interact", "MoveCamera", "Select", "FocusCamera", "Measure")


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the configuration."""
    cell = graph.cell
    tree: Tree = {
        "Panels": (
            {"Class": "rviz_common/Displays", "Name": "Displays"},
            {"Class": "rviz_common/Views", "Name": "Views"},
        ),
        "Visualization Manager": {
            "Class": "",
            "Displays": tuple(_displays(cell)),
            "Global Options": {"Fixed Frame": WORLD, "Frame Rate": 30},
            "Tools": tuple({"Class": f"rviz_default_plugins/{tool}"} for tool in _TOOLS),
            "Views": {"Current": {"Class": "rviz_default_plugins/Orbit", "Distance": 3.0, "Target Frame": WORLD}},
        },
    }
    yield Artifact(RVIZ, plan.header.commented("#") + "# devices, interfaces: displays of the cell\n" + render(tree))


def _displays(cell: Cell) -> Iterator[Tree]:
    yield _display("rviz_default_plugins/Grid", "Grid", {"Cell Size": 1.0, "Plane Cell Count": 10})
    latched: Tree = {"Value": "/robot_description", "Depth": 1, "Durability Policy": "Transient Local"}
    robot: Tree = {"Description Source": "Topic", "Description Topic": latched, "Visual Enabled": True}
    yield _display("rviz_default_plugins/RobotModel", "Robot", robot)
    yield _display("rviz_default_plugins/TF", "Frames", {"Show Names": False, "Frame Timeout": 15.0})
    if plans(cell):
        place = cell.planners[0].namespace
        scene: Tree = {"Planning Scene Topic": f"{place}/monitored_planning_scene"}
        yield _display("moveit_rviz_plugin/PlanningScene", "Planning scene", {**scene, **_MODEL})
        path: Tree = {"Trajectory Topic": f"{place}/display_planned_path", "Loop Animation": False}
        yield _display("moveit_rviz_plugin/Trajectory", "Planned path", {**path, **_MODEL})
    for interface in cell.interfaces:
        if interface.kind is InterfaceKind.TOPIC and interface.type == _IMAGE:
            seen: Tree = {"Value": interface.name, "Depth": 1, "Reliability Policy": "Best Effort"}
            yield _display("rviz_default_plugins/Image", interface.name, {"Topic": seen})


_MODEL: Tree = {"Robot Description": "robot_description"}


def _display(class_: str, name: str, properties: Tree) -> Tree:
    return {"Class": class_, "Name": name, "Enabled": True, **properties}
