"""``audit.md``: version tuple, expected nodes and interfaces, command owners, and open questions.

Markdown for the people who approve the cell; ``cellc audit`` prints the same. Left
out: findings of ``cellc check``, which change with its version; the audit holds what follows from the spec alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.stops import stops_of
from cellc.compiler.deploy.configuration import OpenQuestion
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.files import stage_files
from cellc.compiler.deploy.processes import is_adapter, motion_clients
from cellc.compiler.emit.audit.ages import ages_section
from cellc.compiler.emit.audit.caps import caps_section
from cellc.compiler.emit.audit.moments import moments_section, stops_section
from cellc.compiler.emit.audit.simulator import simulator_section
from cellc.compiler.emit.audit.tables import (
    calibration_section,
    command_section,
    drivers_section,
    interfaces_section,
    nodes_section,
    owners_section,
    parts_section,
    record_section,
    scene_section,
    shapes_section,
    signals_section,
    tf_section,
)
from cellc.compiler.formats.escape import code, markdown, markdown_comment
from cellc.compiler.formats.markdown_table import table
from cellc.compiler.formats.parameter_file import spec_path
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.simulated import is_asked
from cellc.compiler.graph.versions import Answer, Judgment, compatibility
from cellc.contract.vocabulary import UNKNOWN, InterfaceKind, Moment, Motion

_QUESTIONS = {
    "graph": "Is there one command publisher or action server?",
    "time_tf": "Which stamp and calibration produced the goal?",
    "controller": "Are joints, interfaces, tolerance and hold defined?",
    "vendor": "Are firmware, driver, mode and scaling pinned?",
    "network": "Do discovery and data use controlled paths?",
    "safety": "Are stop, recovery and observer independent?",
    "data": "Can failures be replayed by layer?",
}
_SPEC_AUTHOR = "author of the spec"
# The owner of a device reads what is printed on it; only the supplier knows what is released.
_READ_ON_THE_DEVICE = ("revision", "serial", "firmware")


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the audit."""
    cell = graph.cell
    measured = cell.calibrations.values()
    sections = {
        "Open questions": _questions_section(graph, plan),
        "Version tuple": _version_section(cell),
        "Shapes": shapes_section(cell),
        **({"Scene": scene_section(cell)} if cell.scene else {}),
        **({"Parts": parts_section(cell)} if any(frame.grasp for frame in cell.frames) else {}),
        "Command owners": owners_section(graph),
        "Command paths": command_section(graph),
        **({"Caps of planned motion": caps_section(graph)} if stage_files(cell) else {}),
        **({"Digital signals": signals_section(cell)} if any(device.switched for device in cell.devices) else {}),
        "Expected nodes": nodes_section(cell),
        "Expected topics": interfaces_section(cell, InterfaceKind.TOPIC),
        "Expected services": interfaces_section(cell, InterfaceKind.SERVICE),
        "Expected actions": interfaces_section(cell, InterfaceKind.ACTION),
        **({"Ages": ages_section(cell)} if any(topic.max_age_s for topic in cell.interfaces) else {}),
        "Other driver interfaces": drivers_section(cell),
        "Expected TF publishers": tf_section(cell),
        "Attempt record": record_section(cell),
        **(
            {"Calibration files": calibration_section(cell)}
            if any(calibration.file for calibration in measured)
            else {}
        ),
        "Approvals": table(("area", "question", "owner"), approvals(cell)),
        "Responsibilities": table(("responsibility", "owner"), responsibilities(cell)),
        "What devices do": moments_section(cell),
        "Shutdown": _numbered(ending(cell)),
        "Recovery": "\n".join(recovery(cell)),
        **({"What resumes": stops_section(cell)} if any(map(stops_of, cell.devices)) else {}),
        "After a crash or lost connection": "\n".join(_after_a_loss(cell)) or "None.",
        "What the mock cannot prove": "\n".join(_not_provable(cell)),
        **({"What the simulator cannot show": simulator_section(cell)} if is_asked(cell) else {}),
    }
    blocks = [markdown_comment(plan.header.text), f"# {cell.name}: audit"]
    blocks += [f"## {title}\n\n{text}" for title, text in sections.items()]
    yield Artifact("audit.md", "\n\n".join(blocks) + "\n")


def approvals(cell: Cell) -> Iterator[tuple[str, ...]]:
    """Yield the seven approval areas with the question that each answers."""
    return ((area, _QUESTIONS[area], owner) for area, owner in cell.owners.approvals)


def responsibilities(cell: Cell) -> Iterator[tuple[str, ...]]:
    """Yield the responsibilities with their owners."""
    return iter(cell.owners.responsibilities)


