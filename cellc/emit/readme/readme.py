"""``README.md`` of the generated package: the way from power-off to a trajectory, and what stands in the folder.

Markdown for people who see the cell for the first time. The gates come first, because they are what everybody needs;
``gates/`` holds the same as checklists to tick for one attempt. Left out: what another file of the package says better;
the page names that file.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.cell.cell import Cell
from cellc.deploy.configuration import open_questions
from cellc.deploy.files import plans
from cellc.deploy.processes import movers
from cellc.deploy.releases import start_mock
from cellc.emit.readme.sentence import bringup_sentence
from cellc.emit.readme.walk import fenced, overview, shell_of, walk
from cellc.formats.header import Header
from cellc.formats.parameter_file import spec_path
from cellc.graph.cell_graph import CellGraph

_OPEN = "Before real hardware"
_ANCHOR = "before-real-hardware"
_NO_PLANNER = (
    "No node of this cell plans, so that no MoveIt configuration is here; a `move_group` among the nodes of the spec "
    "brings it."
)
_FILES = (
    ("urdf/", "the description for the mock and for real hardware"),
    ("config/", "parameters of controller managers and nodes, the frame tree with its calibrations"),
    ("config/moveit/", "what move_group is told beyond the description, with `config/joint_limits.yaml`"),
    ("middleware/", "environment and profile for each host, sourced before anything is started there"),
    ("security/policy.xml", "who may publish, serve and call; everything else is denied"),
    ("launch/cell.launch.xml", "starts the cell; on real hardware it stops where a person takes over"),
    ("launch/move.launch.xml", "starts what asks for motion; on real hardware only after a person releases it"),
    ("launch/bring_up.bash", "what each step of the bring-up waits for before it acts"),
    ("contract.json", "what the interfaces promise: type, QoS, rate, age, owner, failure behaviour"),
    ("rehearsals.json", "what the mock executes, and the outcome that each run must end in"),
    ("graph/responsibility.svg", "who tells what to whom, and who answers for it; `.mmd` says the same"),
    ("gates/promotion.md", "gates G0 to G7 as a checklist for one attempt; `gates/network.md` holds L1 to L6"),
    ("audit.md", "open questions, version tuple, every command path, what the running cell must show, owners"),
    ("config/recording_qos.yaml", "what an attempt records, and the command that does it"),
    ("manifest.json", "version tuple, hash of every file, configuration id"),
)


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield the page."""
    cell = graph.cell
    blocks = [
        f"<!--\n{header.text}\n-->",
        f"# {cell.name}",
        cell.summary,
        f"Configuration `{header.configuration_id}`, ROS 2 {cell.distro}. This folder is a ROS 2 package; the spec is "
        "its only source, so that a change is made there.",
        *_way(graph, header),
        "## Every shell, once",
        "From the folder that holds `cells/` and `generated/`, with ROS 2 sourced:",
        shell_of(cell),
        "To try it on the mock, in three commands:",
        fenced((header.command, f"cellc mock generated/{cell.name}", start_mock(cell))),
        "## The walk",
        "Commands read; what starts something says so, and nothing here enables a drive. After a stop, the section "
        "Recovery of `audit.md` has the way back.",
        *walk(graph, header),
        *_questions(graph),
        "## The cell in one sentence",
        bringup_sentence(cell),
        f"![Every arrow of {cell.name} with its owner](graph/responsibility.svg)",
        *_limits_of_the_mock(cell),
        "## What is here",
        "\n".join(f"- `{name}`: {text}" for name, text in _FILES if _present(cell, name)),
        "" if plans(cell) else _NO_PLANNER,
    ]
    yield Artifact("README.md", "\n\n".join(block for block in blocks if block) + "\n")


def _way(graph: CellGraph, header: Header) -> Iterator[str]:
    yield "## From power-off to a trajectory"
    yield (
        "Gates are passed from top to bottom, each with its evidence and a signature; one that stops is begun again. "
        "Enabling drives (G5) and moving (G6, G7) are steps of people at the cell: no file here takes them."
    )
    yield overview(graph, header)
    number = len(open_questions(graph))
    if number:
        yield f"**{number} answers are missing in the spec**, and each blocks the real target: [{_OPEN}](#{_ANCHOR})."


def _questions(graph: CellGraph) -> Iterator[str]:
    questions = open_questions(graph)
    if questions:
        yield f"## {_OPEN}"
        yield "Each of these is answered in the spec, where it stands; `audit.md` says whom to ask:"
        yield "\n".join(f"- {question.subject} (`{spec_path(question.path)}`)" for question in questions)


def _limits_of_the_mock(cell: Cell) -> Iterator[str]:
    yield "## What the mock cannot prove"
    yield "By device and vendor; these are shown at the gates, or not at all:"
    for device in cell.devices:
        if device.mock_cannot_prove:
            yield f"**{device.name}** ({device.vendor} {device.model})"
            yield "\n".join(f"- {text}" for text in device.mock_cannot_prove)


def _present(cell: Cell, name: str) -> bool:
    if name == "config/moveit/":
        return plans(cell)
    if name == "middleware/":
        return bool(cell.hosts)
    return name != "launch/move.launch.xml" or bool(movers(cell))
