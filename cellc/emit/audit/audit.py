"""``audit.md``: the tuple, what is expected of the running cell, who commands what, and what is not known.

Markdown for the people who approve the cell (chapter 4, section 12, prompt A); ``cellc audit`` prints the same. Left
out: findings of ``cellc check``, which change with its version; the audit holds what follows from the spec alone.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.cell.interface import InterfaceKind
from cellc.emit.audit.command_paths import command_section, owners_section
from cellc.emit.audit.expected import drivers_section, interfaces_section, nodes_section, tf_section
from cellc.emit.audit.people import approvals, not_provable, recovery, responsibilities
from cellc.emit.audit.questions import questions_section
from cellc.emit.audit.versions import version_section
from cellc.formats.header import Header
from cellc.graph.cell_graph import CellGraph


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield the audit."""
    cell = graph.cell
    sections = {
        "Open questions": questions_section(graph),
        "Version tuple": version_section(cell),
        "Command owners": owners_section(graph),
        "Command paths": command_section(graph),
        "Expected nodes": nodes_section(cell),
        "Expected topics": interfaces_section(cell, InterfaceKind.TOPIC),
        "Expected services": interfaces_section(cell, InterfaceKind.SERVICE),
        "Expected actions": interfaces_section(cell, InterfaceKind.ACTION),
        "Expected of drivers": drivers_section(cell),
        "Expected TF publishers": tf_section(cell),
        "Approvals": "\n".join(approvals(cell)),
        "Responsibilities": "\n".join(responsibilities(cell)),
        "Recovery": "\n".join(recovery(cell)),
        "What the mock cannot prove": "\n".join(not_provable(cell)),
    }
    blocks = [f"<!--\n{header.text}\n-->", f"# {cell.name}: audit"]
    blocks += [f"## {title}\n\n{text}" for title, text in sections.items()]
    yield Artifact("audit.md", "\n\n".join(blocks) + "\n")
