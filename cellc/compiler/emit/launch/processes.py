"""The processes of the launch file: nodes, controller managers and their spawners, with the substitutions they use.

A manager takes all hardware of the description that it is given. The one manager of a cell takes the cell's. Of
several, each has a description with its own hardware alone, on a topic of its own. All report joints on one topic.
On the simulator the one manager runs in the program of MuJoCo, and ``set_parameter`` puts every node on its time.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from xml.etree.ElementTree import Element

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import ControllerManager
from cellc.compiler.cell.interface import Node
from cellc.compiler.cell.robot import HostProgram
from cellc.compiler.deploy.files import (
    CONTROLLERS_ON_SIM,
    REQUIRED_PROGRAM,
    controllers_file,
    description_file,
    is_capped,
    is_planner,
    is_servo,
    manager_description_file,
    node_file,
    parameter_files,
    plans,
    semantic_file,
    servo_files,
    stage_file,
)
from cellc.compiler.deploy.labels import TF_RATE_HZ
from cellc.compiler.deploy.spawning import spawnings
from cellc.compiler.formats.escape import launch_text, launch_words
from cellc.compiler.formats.numbers import decimal
from cellc.compiler.formats.parameter_file import node_parameters
from cellc.compiler.formats.urdf.hardware import HEADLESS
from cellc.compiler.formats.xml_text import element
from cellc.compiler.graph.enclaves import enclave_of, manager_enclave, spawner_enclave
from cellc.compiler.graph.simulated import PACKAGE, is_asked, simulated
from cellc.compiler.link.nodes import DESCRIPTION_PUBLISHER, description_home
from cellc.contract.vocabulary import Feature, features

TARGET = "$(var target)"

HOST = "$(var host)"

STAGE = "stage"
"""The launch argument that chooses the caps of planned motion."""

ON_REAL = f"$(eval \"'{TARGET}' == 'real'\")"
"""True on the real target; `eval` because Humble has no `equals`, harmless because the argument has choices."""
_ON_MOCK = ON_REAL.replace("real", "mock")
ON_SIM = ON_REAL.replace("real", "sim")

_TOPIC = "robot_description"


def only_on(target: str | None) -> dict[str, str]:
    """Return the condition of what is started on one target alone; none for what is started on every target."""
    return {} if target is None else {"if": {"mock": _ON_MOCK, "sim": ON_SIM, "real": ON_REAL}[target]}


def not_on_sim(cell: Cell) -> dict[str, str]:
    """Return the condition of what the simulator has something of its own in the place of."""
    return {"unless": ON_SIM} if is_asked(cell) else {}


def simulated_time(cell: Cell) -> Iterator[Element]:
    """Yield what puts every node that follows on the time of the simulation; SetUseSimTime is for launch itself."""
    if is_asked(cell):
        yield element("set_parameter", {"name": "use_sim_time", "value": "true", **only_on("sim")})


def on_host(host: str) -> str:
    """Return what is true where a host's part is to be started."""
    return f"$(eval \"'{HOST}' == 'all' or '{HOST}' == '{host}'\")"


def share(cell: Cell, path: str) -> str:
    """Return the installed place of a file of the package."""
    return f"$(find-pkg-share {cell.name})/{path}"


def expanded(file: str, *arguments: str) -> str:
    """Return the text of an installed description, share folders of other packages put in by xacro."""
    return f"$(command '{' '.join(('xacro', file, *arguments))}')"


def enclave(path: str) -> dict[str, str]:
    """Return the attribute that puts a process into its enclave.

    Without security it has no effect; with it, a process outside of its enclave is denied everything.
    """
    return {"ros_args": launch_words("--enclave", path)}


def ends_launch(cell: Cell) -> dict[str, str]:
    """Return the attribute of a process that the cell cannot run without: the launch ends with it."""
    if Feature.EXIT_ENDS_LAUNCH in features(cell.distro):
        return {"on_exit": "shutdown"}
    program = REQUIRED_PROGRAM.rpartition("/")[2]
    return {"launch-prefix": f"$(find-pkg-prefix {cell.name})/lib/{cell.name}/{program} --"}


