"""``README.md`` of the generated package: the way from power-off to a trajectory, and what stands in the folder.

Markdown for people who see the cell for the first time. The gates come first, because they are what everybody needs;
each stands once, in ``gates/``, and is linked from here. Left out: what another file of the package says better; the
page names that file.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from cellc.artifact import Artifact
from cellc.cell.cell import Cell
from cellc.cell.control import Controller
from cellc.cell.frame import FrameKind
from cellc.cell.interface import Interface, InterfaceKind
from cellc.deploy.bringup import phases
from cellc.deploy.configuration import OpenQuestion
from cellc.deploy.deployment import Deployment
from cellc.deploy.files import (
    FIRST_GOAL_PROGRAM,
    NETWORK_CHECKLIST,
    PROMOTION_CHECKLIST,
    REQUIRED_PROGRAM,
    RVIZ,
    SOURCES,
    VERSIONS_PROGRAM,
    plans,
)
from cellc.deploy.first_goal import programs
from cellc.deploy.gates import Gate
from cellc.deploy.labels import real_driver
from cellc.deploy.releases import start_mock
from cellc.formats.escape import code, markdown, markdown_comment
from cellc.formats.parameter_file import spec_path
from cellc.graph.cell_graph import CellGraph
from cellc.graph.enclaves import commissioning_enclave, people_enclave
from cellc.graph.versions import unreleased
from cellc.vocabulary import BringUpPhase

_BAR = "\\|"
_OPEN = "Before real hardware"
_ANCHOR = "before-real-hardware"
_HEAD = ("gate", "what it shows", "first command", "signed by")
_NO_PLANNER = (
    "No node of this cell plans, so that no configuration of MoveIt but the SRDF is here; a `move_group` among the "
    "nodes of the spec brings it."
)
_GOAL = "launch/goal.launch.xml"
_FILES = (
    ("urdf/", "the description for the mock and for real hardware"),
    ("config/", "parameters of controller managers and nodes, the frame tree with its calibrations"),
    (RVIZ, "what RViz shows, and never commands: `rviz2 -d` with it"),
    ("config/moveit/", "the SRDF, and what move_group is told beyond it, with `config/joint_limits.yaml`"),
    ("middleware/", "environment and profile for each host, sourced before anything is started there"),
    ("security/policy.xml", "who may publish, serve and call; everything else is denied"),
    ("launch/cell.launch.xml", "starts the cell; on real hardware it stops where a person takes over"),
    ("launch/move.launch.xml", "starts what asks for motion; on real hardware only after a person releases it"),
    ("launch/activate.launch.xml", "activates hardware that moves by it; a person releases it"),
    ("launch/claim.launch.xml", "gives command interfaces their owners on real hardware; a person releases it"),
    (_GOAL, "sends one small goal to the controller on real hardware; a person releases it"),
    ("config/bring_up.json", "each step of the bring-up: its proof, what it asks for, and the effect that must show"),
    ("scripts/bring_up", "the program that takes these steps"),
    (VERSIONS_PROGRAM, "compares the version tuple with what is installed, as the first of these steps"),
    (FIRST_GOAL_PROGRAM, "sends that goal from where the robot stands, and cancels one"),
    (REQUIRED_PROGRAM, "ends the launch with the program without which the cell is none"),
    (SOURCES, "repositories, at commits, of what the distribution does not release"),
    ("contract.json", "what the interfaces promise: type, QoS, rate, age, owner, failure behavior"),
    ("rehearsals.json", "what the mock executes, and the outcome that each run must end in"),
    ("graph/cell.svg", "where everything stands, from two sides"),
    ("graph/nodes.svg", "who talks to whom, each node once, with the list of what the arrows carry"),
    ("graph/responsibility.svg", "what each arrow promises, and who answers for it; `.mmd` says the same"),
    ("gates/promotion.md", "gates G0 to G7 as a checklist for one attempt; `gates/network.md` holds L1 to L6"),
    ("audit.md", "open questions, version tuple, every command path, what the running cell must show, owners"),
    ("config/recording_qos.yaml", "what an attempt records, and the command that does it"),
    ("manifest.json", "version tuple, hash of every file, configuration id"),
)


_RELEASED = {
    "launch/activate.launch.xml": BringUpPhase.ACTIVATE,
    "launch/claim.launch.xml": BringUpPhase.CLAIM,
    "launch/move.launch.xml": BringUpPhase.MOVE,
}


_POLICY = "generated/{}/security/policy.xml"


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the page."""
    cell = graph.cell
    blocks = [
        markdown_comment(plan.header.text),
        f"# {cell.name}",
        markdown(cell.summary),
        f"A ROS 2 package for {cell.distro}; the spec is its only source, so that a change is made there. Which "
        "configuration it is stands in `manifest.json`.",
        f"![{cell.name} from two sides, with its frames](graph/cell.svg)",
        *_gates(plan),
        "## Every shell, once",
        "From the folder that holds `cells/` and `generated/`, with ROS 2 sourced:",
        _shell_of(cell),
        *_enforced(cell),
        "To try it on the mock, in three commands:",
        _fenced((plan.header.command, f"cellc mock generated/{cell.name}", start_mock(cell))),
        *_questions(plan.questions),
        "## The cell in one sentence",
        markdown(_sentence(cell)),
        f"![Who talks to whom in {cell.name}](graph/nodes.svg)",
        f"![Every arrow of {cell.name} with its owner](graph/responsibility.svg)",
        "What the mock cannot prove, by device and vendor, stands in `audit.md`: the gates show it, or nothing does.",
        "## What is here",
        "\n".join(f"- `{name}`: {text}" for name, text in _FILES if _present(cell, plan, name)),
        "" if plans(cell) else _NO_PLANNER,
    ]
    yield Artifact("README.md", "\n\n".join(block for block in blocks if block) + "\n")


