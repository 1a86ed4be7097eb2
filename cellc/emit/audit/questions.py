"""What blocks the real target, as questions to the people and suppliers who can answer."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.cell import Cell
from cellc.cell.device import Device
from cellc.deploy.configuration import OpenQuestion, open_questions
from cellc.emit.audit.table import table
from cellc.formats.parameter_file import spec_path
from cellc.graph.cell_graph import CellGraph
from cellc.graph.compatibility import Answer, Judgement, compatibility
from cellc.graph.responsibilities import UNKNOWN

_SPEC_AUTHOR = "author of the spec"
# What stands on the thing itself can be read by whoever answers for it; what is released only the supplier knows.
_READ_ON_THE_DEVICE = ("revision", "serial", "firmware")


def questions_section(graph: CellGraph) -> str:
    """Write every UNKNOWN of the spec, and every part that no matrix covers."""
    return table(("asked of", "question", "answered in the spec at"), [*_open(graph), *_untested(graph.cell)])


def _open(graph: CellGraph) -> Iterator[tuple[str, ...]]:
    for question in open_questions(graph):
        asked, text = _asked(graph.cell, question)
        yield asked, text, f"`{spec_path(question.path)}`"


def _asked(cell: Cell, question: OpenQuestion) -> tuple[str, str]:
    approvals = cell.spec.owners.approvals
    section, part = question.path[0], str(question.path[-1])
    if section == "devices":
        return _asked_of_device(cell, cell.device(str(question.path[1])), part)
    if section == "versions":
        if "rollback" in question.path:
            return _person(approvals.data), f"Which {part} does the cell go back to when a new one fails?"
        return _person(approvals.graph), f"What is the {question.subject} of the machine that runs the cell?"
    if section == "safety":
        return _person(approvals.safety), f"What is the {question.subject}?"
    return _SPEC_AUTHOR, f"Who is the {question.subject}?"


def _asked_of_device(cell: Cell, device: Device, part: str) -> tuple[str, str]:
    if part in _READ_ON_THE_DEVICE:
        owner = _person(cell.spec.owners.approvals.vendor)
        return owner, f"Which {part} does {device.name} have, by its nameplate or panel?"
    text = f"Which {part} of {device.facts.model} do you release for ROS 2 {cell.distro}, or is there none?"
    return f"supplier {device.facts.vendor}", text


def _untested(cell: Cell) -> Iterator[tuple[str, ...]]:
    devices = {device.name: device for device in cell.devices}
    for judged in compatibility(cell):
        # Hardware revisions and kernels stand in no matrix of any supplier; the mock and the gates cover them.
        if judged.answer is Answer.UNKNOWN and judged.pin.known and judged.pin.part not in ("revision", "kernel"):
            yield _asked_for_matrix(cell, devices.get(judged.pin.holder), judged)


def _asked_for_matrix(cell: Cell, device: Device | None, judged: Judgement) -> tuple[str, ...]:
    asked = _person(cell.spec.owners.approvals.graph) if device is None else f"supplier {device.facts.vendor}"
    text = (
        f"Is {judged.pin.part} `{judged.pin.text}` supported with ROS 2 {cell.distro}? Known so far: {judged.evidence}"
    )
    return asked, text, f"`{spec_path(judged.pin.path)}`"


def _person(owner: str) -> str:
    return _SPEC_AUTHOR if owner == UNKNOWN else owner
