"""The stages of bring-up as actions of a launch file, and the program and plan with which their steps are taken.

The processes are started together and prove nothing by that. ``lib/<package>/bring_up`` takes the steps of
``config/bring_up.json`` one after the other, each with its proof, its deadline and a last word. One process lives
through them: each call of a command-line tool is a new participant of the network that must be discovered first. None
of its steps enables a drive or asks for motion.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from xml.etree.ElementTree import Element

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import Node, NodeSource
from cellc.compiler.deploy.bringup import phases
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.files import BRING_UP, OBSERVATION
from cellc.compiler.deploy.first_goal import programs
from cellc.compiler.deploy.observation import observation
from cellc.compiler.deploy.processes import started_by_a_person
from cellc.compiler.emit.launch.processes import (
    TARGET,
    cell_node,
    control,
    driver_node,
    enclave,
    ends_launch,
    host_program,
    only_on,
    robot_state_publisher,
    share,
    spawners,
)
from cellc.compiler.formats.json_text import render
from cellc.compiler.formats.parameter_file import spec_path
from cellc.compiler.formats.xml_text import comment, element
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.enclaves import bring_up_enclave
from cellc.compiler.link.frames import ROBOT_STATE_PUBLISHER
from cellc.contract.bring_up import CLAIM_WATCH
from cellc.contract.entities import LaunchTarget
from cellc.contract.store.regular_file import own_text
from cellc.contract.vocabulary import BringUpPhase

PROGRAM = "bring_up"


def stages(cell: Cell, plan: Deployment, host: str | None) -> Iterator[Element]:
    """Yield the actions of one host, or of all of them."""
    yield comment("discover: processes start in any order; later steps wait for proof")
    yield from _discover(cell, host)
    if spawned := [*_spawners(cell, host)]:
        yield comment("configure: load and configure every controller, activate none")
        yield from spawned
    if mock := [phase for phase in phases(plan.bring_up, "mock", host) if phase is not BringUpPhase.MOVE]:
        yield comment(f"configure and observe; on the mock{' and in sim' if plan.bring_up.sim else ''} also claim")
        yield bring_up(cell, "mock", mock, host)
        if plan.bring_up.sim:
            yield bring_up(cell, "sim", mock, host)
    if BringUpPhase.START in phases(plan.bring_up, "real", host):
        if not mock:
            yield comment("compare the installed versions with the version tuple")
        yield bring_up(cell, "real", [BringUpPhase.START], host)
    if plan.bring_up.watches and host in (None, *(manager.host for manager in cell.managers)):
        yield comment("end goals and claims when a robot stops, pauses or is silent; only a person restores them")
        yield _claim_watch(cell, host)
    yield comment("a person authorizes the rest: gates/promotion.md, G5 to G7")


def bring_up(
    cell: Cell,
    target: LaunchTarget,
    taken: Sequence[str],
    host: str | None = None,
    *,
    release: str = "",
    when: Mapping[str, str] | None = None,
) -> Element:
    """Return the process that takes phases on a target, started on that target alone, or by ``when``."""
    named = [*([] if host is None else ["--host", host]), *(["--release", release] if release else [])]
    words = [*_words(cell, target), *named, *taken]
    return element(
        "node",
        {
            "pkg": cell.name,
            "exec": PROGRAM,
            "args": " ".join(words),
            "output": "both",
            **enclave(bring_up_enclave(cell)),
            **(only_on(target) if when is None else when),
        },
    )


def _claim_watch(cell: Cell, host: str | None) -> Element:
    """Return the process that takes claims away. The launch ends with it, for nothing else does that."""
    words = ["--plan", share(cell, BRING_UP), *([] if host is None else ["--host", host])]
    return element(
        "node",
        {
            "pkg": cell.name,
            "exec": CLAIM_WATCH.removeprefix("/"),
            "args": " ".join(words),
            "output": "both",
            **ends_launch(cell),
            **enclave(bring_up_enclave(cell)),
            **only_on("real"),
        },
    )


def before_motion(cell: Cell, target: str = TARGET) -> str:
    """Return the prefix of a node that asks for motion: it is started when all shows, and ended when a claim goes."""
    program = f"$(find-pkg-prefix {cell.name})/lib/{cell.name}/{PROGRAM}"
    return " ".join([program, *_words(cell, target), BringUpPhase.MOVE, "--"])


def _words(cell: Cell, target: str) -> tuple[str, ...]:
    return ("--plan", share(cell, BRING_UP), "--target", target)


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
    for device in cell.devices:
        if device.site.programs and _here(host, device.site.host):
            yield comment(f"no nodes: programs of {spec_path(device.path)}")
            yield from map(host_program, device.site.programs)


def _node(cell: Cell, node: Node) -> Iterator[Element]:
    if node.is_bridge:
        yield comment(f"{spec_path(node.path)} is started with the plant")
    elif node.source is NodeSource.SPEC and not started_by_a_person(cell, node):
        yield comment(spec_path(node.path))
        yield cell_node(cell, node)
    elif node.source is NodeSource.DEVICE:
        yield comment(f"driver of {spec_path(node.path)}")
        yield driver_node(cell, node)


def _spawners(cell: Cell, host: str | None) -> Iterator[Element]:
    for manager in cell.managers:
        if _here(host, manager.host):
            yield from spawners(cell, manager)


def _here(host: str | None, of: str) -> bool:
    return host is None or host == of


def programs_and_plan(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the programs of the package, the steps that the bring-up takes, and what an observer compares."""
    yield Artifact(BRING_UP, render(plan.bring_up))
    yield Artifact(OBSERVATION, render(observation(graph, plan.bring_up)))
    for path in programs(graph.cell):
        source = own_text(_source_of(path))
        first, _, rest = source.replace(_BESIDE, "from ").partition("\n")
        yield Artifact(path, f"{first}\n{plan.header.commented('#')}{rest}", executable=True)


_BESIDE = f"from {__name__.rpartition('.')[0]}."
"""In the package a module is beside the program that imports it."""


def _source_of(path: str) -> Path:
    name = path.rpartition("/")[2]
    return Path(__file__).with_name(name if name.endswith(".py") else f"{name}_program.py")
