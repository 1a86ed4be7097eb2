"""``launch/*.launch.xml``: starts the cell on the mock, or on real hardware up to where a human takes over.

Launch XML for ``ros2 launch``, Humble to Lyrical: only actions and substitutions that all of them know. Where the spec
asks for the target ``sim``, MuJoCo is started in the place of every device: it is brought up as the mock is, all of it
on one computer, and no driver and no program of a device starts.
``cell.launch.xml`` discovers, configures and observes, and on the mock claims; it enables no drive and starts no motion
client, on any target. With several hosts it includes the file of the host in its argument. On the real target a person
releases ``activate.launch.xml`` (self-moving hardware) and ``claim.launch.xml``. ``move.launch.xml`` starts motion
clients. Each has a gate on the real target: an argument without a default and with one choice. Where the mock passes
too, the argument is declared again under the condition of the real target: launch checks a value at each declaration
(launch/actions/declare_launch_argument.py of Humble to Lyrical). Left out: enabling, which is a step of the vendor's
procedure.
"""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.deploy.bringup import phases, releases
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.files import is_capped, stage_files
from cellc.compiler.deploy.first_goal import NODE, FirstGoal, first_goals
from cellc.compiler.deploy.processes import started_by_a_person
from cellc.compiler.deploy.releases import ACTIVATE, CLAIM, GOAL, MOVE, START, Release
from cellc.compiler.emit.launch.processes import (
    ON_REAL,
    STAGE,
    enclave,
    moving_node,
    on_host,
    share,
    simulated_time,
)
from cellc.compiler.emit.launch.stages import before_motion, bring_up, programs_and_plan, stages
from cellc.compiler.formats.escape import launch_text, launch_words
from cellc.compiler.formats.header import Header
from cellc.compiler.formats.numbers import decimal
from cellc.compiler.formats.parameter_file import spec_path
from cellc.compiler.formats.urdf.hardware import HEADLESS
from cellc.compiler.formats.xml_text import comment, element, render
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.enclaves import first_goal_enclave
from cellc.compiler.graph.simulated import SIM, is_asked
from cellc.contract.vocabulary import BringUpPhase

_VERSION = {"version": "0.1.1"}
_CELL = "launch/cell.launch.xml"
_MOVE = "launch/move.launch.xml"

_EVERYWHERE = "all"
"""The choice of ``host`` that starts the whole cell on one computer, which only the mock allows."""

