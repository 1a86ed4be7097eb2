"""``README.md`` of the generated package: from power-off to a trajectory, and what is in the folder.

Markdown for people who see the cell for the first time. The gates are first, because every reader needs them;
each is written once, in ``gates/``, and linked from here. Left out: what another file of the package says better; the
page names that file.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller
from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.cell.interface import Interface
from cellc.compiler.deploy.bringup import phases
from cellc.compiler.deploy.configuration import OpenQuestion
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.files import (
    AMONG_MOCK,
    COMMISSIONING,
    FIRST_GOAL_PROGRAM,
    NETWORK_CHECKLIST,
    OBSERVE_PROGRAM,
    PROMOTION_CHECKLIST,
    REQUIRED_PROGRAM,
    RVIZ,
    SCENE,
    SOURCES,
    VERSIONS_PROGRAM,
    WATCH_PROGRAM,
    plans,
    stage_files,
)
from cellc.compiler.deploy.first_goal import programs
from cellc.compiler.deploy.gate_states import stop_tests
from cellc.compiler.deploy.gates import Gate
from cellc.compiler.deploy.labels import real_driver
from cellc.compiler.deploy.processes import beside_mock
from cellc.compiler.deploy.releases import start_mock
from cellc.compiler.formats.escape import code, markdown, markdown_comment
from cellc.compiler.formats.parameter_file import spec_path
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.enclaves import commissioning_enclave, people_enclave
from cellc.compiler.graph.simulated import is_asked
from cellc.compiler.graph.versions import unreleased
from cellc.contract.vocabulary import BringUpPhase, InterfaceKind

_BAR = "\\|"
_OPEN = "Before real hardware"
_ANCHOR = "before-real-hardware"
_HEAD = ("gate", "what it shows", "first command", "signed by")
_NO_PLANNER = (
    "No node of this cell plans, so the SRDF is the only MoveIt configuration here. Add `move_group` to the nodes of "
    "the spec to get the rest."
)
_GOAL = "launch/goal.launch.xml"
_FILES = (
    ("urdf/", "the description for each target"),
    (
        SCENE,
        "the cell for MuJoCo, with masses, contacts and actuators; open it with `python -m mujoco.viewer --mjcf`",
    ),
    ("config/", "parameters of controller managers and nodes, and the frame tree with its calibrations"),
    (RVIZ, "RViz configuration, display only; open it with `rviz2 -d`"),
    ("config/moveit/", "the SRDF and the other parameters of move_group, together with `config/joint_limits.yaml`"),
    (COMMISSIONING, "caps on planned motion, one file per stage; the launch argument `stage:=` selects one"),
    ("middleware/", "environment and profile of each host; source them before you start anything there"),
    ("security/policy.xml", "who may publish, serve and call; everything else is denied"),
    ("launch/cell.launch.xml", "starts the cell; on real hardware it stops before claims and motion"),
    ("launch/move.launch.xml", "starts the motion clients; on real hardware, a person authorizes it"),
    ("launch/activate.launch.xml", "activates hardware that moves on activation; a person authorizes it"),
    ("launch/claim.launch.xml", "activates the controllers that claim joints on real hardware; a person authorizes it"),
    (_GOAL, "sends small goals for one joint on real hardware; a person authorizes it"),
    (AMONG_MOCK, "starts nodes of the spec beside a cell that `cellc mock --ros` plays; they reach no robot"),
    ("config/bring_up.json", "steps of the bring-up, each with its proof, its request and its required effect"),
    ("scripts/bring_up", "the program that runs these steps"),
    (OBSERVE_PROGRAM, "compares the running graph with the package, read-only"),
    (VERSIONS_PROGRAM, "compares the version tuple with the installed packages, as the first of these steps"),
    (FIRST_GOAL_PROGRAM, "sends these goals from the current position, or cancels one halfway"),
    (WATCH_PROGRAM, "ends goals and claims when a robot stops, pauses or is silent, until a person acknowledges this"),
    (REQUIRED_PROGRAM, "ends the launch when a required program ends"),
    (SOURCES, "repositories of packages that the distribution does not release, pinned to commits"),
    ("contract.json", "contract of each interface: type, QoS, rate, age, owner, failure behavior"),
    ("rehearsals.json", "runs of the mock, each with its expected outcome"),
    ("graph/cell.svg", "the cell from two sides"),
    ("graph/nodes.svg", "node graph, with each node once and a list of the interfaces"),
    ("graph/responsibility.svg", "contract and owner of each arrow"),
    ("gates/promotion.md", "checklist of gates G0 to G7 for one attempt; `gates/network.md` has layers L1 to L6"),
    ("audit.md", "open questions, version tuple, command paths, expected nodes and interfaces, owners"),
    ("config/recording_qos.yaml", "topics that an attempt records, with their QoS and the recording command"),
    ("manifest.json", "version tuple, hash of every file, configuration ID"),
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
        f"This ROS 2 package for {cell.distro} is generated from the spec. Make changes in the spec. The configuration "
        "ID is in `manifest.json`.",
        f"![{cell.name} from two sides, with its frames](graph/cell.svg)",
        *_gates(graph, plan),
        "## Set up each shell",
        "In the folder that contains `cells/` and `generated/`, with ROS 2 sourced:",
        _shell_of(cell),
        *_enforced(cell),
        "To try the cell on the mock:",
        _fenced((plan.header.command, f"cellc mock generated/{cell.name}", start_mock(cell))),
        *_on_simulator(cell),
        *_questions(plan.questions),
        "## Data flow",
        "\n".join(f"- {markdown(sentence)}" for sentence in _flow(cell)),
        f"![Node graph of {cell.name}](graph/nodes.svg)",
        f"![Every arrow of {cell.name} with its owner](graph/responsibility.svg)",
        "`audit.md` lists what the mock cannot prove, by device and vendor. Only the gates can show it.",
        "## What is here",
        "\n".join(f"- `{name}`: {text}" for name, text in _FILES if _present(cell, plan, name)),
        "" if plans(cell) else _NO_PLANNER,
    ]
    yield Artifact("README.md", "\n\n".join(block for block in blocks if block) + "\n")


def _on_simulator(cell: Cell) -> Iterator[str]:
    if is_asked(cell):
        yield (
            "To try it in MuJoCo, behind the same interfaces and on the time of the simulation. Nothing there is real, "
            "and a run is evidence for no gate; `audit.md` lists what it cannot show:"
        )
        yield _fenced((f"{start_mock(cell)} target:=sim headless:=true",))


def _gates(graph: CellGraph, plan: Deployment) -> Iterator[str]:
    enabled = " and ".join(gate for gate, *_ in stop_tests(graph))
    yield "## From power-off to a trajectory"
    yield (
        "Pass the gates from top to bottom. Each needs its evidence and a signature. If a gate fails, repeat it from "
        f"its first line. Only people at the cell enable the drives ({enabled}) and authorize motion (G6, G7). "
        "To power off, follow Shutdown in `audit.md`. After a stop, follow Recovery there."
    )
    yield _table(PROMOTION_CHECKLIST, plan.promotion)
    yield "Pass G3 layer by layer, from the cable to the command path:"
    yield _table(NETWORK_CHECKLIST, plan.network)
    number = len(plan.questions)
    if number:
        stops = "Each stops the gate that checks it, most of them G0."
        yield f"**Open questions in the spec: {number}.** {stops} See [{_OPEN}](#{_ANCHOR})."


def _table(file: str, gates: tuple[Gate, ...]) -> str:
    rows = (_HEAD, ("---",) * len(_HEAD), *(_row(file, gate) for gate in gates))
    return "\n".join(f"| {' | '.join(cell.replace('|', _BAR) for cell in cells)} |" for cells in rows)


def _row(file: str, gate: Gate) -> tuple[str, ...]:
    anchor = f"{gate.code} {gate.title}".lower().replace(",", "").replace(" ", "-")
    # Up to a pipe: what shows is the first program.
    command = markdown(code(gate.key_command.partition(" | ")[0])) if gate.key_command else "manual"
    return f"[{gate.code}]({file}#{anchor}) {gate.title}", markdown(gate.shows), command, markdown(gate.owner)


def _shell_of(cell: Cell) -> str:
    """Return the setup of a shell: the built package, the host's environment, the folder of the attempt."""
    environments = [
        f"source generated/{cell.name}/middleware/{host}.sh  # on {host}; sets the ROS domain" for host in cell.hosts
    ]
    return _fenced(
        (
            *_sources(cell),
            "rosdep install --from-paths generated --ignore-src  # once",
            f"colcon build --base-paths generated --packages-select {cell.name}  # once",
            "source install/setup.bash",
            'export PATH="$PATH:$PWD/.venv/bin"  # where cellc is installed; behind ROS, which has its own xacro',
            *environments,
            *_servers(cell),
            "mkdir -p evidence/attempt-001  # once; for each further attempt the next number",
            "export E=$(ls -d evidence/attempt-* | tail -n 1)  # the newest attempt",
            f'cp -n generated/{cell.name}/gates/*.md "$E"  # checklists to tick',
        )
    )