def ending(cell: Cell) -> Iterator[str]:
    """Yield the steps from motion to power-off; a device is ended before the one that carries it."""
    yield "Make sure that no part is held. Keep people and objects out from under any tool or part that may fall."
    if motion_clients(cell):
        yield "Stop move.launch.xml on every computer, which stops all motion clients"
    joints = cell.joints_by_name
    for manager in cell.managers:
        claiming = " ".join(
            controller.name
            for controller in manager.controllers
            if any(
                name.rpartition("/")[0] in joints for name in controller.claims("real") if "real" in controller.targets
            )
        )
        command = f"ros2 control switch_controllers --deactivate {claiming} -c {manager.node}"
        if claiming:
            yield f"Release the claims with {code(command)}"
    for node in cell.nodes:
        if is_adapter(cell, node):
            yield f"Release the claim of the adapter with {code(f'ros2 lifecycle set {node.full_name} deactivate')}"
    for device in _outermost_first(cell):
        yield from (f"{device.name}: {step}" for step in device.procedures.safety.ending)
    yield "Stop cell.launch.xml with Ctrl-C on every computer. ros2 node list must show no node of this cell."
    for device in _outermost_first(cell):
        yield from (f"{device.name}: {step}" for step in device.procedures.safety.ended)
    yield "Stop the recording and sign the evidence"


def _outermost_first(cell: Cell) -> list[Device]:
    """Return the devices, each before the one that carries it, in whatever order the spec names them."""
    carrier = {name: device.name for device in cell.devices for name in device.mount.carries}

    def depth(name: str) -> int:
        return 0 if name not in carrier else 1 + depth(carrier[name])

    return sorted(cell.devices, key=lambda device: (-depth(device.name), device.name))


