"""Paths inside the generated package, and which of its files MoveIt's move_group is given."""

from __future__ import annotations

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import AdaptedDevice, Controller, ControllerManager
from cellc.compiler.cell.interface import Node, NodeSource
from cellc.compiler.graph.commissioning import percent
from cellc.contract.diagnostics import YamlPath
from cellc.contract.entities import TARGETS

REHEARSALS = "rehearsals.json"
"""What the mock executes."""

BRING_UP = "config/bring_up.json"
"""The steps of the bring-up."""

BRING_UP_PROGRAM = "scripts/bring_up"
"""What takes them; installed as a program of the package."""

VERSIONS_PROGRAM = "scripts/installed_versions.py"
"""What compares the version tuple with what is installed."""

REQUIRED_PROGRAM = "scripts/required"
"""What ends a launch with one of its programs, where launch has no word for that."""

WATCH_PROGRAM = "scripts/claim_watch"
"""What takes claims from a robot that no longer follows set points."""

OBSERVATION = "config/observe.json"
"""What runs on each target: the ends of interfaces, states and nodes."""

OBSERVE_PROGRAM = "scripts/observe"
OBSERVE_MODULES = tuple(f"scripts/observe_{part}.py" for part in ("checks", "host", "listener", "reports"))
"""What compares that with the running graph and computer, and its comparisons."""

RECORDING = "config/recording_qos.yaml"
"""QoS with which an attempt is recorded."""

PROMOTION_CHECKLIST = "gates/promotion.md"
NETWORK_CHECKLIST = "gates/network.md"
"""Checklists of gates G0 to G7 and of layers L1 to L6."""

SOURCES = "sources.repos"
"""Repositories of what no distribution releases, as vcstool reads them."""

AMONG_MOCK = "launch/among_mock.launch.xml"
"""Starts nodes of the spec beside a cell that the mock plays."""

SCENE = "sim/scene.xml"
"""The cell for a simulator of contacts and torques."""

CONTROLLERS_ON_SIM = "config/controllers.sim.yaml"
"""Controllers and cameras as the simulator has them."""

RVIZ = "config/cell.rviz"
"""What RViz shows of the cell."""

NODES, DRIVERS = "config/nodes.yaml", "config/drivers.yaml"
"""Parameters of nodes, each under its name; what only real hardware starts apart, so that no mock gets an address."""

JOINT_LIMITS = "config/joint_limits.yaml"
CONTROLLERS = "config/moveit/controllers.yaml"
PARAMETER_FILES = (
    "config/moveit/kinematics.yaml",
    JOINT_LIMITS,
    CONTROLLERS,
    "config/moveit/move_group.yaml",
)
"""In the order in which move_group is given them."""

SERVO = "config/moveit/servo.yaml"
"""What MoveIt Servo gets, where the cell has it."""

SENSORS = "config/moveit/sensors_3d.yaml"
"""What feeds the occupancy map of move_group, where the cell has one."""

COMMISSIONING = "config/commissioning/"
"""Caps of planned motion, a file for each stage; the last that a node is given."""

FIRST_GOAL_PROGRAM = "scripts/first_goal"
"""What sends the one small goal before an application is started."""


def description_file(cell: Cell, target: str) -> str:
    """Return the path of the URDF for ``mock`` or ``real``."""
    return f"urdf/{cell.name}.{target}.urdf"


def manager_description_file(cell: Cell, manager: ControllerManager, target: str) -> str:
    """Return the path of the URDF that a controller manager reads: the cell's, or one with its own hardware alone."""
    return f"urdf/{cell.name}{'' if len(cell.managers) == 1 else f'.{manager.name}'}.{target}.urdf"


def controllers_file(cell: Cell, manager: ControllerManager, target: str) -> str:
    """Return the path of a controller manager's parameter file for a target: one, unless the targets differ."""
    of_target = f".{target}" if any(controller.on_real is not None for controller in manager.controllers) else ""
    return f"config/{'' if len(cell.managers) == 1 else f'{manager.name}.'}controllers{of_target}.yaml"


def node_file(node: Node) -> str:
    """Return the path of the file with the parameters of a node, where it has any."""
    return DRIVERS if node.real_only else NODES


def parameter_files(cell: Cell, target: str) -> tuple[str, ...]:
    """Return the files that move_group is given on ``mock``, ``real`` or what a substitution makes of them."""
    sensors = () if cell.octomap is None else (SENSORS,)
    files = (*PARAMETER_FILES, *sensors)
    return tuple(moveit_controllers_file(cell, target) if file == CONTROLLERS else file for file in files)


def stage_file(percent: str) -> str:
    """Return the path of the caps of a stage, or of what a substitution makes of it."""
    return f"{COMMISSIONING}stage_{percent}.yaml"


def stage_files(cell: Cell) -> dict[str, str]:
    """Return the path of the caps of each stage, by its percentage; none where nothing reads them."""
    caps = cell.bringup.caps
    return {percent(share): stage_file(percent(share)) for share in caps.stages} if caps and plans(cell) else {}


def servo_files(cell: Cell) -> tuple[str, ...]:
    """Return the files that MoveIt Servo is given."""
    return () if cell.servo is None else (PARAMETER_FILES[0], JOINT_LIMITS, SERVO)


def moveit_controllers_file(cell: Cell, target: str) -> str:
    """Return the path of the file with the controllers that move_group calls: one, unless the targets differ."""
    called = [
        controller
        for controller in cell.controllers
        if executes_plans(cell, controller) and controller.action is not None
    ]
    differs = any(len(controller.targets) < len(TARGETS) for controller in called)
    return CONTROLLERS.replace(".yaml", f".{target}.yaml") if differs else CONTROLLERS


def executes_plans(cell: Cell, one: Controller | AdaptedDevice) -> bool:
    """Return whether MoveIt may send goals to a controller or an adapter: one with a client is that node's alone.

    move_group creates a client for each controller in its parameters as it starts. Such a client appears as a second
    commander, and an enforced policy refuses it.
    """
    runs = one.active if isinstance(one, Controller) else True
    return runs and (one.client is None or any(one.client == node.name for node in cell.planners))


def control_path(cell: Cell) -> YamlPath:
    """Return where the spec has the controllers of the cell: those of several managers stand below each of them."""
    if len(cell.managers) == 1:
        return ("control", "controllers")
    return ("managers",) if cell.managers else ("interfaces",)


def semantic_file(cell: Cell) -> str:
    """Return the path of the SRDF."""
    return f"config/moveit/{cell.name}.srdf"


def plans(cell: Cell) -> bool:
    """Tell whether the cell has what MoveIt plans for and the node that does it; otherwise nothing reads its files."""
    return bool(cell.groups and cell.planners)


def is_servo(cell: Cell, node: Node) -> bool:
    """Tell whether a node runs MoveIt Servo."""
    return cell.servo is not None and node.source is NodeSource.SPEC and node.name == cell.servo.node


def is_planner(node: Node) -> bool:
    """Tell whether a node is MoveIt's move_group, which reads these files."""
    return node.is_planner


def is_capped(cell: Cell, node: Node) -> bool:
    """Tell whether a node is given the caps of a stage."""
    return bool(stage_files(cell)) and (is_planner(node) or is_servo(cell, node))