def _description_parameter(file: str, *arguments: str) -> Element:
    """Return the parameter that holds a description of the package, its type stated so that no parser reads it."""
    return element("param", {"name": "robot_description", "value": expanded(file, *arguments), "type": "str"})


def _shown(cell: Cell) -> str:
    """Return the argument of the description that the simulator runs; others do not know it, and xacro lets it be."""
    return f"{HEADLESS}:=$(var {HEADLESS})" if is_asked(cell) else ""


def remap(source: str, target: str) -> Element:
    """Return ``<remap>``."""
    return element("remap", {"from": launch_text(source), "to": launch_text(target)})


def remaps(node: Node) -> Iterator[Element]:
    """Yield the remaps of a node, from the names that its program has in its namespace."""
    return (remap(source, target) for source, target in node.remaps.items())


def identity(cell: Cell, node: Node) -> dict[str, str]:
    """Return the attributes that say what a node is: its program, names, output and enclave."""
    place = {"namespace": launch_text(node.namespace)} if node.namespace else {}
    again = {"respawn": "true"} if node.respawn else {}
    return {
        "pkg": launch_text(node.package),
        "exec": launch_text(node.executable),
        "name": launch_text(node.name),
        **place,
        "output": "both",
        **again,
        **enclave(enclave_of(cell, node)),
    }


def robot_state_publisher(cell: Cell, node: Node) -> Element:
    """Return the one authority for all static frames."""
    # Said though it is the default: what reads /tf is promised this rate.
    rate = element("param", {"name": "publish_frequency", "value": decimal(TF_RATE_HZ)})
    return element("node", identity(cell, node), [_description(cell, _shown(cell)), rate])


def cell_node(cell: Cell, node: Node) -> Element:
    """Return a node that the spec names."""
    return element("node", identity(cell, node), parameters(cell, node))


def driver_node(cell: Cell, node: Node) -> Element:
    """Return a node of a device's driver; one for real hardware alone stays away from the mock."""
    condition = {"if": ON_REAL} if node.real_only else {}
    return element("node", identity(cell, node) | condition, parameters(cell, node))


def host_program(program: HostProgram) -> Element:
    """Return a program of a device on its host that is no node: it knows no arguments of ROS."""
    path = f"$(find-pkg-prefix {program.package})/lib/{program.package}/{program.program}"
    command = f"{path} {launch_words(*program.arguments)}"
    return element("executable", {"name": program.name, "cmd": command, "output": "both", "if": ON_REAL})


def moving_node(cell: Cell, node: Node, hosts: tuple[str, ...], prefix: str) -> Element:
    """Return a node that asks for motion, behind a prefix that waits until everything is ready for it."""
    place = {"if": on_host(node.host)} if hosts else {}
    return element("node", identity(cell, node) | {"launch-prefix": prefix} | place, parameters(cell, node))


def parameters(cell: Cell, node: Node) -> Iterator[Element]:
    """Yield the parameters and remaps of a node; what is given last counts."""
    if plans(cell) and (is_planner(node) or is_servo(cell, node)):
        yield _description(cell)
        semantic = f"$(command 'cat {share(cell, semantic_file(cell))}')"
        yield element("param", {"name": "robot_description_semantic", "value": semantic, "type": "str"})
        files = parameter_files(cell, TARGET) if is_planner(node) else servo_files(cell)
        yield from (element("param", {"from": share(cell, file)}) for file in files)
    if node_parameters(cell, node):
        yield element("param", {"from": share(cell, node_file(node))})
    if node.clock == "sim":
        yield element("param", {"name": "use_sim_time", "value": "true"})
    if is_capped(cell, node):  # the last file counts
        yield element("param", {"from": share(cell, stage_file(f"$(var {STAGE})"))})
    yield from remaps(node)


def _description(cell: Cell, argument: str = "") -> Element:
    return _description_parameter(share(cell, description_file(cell, TARGET)), *filter(None, (argument,)))


