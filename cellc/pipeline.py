"""The stages of cellc in order: read, parse, link, build the graph, check, emit, verify, write.

Everything between reading and writing is pure: a stage takes a value and returns a value. source, spec and link stop
on an error, so that one mistake does not cascade; rules all run.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from cellc.artifact import Artifact
from cellc.description.packages import root_of
from cellc.diagnostics import Diagnostic, Outcome, Severity
from cellc.diagnostics.diagnostic import CodePage, Findings
from cellc.graph.cell_graph import CellGraph, build_graph
from cellc.link.link import bare_cell, link
from cellc.rules.ignores import apply_ignores, ignore_comments, misused_ignores
from cellc.rules.run import ALL_RULES, run_rules
from cellc.source import read
from cellc.source.text import with_shown_texts
from cellc.spec.parse import parse

DESCRIPTIONS = (".urdf", ".xacro")
"""Files of a robot alone, which no cell holds."""
_ON_MODELS = tuple(one for one in ALL_RULES if one.family == "MOD" or one.code == "missing-velocity-limit")


@dataclass(frozen=True, slots=True)
class Checked:
    """What checking one spec gave: all findings, and the graph where the stages before it found no error.

    Attributes:
        excused: what rules found, and comments in the spec take out of the findings.
    """

    findings: Findings
    graph: CellGraph | None
    excused: tuple[Diagnostic, ...] = ()

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The findings alone."""
        return self.findings.diagnostics

    @property
    def ok(self) -> bool:
        """Whether artifacts may be written: no finding is an error."""
        return self.graph is not None and self.findings.ok


def check(path: str | Path, edited: Mapping[str, str] | None = None) -> Checked:
    """Read, parse and link a spec, run every rule on its graph, and take out what comments in the spec excuse.

    A URDF or xacro file is judged as it is, by the rules on descriptions alone.

    Args:
        edited: texts that are read in place of files of the spec, by the name that spans carry.
    """
    file = Path(path).as_posix()
    if file.endswith(DESCRIPTIONS):
        return _check_description(Path(path))
    source = read(path, edited)
    if source.value is None or not source.ok:
        texts = {} if source.value is None else source.value.texts
        return _checked(file, texts, source.diagnostics)
    texts = source.value.texts
    found = list(source.diagnostics)
    spec = parse(source.value)
    found += spec.diagnostics
    if spec.value is None or not spec.ok:
        return _checked(file, texts, _unexcused(found, texts))
    cell = link(spec.value, source.value)
    found += cell.diagnostics
    if cell.value is None or not cell.ok:
        return _checked(file, texts, _unexcused(found, texts))
    graph = build_graph(cell.value)
    found += run_rules(graph)
    kept = _excused(found, texts)
    known = frozenset(kept)
    return replace(_checked(file, texts, kept, graph), excused=tuple(one for one in found if one not in known))


def _check_description(path: Path) -> Checked:
    # A spec that names devices of the catalog alone is checked without the reader of xacro.
    from cellc.description.read_description import read_description

    root = root_of(path)
    read = read_description(path, {}, root)
    found = list(read.diagnostics)
    if read.value is not None:
        found += run_rules(build_graph(bare_cell(read.value, path.as_posix(), root.as_posix())), _ON_MODELS)
    return _checked(path.as_posix(), {}, _sorted(found))


def compile_cell(checked: Checked) -> Outcome[tuple[Artifact, ...]]:
    """Emit the artifacts of a checked cell with the manifest over them, and have foreign parsers read them back."""
    emitted = emit_cell(checked)
    if emitted.value is None or checked.graph is None:
        return emitted
    # Foreign parsers are imported here: a check does not pay for them, nor does who only compares.
    from cellc.verify.verify import verify

    return Outcome(emitted.value, verify(emitted.value, checked.graph))


def emit_cell(checked: Checked) -> Outcome[tuple[Artifact, ...]]:
    """Emit the artifacts of a checked cell with the manifest over them."""
    if checked.graph is None or not checked.ok:
        return Outcome(None)
    # Emitters are imported here: a check does not pay for them.
    from cellc.deploy.deployment import plan_deployment
    from cellc.emit.emit_all import emit_all
    from cellc.output.manifest import with_manifest

    beyond = _beyond_limits(checked.graph)
    if beyond:
        return Outcome(None, beyond)
    plan = plan_deployment(checked.graph)
    artifacts = with_manifest(
        emit_all(checked.graph, plan),
        cell=checked.graph.cell.name,
        configuration_id=plan.configuration_id,
        configuration_inputs=plan.configuration_inputs,
        version_tuple=plan.versions,
    )
    return Outcome(artifacts)


def _beyond_limits(graph: CellGraph) -> tuple[Diagnostic, ...]:
    """Return that the pairs of links take longer to find than they may: a check finds fewer of them."""
    from cellc.feasibility import disabled_links
    from cellc.rules.geometry import beyond_limits

    code, groups = "geometry-too-large", graph.cell.groups
    found = beyond_limits(graph, disabled_links(graph)) if groups else ()
    return tuple(Diagnostic(code, Severity.ERROR, one.message, one.span, one.path, one.help) for one in found)


def _checked(
    file: str, texts: Mapping[str, str], found: tuple[Diagnostic, ...], graph: CellGraph | None = None
) -> Checked:
    return Checked(Findings(file, with_shown_texts(texts, found, Path(file).parent), found), graph)


def _excused(found: list[Diagnostic], texts: Mapping[str, str]) -> tuple[Diagnostic, ...]:
    """Take out what comments excuse, once every rule has run."""
    ignores = ignore_comments(texts)
    return _sorted(list(apply_ignores(found, ignores, _pages()))) if ignores else _sorted(found)


def _unexcused(found: list[Diagnostic], texts: Mapping[str, str]) -> tuple[Diagnostic, ...]:
    """Keep what stopped a stage, and tell comments that try to excuse it."""
    ignores = ignore_comments(texts)
    return _sorted([*found, *misused_ignores(ignores, _pages())]) if ignores else _sorted(found)


def _pages() -> dict[str, CodePage]:
    # Few cells excuse anything, and only for them the pages of all stages are read.
    from cellc.report.pages import all_pages

    return all_pages()


def _sorted(diagnostics: list[Diagnostic]) -> tuple[Diagnostic, ...]:
    return tuple(sorted(diagnostics, key=Diagnostic.sort_key))