def _servers(cell: Cell) -> Iterator[str]:
    """Yield the commands that start the discovery servers, which every node needs."""
    for number, server in enumerate(cell.network.servers if cell.network.discovery == "server" else ()):
        start = f"generated/{cell.name}/middleware/{server.host}.discovery_server_{number}"
        yield f"{start}  # on {server.host}, first, in its own shell"


def _sources(cell: Cell) -> Iterator[str]:
    """Yield the commands that fetch and build unreleased packages at their pinned commits."""
    if unreleased(cell):
        yield f"mkdir -p src && vcs import src < generated/{cell.name}/{SOURCES}  # once"
        yield "rosdep install --from-paths src --ignore-src  # once"
        yield "colcon build --base-paths src && source install/setup.bash  # once"


def _enforced(cell: Cell) -> Iterator[str]:
    """Yield how the access policy is enforced: sros2 0.10 to 0.15, for a middleware that is DDS."""
    if cell.versions.rmw.startswith("rmw_zenoh"):
        return
    yield (
        "To enforce access control, create the keys in a shell set up as above. They are valid for its ROS domain and "
        "middleware. Create new keys when either changes. A process then starts only in its enclave of "
        "`security/policy.xml`, which the launch files set. Copy to each host only its own enclaves. Keep `private/` "
        "off the computers of the cell. For manual commands, set the enclave in a shell that launches nothing. Use the "
        "enclave below for commands that only read, and "
        f"{code(commissioning_enclave(cell))} for other commands of a gate or a recovery:"
    )
    yield _fenced(
        (
            "export ROS_SECURITY_KEYSTORE=~/keystore",
            'ros2 security create_keystore "$ROS_SECURITY_KEYSTORE"  # once, and the next line after each build',
            f'ros2 security generate_artifacts -k "$ROS_SECURITY_KEYSTORE" -p {_POLICY.format(cell.name)}',
            "export ROS_SECURITY_ENABLE=true ROS_SECURITY_STRATEGY=Enforce",
            f"export ROS_SECURITY_ENCLAVE_OVERRIDE={people_enclave(cell)}  # to read only, never to launch",
        )
    )


