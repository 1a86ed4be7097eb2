"""The stages of bring-up as actions of a launch file, and the script ``launch/bring_up.bash`` that takes their steps.

Discover, configure, observe, claim. The processes of the first stage are started at once and prove nothing by that.
Every step after it waits for what it needs, one condition a line of the script; the last one claims, and none enables a
drive or asks for motion. The script exists because launch XML has no event handlers (ros2/launch issue 658), and
`lifecycle_node` with its transitions only from Lyrical on (launch_ros pull request 482): the command-line tools are the
same from Humble on. A transition that fails leaves 0 as its exit status there, so that the next step looks at the
state.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from xml.etree.ElementTree import Element

from cellc.artifact import Artifact
from cellc.cell.cell import Cell
from cellc.cell.interface import TARGETS, Node, NodeSource
from cellc.deploy.bringup import MOVE, Step, ready_to_move
from cellc.deploy.deployment import Deployment
from cellc.deploy.processes import bring_up_enclave, started_by_a_person
from cellc.emit.launch.processes import cell_node, control, driver_node, only_on, robot_state_publisher, share, spawners
from cellc.formats.parameter_file import spec_path
from cellc.formats.xml_text import comment, element
from cellc.link.frames import ROBOT_STATE_PUBLISHER

FILE = "launch/bring_up.bash"
_CONDITIONS = Path(__file__).with_name("readiness.bash")
_ABOUT = {
    "configure": "every controller is loaded and configured, none is active; managed nodes likewise",
    "observe": "states are published and looked at; nothing is claimed",
    "claim": "command interfaces get their owners, after states, transforms and lifecycle states have shown",
}


def stages(cell: Cell, plan: Deployment, host: str | None) -> Iterator[Element]:
    """Yield the actions of one host, or of all of them."""
    yield comment("discover: processes come up in any order; what follows waits for proof, not for them")
    yield from _discover(cell, host)
    for stage, about in _ABOUT.items():
        actions = [*(_spawners(cell, host) if stage == "configure" else ()), *_steps(cell, plan, host, stage)]
        if actions:
            yield comment(f"{stage}: {about}")
            yield from actions
    yield comment("enable and move are steps of people: gates/promotion.md, G5 to G7")


def _discover(cell: Cell, host: str | None) -> Iterator[Element]:
    for node in cell.nodes:
        if node.source is NodeSource.STANDARD and node.name == ROBOT_STATE_PUBLISHER and _here(host, node.host):
            yield robot_state_publisher(cell, node)
    for manager in cell.managers:
        if _here(host, manager.host):
            yield comment(spec_path(manager.path))
            yield from control(cell, manager)
    for node in cell.nodes:
        if _here(host, node.host):
            yield from _node(cell, node)


def _node(cell: Cell, node: Node) -> Iterator[Element]:
    if node.source is NodeSource.SPEC and not started_by_a_person(cell, node):
        yield comment(spec_path(node.path))
        yield cell_node(cell, node)
    elif node.source is NodeSource.DEVICE:
        yield comment(f"driver of {spec_path(node.path)}")
        yield driver_node(cell, node)


def _spawners(cell: Cell, host: str | None) -> Iterator[Element]:
    for manager in cell.managers:
        if _here(host, manager.host):
            yield from spawners(cell, manager)


def _steps(cell: Cell, plan: Deployment, host: str | None, stage: str) -> Iterator[Element]:
    return (_step(cell, one) for one in plan.steps if one.stage == stage and _here(host, one.host))


def _step(cell: Cell, step: Step) -> Element:
    command = f"bash {share(cell, FILE)} {step.name}"
    return element("executable", {"name": step.name, "cmd": command, "output": "both", **only_on(step.only)})


def _here(host: str | None, of: str) -> bool:
    return host is None or host == of


def bring_up(cell: Cell, plan: Deployment) -> Artifact:
    """Return the script of a cell."""
    parts = [
        plan.header.commented("#").rstrip("\n"),
        "set -eu",
        f'step="${{1:?which step: {", ".join(_names(plan))}}}"',
        f'enclave="{bring_up_enclave(cell)}" # of what is asked here, where security is on',
        "",
        _CONDITIONS.read_text(encoding="utf-8").rstrip("\n"),
        "",
        'case "$step" in',
        *(line for step in plan.steps for line in _case(step)),
        *_move(cell, plan),
        "  *)",
        '    echo "there is no step $step" >&2',
        "    exit 2",
        "    ;;",
        "esac",
    ]
    return Artifact(FILE, "\n".join(parts) + "\n")


def _names(plan: Deployment) -> Iterator[str]:
    yield from (step.name for step in plan.steps)
    if plan.motion_clients:
        yield from (f"{MOVE}_{target}" for target in TARGETS)


def _case(step: Step) -> Iterator[str]:
    yield f"  {step.name}) # {step.stage}"
    yield from (f"    needs {condition}" for condition in step.waits_for)
    yield f"    act {step.command}"
    yield "    ;;"


def _move(cell: Cell, plan: Deployment) -> Iterator[str]:
    if plan.motion_clients:
        for target in TARGETS:
            yield f"  {MOVE}_{target}) # by a person; what stands behind the step is started then"
            yield from (f"    needs {condition}" for condition in ready_to_move(cell, target))
            yield "    shift"
            yield '    exec "$@"'
            yield "    ;;"