def _gates(plan: Deployment) -> Iterator[str]:
    yield "## From power-off to a trajectory"
    yield (
        "Gates are passed from top to bottom, each with its evidence and a signature; one that stops is begun again. "
        "Enabling drives (G5) and moving (G6, G7) are steps of people at the cell: no file here takes them. The "
        "sections Ending and Recovery of `audit.md` have the way to power-off, and the way back after a stop."
    )
    yield _table(PROMOTION_CHECKLIST, plan.promotion)
    yield "G3 is passed layer by layer, from the cable to the command path:"
    yield _table(NETWORK_CHECKLIST, plan.network)
    number = len(plan.questions)
    if number:
        yield f"**{number} answers are missing in the spec**, and each stops gate G0: [{_OPEN}](#{_ANCHOR})."


def _table(file: str, gates: tuple[Gate, ...]) -> str:
    rows = (_HEAD, ("---",) * len(_HEAD), *(_row(file, gate) for gate in gates))
    return "\n".join(f"| {' | '.join(cell.replace('|', _BAR) for cell in cells)} |" for cells in rows)


def _row(file: str, gate: Gate) -> tuple[str, ...]:
    anchor = f"{gate.code} {gate.title}".lower().replace(",", "").replace(" ", "-")
    # Up to a pipe: what shows is the first program.
    command = markdown(code(gate.key_command.partition(" | ")[0])) if gate.key_command else "by people"
    return f"[{gate.code}]({file}#{anchor}) {gate.title}", markdown(gate.shows), command, markdown(gate.owner)


def _shell_of(cell: Cell) -> str:
    """Return what every shell needs once: the built package, the host's environment, the folder of the attempt."""
    environments = [f"source generated/{cell.name}/middleware/{host}.sh  # on {host}" for host in cell.hosts]
    return _fenced(
        (
            *_sources(cell),
            "rosdep install --from-paths generated --ignore-src  # once",
            f"colcon build --base-paths generated --packages-select {cell.name}  # once",
            "source install/setup.bash",
            *environments,
            *_servers(cell),
            'export E=evidence/attempt-001 && mkdir -p "$E"  # a new folder for each attempt',
        )
    )


def _servers(cell: Cell) -> Iterator[str]:
    """Yield what starts the discovery servers, without which nobody finds anybody."""
    for number, server in enumerate(cell.network.servers if cell.network.discovery == "server" else ()):
        start = f"generated/{cell.name}/middleware/{server.host}.discovery_server_{number}"
        yield f"{start}  # on {server.host}, before all else, in a shell of its own"


def _sources(cell: Cell) -> Iterator[str]:
    """Yield what fetches and builds what no distribution releases: pins are of these commits."""
    if unreleased(cell):
        yield f"mkdir -p src && vcs import src < generated/{cell.name}/{SOURCES}  # once"
        yield "rosdep install --from-paths src --ignore-src  # once"
        yield "colcon build --base-paths src && source install/setup.bash  # once"


