"""What the launch files start, and what a person must say first, against the contract and the plan that is executed."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from cellc.contract.bring_up import Target
from cellc.contract.vocabulary import BringUpPhase
from cellc.mock.agreement.said import Edited, Said, differing, xml
from cellc.robot.description.xml_tree import XmlElement

_FOLDER = "launch/"
_RELEASED = {"launch/activate.launch.xml": BringUpPhase.ACTIVATE, "launch/claim.launch.xml": BringUpPhase.CLAIM}
_MOVE = "launch/move.launch.xml"
_GATES = ("launch/real_gate.launch.xml", "launch/move_gate.launch.xml", "launch/goal.launch.xml", *_RELEASED)
"""Files that a person opens: they demand the word, without a default."""
_SUBSTITUTED = re.compile(r"\$\([^()]*\)[^\s]*")
_WATCH = "watch"
_TARGETS: tuple[Target, ...] = ("mock", "real")


@dataclass(frozen=True, slots=True)
class _Node:
    """A process of a launch file, and the targets on which it is started."""

    file: str
    element: XmlElement
    targets: tuple[Target, ...]

    def says(self, name: str) -> str:
        return self.element.attributes.get(name, "")

    @property
    def words(self) -> list[str]:
        return _SUBSTITUTED.sub("FILE", self.says("args")).split()

    @property
    def full_name(self) -> str:
        name = self.says("name") or ("controller_manager" if self.says("exec") == "ros2_control_node" else "")
        return f"{self.says('namespace').rstrip('/')}/{name}"


def launched(edited: Edited, _: str) -> Iterator[str]:
    """Compare all launch files together: processes, controllers, phases, files that are given, and gates."""
    roots = {file: xml(file, text) for file, text in edited.texts.items() if file.startswith(_FOLDER)}
    nodes = [node for file, root in roots.items() for node in _nodes(file, root)]
    yield from _controllers(edited, nodes)
    yield from _phases(edited, nodes)
    yield from _processes(edited, nodes)
    for node in nodes:
        yield from _given(edited, node)
    for file, root in roots.items():
        yield from _gate(file, root)


def _nodes(file: str, parent: XmlElement) -> Iterator[_Node]:
    for element in parent.children:
        if element.tag == "node":
            yield _Node(file, element, _targets(element))
        else:
            yield from _nodes(file, element)


def _targets(element: XmlElement) -> tuple[Target, ...]:
    """Return the targets on which something is started: the condition names `real`, or the computer alone."""
    if "'real'" in element.attributes.get("if", ""):
        return ("real",)
    if "'real'" in element.attributes.get("unless", ""):
        return ("mock",)
    return _TARGETS


def _controllers(edited: Edited, nodes: list[_Node]) -> Iterator[str]:
    """Compare what the spawners load; what makes a controller active is the plan."""
    spawners = [node for node in nodes if node.says("exec") == "spawner"]
    for node in spawners:
        if "--inactive" not in node.words:
            yield f"the spawner of `{' '.join(_spawned(node))}` must have `--inactive`: the plan activates"
    for target in _TARGETS:
        loaded = sorted(name for node in spawners if target in node.targets for name in _spawned(node))
        executed = sorted(
            controller.full_name
            for manager in edited.contract.managers.values()
            for controller in manager.controllers.values()
            if target in controller.targets
        )
        yield from differing({"loads": loaded}, {"loads": executed}, f"{target} ")


def _spawned(node: _Node) -> list[str]:
    words = node.words
    at = words.index("-c") if "-c" in words else len(words)
    namespace = words[at + 1].rpartition("/")[0] if at + 1 < len(words) else ""
    return [f"{namespace}/{word}" for word in words[:at] if not word.startswith("-")]


def _phases(edited: Edited, nodes: list[_Node]) -> Iterator[str]:
    """Compare which phases are taken without a person, and which file a person takes the others with."""
    taken: dict[str, Said] = {}
    for file, target, phases in _taken(edited, nodes):
        name = f"{file if target == 'real' and file in _RELEASED else 'the cell'} on {target}"
        before = taken.get(name, ())
        taken[name] = sorted({*(before if isinstance(before, list) else ()), *phases})
    watched = (_WATCH,) if edited.watches else ()
    of = {target: {step.phase for step in edited.steps(target)} for target in _TARGETS}
    executed: dict[str, Said] = {
        "the cell on mock": sorted(of["mock"] - {BringUpPhase.MOVE}),
        "the cell on real": sorted({*(of["real"] & {BringUpPhase.START}), *watched}),
        **{f"{file} on real": [phase] for file, phase in _RELEASED.items() if phase in of["real"]},
    }
    plan = edited.contract.files.bring_up
    yield from differing(taken, {name: value for name, value in executed.items() if value}, "phases of ", plan)


def _taken(edited: Edited, nodes: list[_Node]) -> Iterator[tuple[str, str, list[str]]]:
    for node in nodes:
        words = node.words
        if node.says("pkg") == edited.contract.cell and node.says("exec") == "bring_up" and "--target" in words:
            options = {"--plan", "--target", "--host"}
            phases = [word for at, word in enumerate(words) if at and words[at - 1] not in options]
            target = words[words.index("--target") + 1]
            yield node.file, target, [word for word in phases if not word.startswith("--")]
            if target not in node.targets and node.file not in _RELEASED:
                yield node.file, f"{target} where {node.targets[0]} is started", phases


def _processes(edited: Edited, nodes: list[_Node]) -> Iterator[str]:
    """Compare the nodes that the contract has with those that are started; drivers of devices stand in no contract."""
    contract = edited.contract
    controllers = {
        controller.full_name for manager in contract.managers.values() for controller in manager.controllers.values()
    }
    for target in _TARGETS:
        started = [node.full_name for node in nodes if target in node.targets]
        for name in sorted({text for text in started if started.count(text) > 1 and not text.endswith("/")}):
            yield f"`{name}` is started twice on `{target}`"
        ends = [
            end
            for interface in contract.interfaces.values()
            for end in (*interface.sources, *interface.sinks)
            if target in end.targets and end.node not in contract.devices and end.full_name not in controllers
        ]
        for name in dict.fromkeys(end.full_name for end in ends):
            if name not in started:
                yield f"`{name}` of `contract.json` must be started on `{target}`"


def _given(edited: Edited, node: _Node) -> Iterator[str]:
    """Compare the files that a process is given: those of this folder, and of its target."""
    share = f"$(find-pkg-share {edited.contract.cell})/"
    files = edited.contract.files
    executed = {"mock": files.urdf_mock, "real": files.urdf_real}
    for parameter in node.element.all("param"):
        text = f"{parameter.attributes.get('from', '')} {parameter.attributes.get('value', '')}"
        name = parameter.attributes.get("name", "")
        for target in node.targets:
            named = re.findall(re.escape(share) + r"([^\s')]+)", text.replace("$(var target)", target))
            for file in named:
                if file not in edited.listed:
                    yield f"`{node.full_name}` is given `{file}`, which was not generated"
            if name == "robot_description" and node.says("exec") != "ros2_control_node" and len(files.parameters) == 1:
                yield from differing({name: named}, {name: [executed[target]]}, f"{node.full_name} ")
        if name == "use_sim_time":
            clock = edited.contract.clocks.get(edited.contract.clock_of.get(node.says("name"), ""))
            simulated = "true" if clock is not None and clock.simulated else "false"
            said = parameter.attributes.get("value", "")
            yield from differing({name: said}, {name: simulated}, f"{node.full_name} ")


def _gate(file: str, root: XmlElement) -> Iterator[str]:
    """Compare the gates: what a person must say has no default that opens them, and nobody leaves them out."""
    demanded = [element for element in root.all("arg") if element.attributes.get("name", "").startswith("confirm_")]
    for element in demanded:
        default = element.attributes.get("default")
        if default != (None if file in _GATES else "no"):
            wanted = "no default" if file in _GATES else "the default `no`"
            yield f"`{element.attributes['name']}` of `{file}` must have {wanted}"
    if file in _GATES:
        if not demanded:
            yield f"`{file}` must demand the word of a person"
        return
    gate = "move_gate" if file == _MOVE else "real_gate"
    included = [
        element for element in root.all("include") if element.attributes.get("file", "").endswith(f"/{gate}.launch.xml")
    ]
    if not any(_targets(element) == ("real",) for element in included):
        yield f"`{file}` must include `{gate}.launch.xml` on the real target"