def control(cell: Cell, manager: ControllerManager) -> Iterator[Element]:
    """Yield the processes of one update loop: one for its description where it has its own, and the loop."""
    publishers = (node for node in cell.nodes if node.name == DESCRIPTION_PUBLISHER and node.path == manager.path)
    yield from (_description_publisher(cell, manager, node) for node in publishers)
    yield _manager(cell, manager, not_on_sim(cell))
    if is_asked(cell):
        yield _simulator(cell, manager)


def _simulator(cell: Cell, manager: ControllerManager) -> Element:
    """Return the same loop in the program of the simulator, which has its time and its cameras."""
    node = _manager(cell, manager, only_on("sim"))
    node.set("pkg", PACKAGE)
    node[0].set("from", share(cell, CONTROLLERS_ON_SIM))
    return node


def _description_publisher(cell: Cell, manager: ControllerManager, node: Node) -> Element:
    description = _description_parameter(share(cell, manager_description_file(cell, manager, TARGET)))
    return element("node", identity(cell, node), [description, *remaps(node)])


def _manager(cell: Cell, manager: ControllerManager, condition: Mapping[str, str]) -> Element:
    # Without a name: it would apply to the nodes of the hardware as well.
    place = _place(manager)
    parameters = [element("param", {"from": share(cell, controllers_file(cell, manager, TARGET))})]
    if Feature.DESCRIPTION_TOPIC not in features(cell.distro):
        file = share(cell, manager_description_file(cell, manager, TARGET))
        parameters.append(_description_parameter(file, *filter(None, (_shown(cell),))))
    topic = f"{description_home(manager) if len(cell.managers) > 1 else ''}/{_TOPIC}"
    return element(
        "node",
        {
            "pkg": "controller_manager",
            "exec": "ros2_control_node",
            **place,
            "output": "both",
            **ends_launch(cell),  # without its update loop a cell only looks alive
            **enclave(manager_enclave(cell, manager)),
            **condition,
        },
        [
            *parameters,
            remap(f"~/{_TOPIC}", topic),
            *([] if topic == f"/{_TOPIC}" and not place else [remap(_TOPIC, topic)]),
            *([] if Feature.CONTROLLER_ARGUMENTS in features(cell.distro) else remaps(_node(cell, manager))),
        ],
    )


def _node(cell: Cell, manager: ControllerManager) -> Node:
    return next(node for node in cell.nodes if node.full_name == manager.node)


def _controller_arguments(cell: Cell, manager: ControllerManager) -> Iterator[str]:
    """Yield what the spawner hands to each controller: the names that these have in the cell."""
    if Feature.CONTROLLER_ARGUMENTS in features(cell.distro):
        for source, target in _node(cell, manager).remaps.items():
            yield from ("--controller-ros-args", f"--remap {source}:={target}")


def _place(manager: ControllerManager) -> dict[str, str]:
    return {"namespace": launch_text(manager.namespace)} if manager.namespace else {}


def spawners(cell: Cell, manager: ControllerManager) -> Iterator[Element]:
    """Yield what loads and configures a manager's controllers; it waits for the manager, and activates nothing.

    One process for all: several of them race for a controller that the manager has found in its file (Humble 2.54).
    """
    for spawning in spawnings(manager):
        condition = not_on_sim(cell) if spawning.only is None else only_on(spawning.only)
        yield _spawner(cell, manager, spawning.controllers, condition)
    if is_asked(cell):
        (there,) = simulated(cell).managers
        for spawning in spawnings(there):
            if spawning.only == "mock":
                yield _spawner(cell, manager, spawning.controllers, only_on("sim"))


def _spawner(
    cell: Cell, manager: ControllerManager, controllers: tuple[str, ...], condition: Mapping[str, str]
) -> Element:
    arguments = ("-c", manager.node, "--inactive", *_controller_arguments(cell, manager))
    return element(
        "node",
        {
            "pkg": "controller_manager",
            "exec": "spawner",
            **_place(manager),
            "args": launch_words(*controllers, *arguments),
            "output": "both",
            **enclave(spawner_enclave(cell, manager)),
            **condition,
        },
    )