def _losses(cell: Cell) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the recovery from a loss that no device reports: of a manager or a computer."""
    seen = "Keep out of reach. Check each robot and tool: an arm may still be driven, a tool may have dropped its part."
    ended = (
        "Stop every launch of the cell with Ctrl-C on every computer. Remaining processes wait forever for services."
    )
    alone = "Check with ros2 node list that no node of this cell is left. A second launch would start it twice."
    off = tuple(f"{device.name}: {step}" for device in cell.devices for step in device.procedures.safety.power_off)
    begin = "Repeat from gate G3. Authorize activation and claims again."
    before = (seen, *let_go_by_an_end(cell), ended, alone, *off)
    if cell.managers:
        yield "If a controller manager ended", (*before, begin)
    if len(cell.hosts) > 1:
        yield "If a computer or the network between computers failed", (*before, "Repeat layers L1 to L5", begin)


def let_go_by_an_end(cell: Cell) -> Iterator[str]:
    """Yield what people do before the drivers end: arms that fall then, and what tools let go of."""
    effects = {device.name: device.control.hardware.effects for device in cell.devices if device.control.hardware}
    ended = {name: each[Moment.DEACTIVATE] for name, each in effects.items() if Moment.DEACTIVATE in each}
    falling = [name for name, effect in ended.items() if effect.motion is Motion.FALLS]
    if dropping := [name for name, effect in ended.items() if effect.drops_part]:
        yield f"Make sure that nothing that {' and '.join(dropping)} may hold can fall on a person"
    if falling:
        yield f"From out of reach, place a stand just below each of {' and '.join(falling)}. They fall together."


def _after_a_loss(cell: Cell) -> Iterator[str]:
    for number, (title, steps) in enumerate(_losses(cell)):
        yield from (*([""] if number else []), markdown(f"{title}:"), "", _numbered(steps))


def recovery(cell: Cell) -> Iterator[str]:
    """Yield who acknowledges a stop, and the steps of every device."""
    recovery = cell.safety.recovery
    yield markdown(f"Acknowledged by: {recovery.acknowledge}. Owner: {recovery.owner}.")
    yield markdown(f"After a reconnect: {recovery.on_reconnect}.")
    if let_go := tuple(let_go_by_an_end(cell)):
        yield from ("", "Before you stop any launch of the cell:", "", _numbered(let_go))
    for device in cell.devices:
        if device.procedures.safety.stop_authority is not None:
            yield from ("", markdown(f"{device.name} is stopped by: {device.procedures.safety.stop_authority}."))
        for procedure in device.procedures.safety.recovery:
            yield from ("", markdown(f"{device.name}, {procedure.state}:"), "", _numbered(procedure.steps))


def _numbered(steps: Iterable[str]) -> str:
    return "\n".join(f"{number}. {markdown(step)}" for number, step in enumerate(steps, 1))


def _not_provable(cell: Cell) -> Iterator[str]:
    """Yield what the mock cannot prove by the catalog, by device and vendor."""
    for device in cell.devices:
        of = f"{device.name} ({device.vendor} {device.model})"
        yield from (f"- {markdown(f'{of}: {text}')}" for text in device.mock.mock_cannot_prove)
    if cell.groups and not cell.scene and cell.octomap is None:
        yield "- collisions with the surroundings: `scene` is empty, so planned paths may pass through a table or fence"
    if cell.octomap is not None:
        yield f"- the occupancy map of {code(cell.octomap.source)}: the mock plans without it"
    if cell.servo is not None:
        yield f"- {code(cell.servo.node)} (MoveIt Servo): the mock does not execute it and sends it no command"
    for device, name, said in cell.signed_for_mock():
        signed = f"that {code(name)} touches no hardware: stated only by {said.by}, {said.date}"
        yield f"- {markdown(f'{device.name}: {signed}')}"


def _questions_section(graph: CellGraph, plan: Deployment) -> str:
    """Write every UNKNOWN of the spec, and every part that no compatibility matrix covers."""
    return table(("ask", "question", "answer in the spec"), [*_open(graph, plan), *_untested(graph.cell)])


def _open(graph: CellGraph, plan: Deployment) -> Iterator[tuple[str, ...]]:
    for question in plan.questions:
        asked, text = _asked(graph.cell, question)
        yield asked, text, code(spec_path(question.path))


def _asked(cell: Cell, question: OpenQuestion) -> tuple[str, str]:
    approvals = cell.owners.approvals
    section, part = question.path[0], str(question.path[-1])
    if section == "devices":
        return _asked_of_device(cell, cell.device(str(question.path[1])), part)
    if section == "versions":
        if "rollback" in question.path:
            return _person(approvals.data), f"Which {part} does the cell roll back to when a new one fails?"
        return _person(approvals.graph), f"What is the {question.subject} of the machine that runs the cell?"
    if section == "surroundings":
        return _asked_of_surroundings(cell, part)
    if section == "safety":
        return _person(approvals.safety), f"What is the {question.subject}?"
    return _SPEC_AUTHOR, f"Who is the {question.subject}?"


_AROUND = {
    "support": "What carries each arm?",
    "floor": "Where is the floor?",
    "walls": "Which walls, fences and ceiling are within reach?",
    "fittings": "Which brackets and cables are on the arms and beside them?",
}


def _asked_of_surroundings(cell: Cell, part: str) -> tuple[str, str]:
    left_open = dict(cell.surroundings)[part].open
    if left_open is None:
        return _SPEC_AUTHOR, _AROUND[part]
    return left_open.person, f"{_AROUND[part]} Known by {left_open.date}."


def _asked_of_device(cell: Cell, device: Device, part: str) -> tuple[str, str]:
    if part == "calibration" and device.body.kinematics is not None:
        tool = code(device.body.kinematics.tool)
        question = f"What is the kinematic calibration of {device.name}? Read it with {tool}."
        return _person(cell.owners.approvals.vendor), question
    if part in _READ_ON_THE_DEVICE:
        owner = _person(cell.owners.approvals.vendor)
        return owner, f"What is the {part} of {device.name}? See its nameplate or panel."
    if part == "model":
        moments = " and ".join(device.control.unknown_effects)
        return f"supplier {device.vendor}", f"What moves or falls at {moments} of {device.model}?"
    text = f"Which {part} for {device.model} do you release for ROS 2 {cell.distro}, if any?"
    return f"supplier {device.vendor}", text


def _untested(cell: Cell) -> Iterator[tuple[str, ...]]:
    devices = {device.name: device for device in cell.devices}
    for judged in compatibility(cell):
        if judged.built_from:
            continue  # `sources.repos` answers it
        # No supplier's matrix has hardware revisions or kernels; the mock and the gates cover them.
        if judged.answer is Answer.UNKNOWN and judged.pin.known and judged.pin.part not in ("revision", "kernel"):
            yield _asked_for_matrix(cell, devices.get(judged.pin.holder), judged)


def _asked_for_matrix(cell: Cell, device: Device | None, judged: Judgment) -> tuple[str, ...]:
    asked = _person(cell.owners.approvals.graph) if device is None else f"supplier {device.vendor}"
    pin = f"{judged.pin.part} {code(judged.pin.text)}"
    text = f"Is {pin} supported with ROS 2 {cell.distro}? Known so far: {judged.evidence}"
    return asked, text, code(spec_path(judged.pin.path))


def _person(owner: str) -> str:
    return _SPEC_AUTHOR if owner == UNKNOWN else owner


def _version_section(cell: Cell) -> str:
    """Write the tuple as a table."""
    return table(("of", "part", "pinned", "answer", "reason"), _rows(cell))


def _rows(cell: Cell) -> Iterator[tuple[str, ...]]:
    for judged in compatibility(cell):
        yield judged.pin.holder, judged.pin.part, judged.pin.text, judged.answer.value, judged.evidence
