"""``README.md`` of the generated package: what it is, how to try it, and what stands between it and real hardware.

Markdown for people. Left out: everything that another file of the package says better; the page names that file.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.cell.cell import Cell
from cellc.emit.readme.sentence import bringup_sentence
from cellc.formats.confirmation import CONFIRMATION
from cellc.formats.header import Header
from cellc.formats.open_questions import open_questions
from cellc.formats.parameter_file import spec_path
from cellc.graph.cell_graph import CellGraph

_FILES = (
    ("urdf/", "the description for the mock and for real hardware"),
    ("config/", "parameters of controller managers and nodes, joint limits, the frame tree with its calibrations"),
    ("middleware/", "environment and profile for each host, sourced before anything is started there"),
    ("security/policy.xml", "who may publish, serve and call; everything else is denied"),
    ("launch/cell.launch.xml", "starts the cell; on real hardware it stops where a person takes over"),
    ("contract.json", "what the interfaces promise: type, QoS, rate, age, owner, failure behaviour"),
    ("rehearsals.json", "what the mock executes, and the outcome that each run must end in"),
    ("graph/responsibility.mmd", "who tells what to whom, and who answers for it"),
    ("gates/promotion.md", "gates G0 to G7: commands, evidence, reasons to stop; `gates/network.md` holds L1 to L6"),
    ("audit.md", "open questions, version tuple, every command path, what the running cell must show, owners"),
    ("config/recording_qos.yaml", "what an attempt records, and the command that does it"),
    ("manifest.json", "version tuple, hash of every file, configuration id"),
)


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield the page."""
    blocks = [
        f"<!--\n{header.text}\n-->",
        f"# {graph.cell.name}",
        graph.cell.spec.summary,
        f"Configuration `{header.configuration_id}`, ROS 2 {graph.cell.distro}. This folder is a ROS 2 package; "
        "the spec is its only source, so that a change is made there.",
        "## The cell in one sentence",
        bringup_sentence(graph.cell),
        f"![Every arrow of {graph.cell.name} with its owner](graph/responsibility.svg)",
        *_use(graph.cell, header),
        *_real(graph),
        *_limits_of_the_mock(graph.cell),
        "## What is here",
        "\n".join(f"- `{name}`: {text}" for name, text in _FILES),
    ]
    yield Artifact("README.md", "\n\n".join(block for block in blocks if block) + "\n")


def _use(cell: Cell, header: Header) -> Iterator[str]:
    yield "## Make it again, try it, launch it"
    yield _shell(header.command, f"cellc mock generated/{cell.name}", f"ros2 launch {cell.name} cell.launch.xml")
    yield "The launch file starts the mock unless it is told otherwise, and never enables drives."


def _real(graph: CellGraph) -> Iterator[str]:
    yield "## Before real hardware"
    questions = open_questions(graph)
    if questions:
        yield "Each of these blocks the real target until somebody answers it in the spec:"
        yield "\n".join(f"- {question.subject} (`{spec_path(question.path)}`)" for question in questions)
    yield "With no question open, and after the mock has passed, a person states that the gates have their evidence:"
    yield _shell(f"ros2 launch {graph.cell.name} cell.launch.xml target:=real confirm_real:={CONFIRMATION}")
    yield (
        "This connects to the hardware, reads its state and claims command interfaces. Enabling drives and the first "
        "motion are steps of the vendor's procedure, taken by a person at the cell."
    )


def _limits_of_the_mock(cell: Cell) -> Iterator[str]:
    lines = [f"- {device.name}: {text}" for device in cell.devices for text in device.facts.mock_cannot_prove]
    if lines:
        yield "## What the mock cannot prove"
        yield "\n".join(lines)


def _shell(*commands: str) -> str:
    return "\n".join(["```sh", *commands, "```"])