def _fenced(lines: Iterable[str]) -> str:
    return "\n".join(["```sh", *lines, "```"])


def _questions(questions: tuple[OpenQuestion, ...]) -> Iterator[str]:
    if questions:
        yield f"## {_OPEN}"
        yield "Answer these questions in the spec, at the path in parentheses. `audit.md` says whom to ask:"
        yield "\n".join(
            f"- {markdown(f'{question.subject} ({code(spec_path(question.path))})')}" for question in questions
        )


def _present(cell: Cell, plan: Deployment, name: str) -> bool:
    if name == "config/moveit/":
        return bool(cell.groups)
    if name == COMMISSIONING:
        return bool(stage_files(cell))
    if name == "middleware/":
        return bool(cell.hosts)
    if name in (REQUIRED_PROGRAM, FIRST_GOAL_PROGRAM, WATCH_PROGRAM, _GOAL):
        return (FIRST_GOAL_PROGRAM if name == _GOAL else name) in programs(cell)
    if name == AMONG_MOCK:
        return bool(beside_mock(cell))
    if name == SOURCES:
        return bool(unreleased(cell))
    phase = _RELEASED.get(name)
    return phase is None or phase in phases(plan.bring_up, "real")


def _flow(cell: Cell) -> Iterator[str]:
    """Yield the data flow in sentences, from the sensors to the drives and the stop."""
    yield from _streams(cell)
    yield from _dynamic_frames(cell)
    yield from _actions(cell)
    yield from _managers(cell)
    yield from _drives(cell)
    yield _stop(cell)


def _written(cell: Cell, kind: InterfaceKind) -> Iterator[Interface]:
    return (interface for interface in cell.interfaces if interface.kind is kind and not interface.derived)


def _streams(cell: Cell) -> Iterator[str]:
    for topic in _written(cell, InterfaceKind.TOPIC):
        frame = f" in {topic.frame}" if topic.frame else ""
        publish = "publish" if len(topic.sources) > 1 else "publishes"
        yield f"{_names(topic, 'sources')} {publish} {code(topic.name)}{frame} to {_names(topic, 'sinks')}"


def _dynamic_frames(cell: Cell) -> Iterator[str]:
    for frame in cell.frames:
        if frame.kind is FrameKind.DYNAMIC:
            yield f"{frame.authority} publishes frame {frame.name} in {frame.parent}, stamped when it is observed"


def _actions(cell: Cell) -> Iterator[str]:
    for action in _written(cell, InterfaceKind.ACTION):
        send = "send" if len(action.sinks) > 1 else "sends"
        yield f"{_names(action, 'sinks')} {send} goals to {_names(action, 'sources')} through {code(action.name)}"
    for controller in cell.controllers:
        if controller.action is not None:
            client = controller.client or "a client that the spec does not name"
            yield f"{client} sends goals to {controller.label} through {code(controller.action)}{_instead(controller)}"


def _instead(controller: Controller) -> str:
    """Return the destination of goals on real hardware, for a controller that runs only on the mock."""
    other = controller.stand_in
    return "" if other is None else f"; on real hardware, to {other.node} through {code(other.action)}"


def _managers(cell: Cell) -> Iterator[str]:
    for manager in cell.managers:
        for device in map(cell.device, manager.devices):
            through = real_driver(device)
            if device.control.hardware is not None and "real" in device.control.hardware.targets:
                yield f"controller manager {manager.name} writes to {device.name} through {through}"
            else:
                yield f"{through} moves {device.name} on real hardware, where no controller manager writes to it"


def _drives(cell: Cell) -> Iterator[str]:
    for device in cell.devices:
        if device.control.is_driven:
            yield f"the vendor controller of {device.name} decides what reaches the drives"


def _stop(cell: Cell) -> str:
    stop = cell.safety.stop
    return f"{stop.authority} stops the cell without software (path: {stop.path})"


def _names(interface: Interface, side: str) -> str:
    ends = interface.sources if side == "sources" else interface.sinks
    names = [end.node for end in ends]
    return " and ".join(part for part in (", ".join(names[:-1]), *names[-1:]) if part) or "no node"