def _enforced(cell: Cell) -> Iterator[str]:
    """Yield how the access policy is enforced: sros2 0.10 to 0.15, for a middleware that is DDS."""
    if cell.versions.rmw.startswith("rmw_zenoh"):
        return
    yield (
        "Where access is enforced, keys are made in a shell as above: domain and middleware are read from it, and "
        "another of either needs new ones. A process then starts in its enclave of `security/policy.xml`, which the "
        "launch files name, or not at all. Each host has its own enclaves alone, and `private/` is kept "
        "away from the cell. What people type is told its enclave in a shell that launches nothing: that in which they "
        f"look, or {code(commissioning_enclave(cell))} for the one command by which a gate or a recovery acts:"
    )
    yield _fenced(
        (
            "export ROS_SECURITY_KEYSTORE=~/keystore",
            'ros2 security create_keystore "$ROS_SECURITY_KEYSTORE"  # once, and the next line after each build',
            f'ros2 security generate_artifacts -k "$ROS_SECURITY_KEYSTORE" -p {_POLICY.format(cell.name)}',
            "export ROS_SECURITY_ENABLE=true ROS_SECURITY_STRATEGY=Enforce",
            f"export ROS_SECURITY_ENCLAVE_OVERRIDE={people_enclave(cell)}  # only where people look, never to launch",
        )
    )


def _fenced(lines: Iterable[str]) -> str:
    return "\n".join(["```sh", *lines, "```"])


def _questions(questions: tuple[OpenQuestion, ...]) -> Iterator[str]:
    if questions:
        yield f"## {_OPEN}"
        yield "Each of these is answered in the spec, where it stands; `audit.md` says whom to ask:"
        yield "\n".join(
            f"- {markdown(f'{question.subject} ({code(spec_path(question.path))})')}" for question in questions
        )


def _present(cell: Cell, plan: Deployment, name: str) -> bool:
    if name == "config/moveit/":
        return bool(cell.groups)
    if name == "middleware/":
        return bool(cell.hosts)
    if name in (REQUIRED_PROGRAM, FIRST_GOAL_PROGRAM, _GOAL):
        return (FIRST_GOAL_PROGRAM if name == _GOAL else name) in programs(cell)
    if name == SOURCES:
        return bool(unreleased(cell))
    phase = _RELEASED.get(name)
    return phase is None or phase in phases(plan.bring_up, "real")


def _sentence(cell: Cell) -> str:
    """Return who tells what to whom, from the sensors to the drives and back to the stop."""
    clauses = [
        *_streams(cell),
        *_dynamic_frames(cell),
        *_actions(cell),
        *_managers(cell),
        *_drives(cell),
        _stop(cell),
    ]
    text = "; ".join(clauses)
    return text[0].upper() + text[1:] + "."


def _written(cell: Cell, kind: InterfaceKind) -> Iterator[Interface]:
    return (interface for interface in cell.interfaces if interface.kind is kind and not interface.derived)


def _streams(cell: Cell) -> Iterator[str]:
    for topic in _written(cell, InterfaceKind.TOPIC):
        frame = f" in {topic.frame}" if topic.frame else ""
        yield f"{_names(topic, 'sources')} publishes {code(topic.name)}{frame} to {_names(topic, 'sinks')}"


def _dynamic_frames(cell: Cell) -> Iterator[str]:
    for frame in cell.frames:
        if frame.kind is FrameKind.DYNAMIC:
            yield f"{frame.authority} says where {frame.name} is in {frame.parent}, at the stamp of its observation"


def _actions(cell: Cell) -> Iterator[str]:
    for action in _written(cell, InterfaceKind.ACTION):
        yield f"{_names(action, 'sinks')} asks {_names(action, 'sources')} through {code(action.name)}"
    for controller in cell.controllers:
        if controller.action is not None:
            client = controller.client or "a client that the spec does not name"
            yield f"{client} sends goals to {controller.label} through {code(controller.action)}{_instead(controller)}"


def _instead(controller: Controller) -> str:
    """Return where the goals go on real hardware, for a controller that is not there."""
    other = controller.stand_in
    return "" if other is None else f", on real hardware to {other.node} through {code(other.action)}"


def _managers(cell: Cell) -> Iterator[str]:
    for manager in cell.managers:
        for device in map(cell.device, manager.devices):
            through = real_driver(device)
            if device.hardware is not None and "real" in device.hardware.targets:
                yield f"controller manager {manager.name} writes to {device.name} through {through}"
            else:
                yield f"no controller manager writes to {device.name} on real hardware, where {through} moves it"


def _drives(cell: Cell) -> Iterator[str]:
    for device in cell.devices:
        if device.is_driven:
            yield f"the vendor controller of {device.name} decides what reaches the drives"


def _stop(cell: Cell) -> str:
    stop = cell.safety.stop
    return f"{stop.authority} stops the cell by a path ({stop.path}) that no software is part of"


def _names(interface: Interface, side: str) -> str:
    ends = interface.sources if side == "sources" else interface.sinks
    return " and ".join(end.node for end in ends) or "nobody"