_NOT_YET = "no"


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the launch files, and what their steps wait for."""
    cell = graph.cell
    yield _file(plan.header, _CELL, _by_host(cell, plan.hosts) if plan.hosts else _whole(cell, plan))
    for host in plan.hosts:
        yield _file(plan.header, _host_file(host), [*_arguments(cell, host), *_gate(START), *stages(cell, plan, host)])
    yield from programs_and_plan(graph, plan)
    released = phases(plan.bring_up, "real")
    for release, phase in ((ACTIVATE, BringUpPhase.ACTIVATE), (CLAIM, BringUpPhase.CLAIM)):
        if phase in released:
            path, devices = f"launch/{release.file}.launch.xml", releases(plan.bring_up, phase)
            yield _file(plan.header, path, _released(cell, release, phase, devices))
    if goals := first_goals(cell):
        yield _file(plan.header, f"launch/{GOAL.file}.launch.xml", _sending(cell, goals))
    if plan.motion_clients:
        yield _file(plan.header, _MOVE, _moving(cell, plan))


def _file(header: Header, path: str, actions: Iterator[Element] | list[Element]) -> Artifact:
    return Artifact(path, render(element("launch", _VERSION, actions), header.text))


def _released(cell: Cell, release: Release, phase: BringUpPhase, devices: tuple[str, ...]) -> Iterator[Element]:
    """Yield what a person releases: all of a phase, or of several devices the one that the word names."""
    yield argument(release.argument, None, release.about, *(release.word_for(name) for name in devices or ("",)))
    yield comment(
        "proves preconditions, sends the request once, checks the effect and ends; run it on one computer only"
    )
    if not devices:
        yield bring_up(cell, "real", [phase], when={})
    for name in devices:
        yield bring_up(cell, "real", [phase], release=name, when={"if": _says(release, name)})


def _says(release: Release, device: str, more: str = "") -> str:
    """Return what is true where the word of a release names a device, and ``more`` holds."""
    said = f"'$(var {release.argument})' == '{release.word_for(device)}'"
    return f'$(eval "{said}{more}")'


def _host_file(host: str) -> str:
    return f"launch/{host}.launch.xml"


def _arguments(cell: Cell, host: str | None = None) -> Iterator[Element]:
    yield _target_argument(cell)
    yield from _headless_argument(cell)
    yield _release_argument(cell, START)
    yield from _stage_argument(cell)
    yield from _address_arguments(cell, host)
    yield from simulated_time(cell)


def _gate(release: Release, *more: Element) -> Iterator[Element]:
    yield comment("gate before real hardware: nothing below starts there until a person confirms it")
    for argument in (_gate_argument(release), *more):
        argument.set("if", ON_REAL)
        yield argument


def _whole(cell: Cell, plan: Deployment) -> Iterator[Element]:
    yield from _arguments(cell)
    yield from _gate(START)
    yield from stages(cell, plan, None)


def _by_host(cell: Cell, hosts: tuple[str, ...]) -> Iterator[Element]:
    yield from _arguments(cell)
    yield _host_argument(hosts)
    yield from _gate(START, _stated_host_argument(hosts))
    yield comment("the part of each computer; its steps wait for the others")
    staged = (STAGE,) if stage_files(cell) else ()
    simulated = (HEADLESS,) if is_asked(cell) else ()
    passed = ("target", *simulated, START.argument, *staged)
    for host in hosts:
        given = {name: f"$(var {name})" for name in (*passed, *addresses(cell, host))}
        yield _include(cell, _host_file(host), given, {"if": on_host(host)})


def _include(cell: Cell, path: str, arguments: dict[str, str], condition: dict[str, str]) -> Element:
    # An include is refused for an argument without a default that it is not given itself, whatever its parent has.
    given = [element("arg", {"name": name, "value": value}) for name, value in arguments.items()]
    return element("include", {"file": share(cell, path), **condition}, given)


def _moving(cell: Cell, plan: Deployment) -> Iterator[Element]:
    yield _target_argument(cell)
    yield _release_argument(cell, MOVE)
    if any(is_capped(cell, node) for node in plan.motion_clients):
        yield from _stage_argument(cell)
    if plan.hosts:
        yield _host_argument(plan.hosts)
    yield from _gate(MOVE)
    yield from simulated_time(cell)
    yield comment(
        "motion clients: each waits for claims, actions and states; on the mock, each also waits for the mock"
    )
    for node in plan.motion_clients:
        if started_by_a_person(cell, node):
            yield comment(spec_path(node.path))
            yield moving_node(cell, node, plan.hosts, before_motion(cell))


def _sending(cell: Cell, goals: tuple[FirstGoal, ...]) -> Iterator[Element]:
    """Yield the first goals of the real target, behind the proof of everything that may ask for motion."""
    yield argument(GOAL.argument, None, GOAL.about, *dict.fromkeys(GOAL.word_for(goal.release) for goal in goals))
    yield argument("joint", None, "Joint to move.", *dict.fromkeys(name for goal in goals for name in goal.moves))
    about = "end: move to both sides and back. cancel: move to one side, cancel halfway and move back."
    yield argument("then", "end", about, "end", "cancel")
    yield argument("evidence", ".", "Folder for the result, the samples and the plot of command, state and error.")
    yield comment("small motions of one joint from its current position; no motion client may run")
    for goal in goals:
        yield element(
            "node",
            {
                "pkg": cell.name,
                "exec": NODE,
                "name": NODE,
                "output": "both",
                "args": f"--then $(var then) --joint $(var joint) --evidence $(var evidence) "
                f"--package $(find-pkg-share {cell.name}) {_goal_words(goal)}",
                "launch-prefix": before_motion(cell, "real"),
                "if": _says(GOAL, goal.release, f" and '$(var joint)' in {[*goal.moves]}"),
                **enclave(first_goal_enclave(cell)),
            },
        )


def _goal_words(goal: FirstGoal) -> str:
    return launch_words(
        *("--action", goal.action, "--states", goal.topic),
        *(f"--by={decimal(goal.by)}", f"--seconds={decimal(goal.duration_s)}", f"--timeout={decimal(goal.timeout_s)}"),
        *(f"--absent={node}" for node in goal.absent),
        *(":".join((joint.name, *map(_limit, (joint.lower, joint.upper)))) for joint in goal.joints),
    )


def _limit(value: float | None) -> str:
    return "" if value is None else decimal(value)


def _target_argument(cell: Cell) -> Element:
    """Return the choice between the mock, the simulator and real hardware."""
    if not is_asked(cell):
        return argument("target", "mock", "Hardware that the interfaces reach: mock or real.", "mock", "real")
    text = "Hardware that the interfaces reach: mock, sim or real. In sim MuJoCo moves everything and nothing is real."
    return argument("target", "mock", text, "mock", SIM, "real")


def _headless_argument(cell: Cell) -> Iterator[Element]:
    """Yield the choice of whether the simulator opens a window."""
    if is_asked(cell):
        yield argument(HEADLESS, "false", "Whether the simulator runs without a window.", "false", "true")


def _release_argument(cell: Cell, release: Release) -> Element:
    """Return the argument with which a person releases something; alone it releases nothing."""
    where = "on the mock or in sim" if is_asked(cell) else "on the mock"
    return argument(release.argument, _NOT_YET, f"{release.about} Not needed {where}.", _NOT_YET, release.word)


def _gate_argument(release: Release) -> Element:
    """Return the same argument as a gate demands it: without a default, and with its only accepted word."""
    return argument(release.argument, None, release.about, release.word)


def _stage_argument(cell: Cell) -> Iterator[Element]:
    """Yield the choice of the stage of commissioning: on real hardware the first unless a person states another."""
    if choices := tuple(stage_files(cell)):
        first, last = choices[0], choices[-1]
        text = f"Stage of commissioning in percent: {first} on real hardware if not stated, {last} on the mock."
        on_real = argument(STAGE, first, text, *choices)
        on_real.set("if", ON_REAL)
        yield from (on_real, argument(STAGE, last, text, *choices))  # what is set has no default any more


def _host_argument(hosts: tuple[str, ...]) -> Element:
    """Return the choice of the computer on which this is launched."""
    text = "The computer of this launch. Only the mock runs the whole cell on one computer."
    return argument("host", _EVERYWHERE, text, _EVERYWHERE, *hosts)


def _stated_host_argument(hosts: tuple[str, ...]) -> Element:
    """Return the same argument as the gate before real hardware demands it."""
    return argument("host", None, "The computer of this launch: each reaches its own hardware.", *hosts)


def _address_arguments(cell: Cell, host: str | None) -> Iterator[Element]:
    """Yield an argument for each device with an address; the launch refuses any other than that of the URDF."""
    for name, address in addresses(cell, host).items():
        device = name.removesuffix("_address")
        text = f"Address of device {device}, fixed by the URDF. To change it, change the spec and build."
        yield argument(name, address, text, address)


def addresses(cell: Cell, host: str | None) -> dict[str, str]:
    """Return the argument of each device with an address that a host reaches, or any."""
    connections = ((device.name, device.site.connection) for device in cell.devices)
    return {
        f"{name}_address": connection.address
        for name, connection in connections
        if connection is not None and connection.address is not None and host in (None, connection.host)
    }


def argument(name: str, default: str | None, description: str, *choices: str) -> Element:
    """Return ``<arg>``; one without a default must be given."""
    stated = {} if default is None else {"default": launch_text(default)}
    attributes = {"name": launch_text(name), **stated, "description": launch_text(description)}
    return element("arg", attributes, [element("choice", {"value": launch_text(choice)}) for choice in choices])
