"""The stages of cellc in order: read, parse, link, build the graph, check, emit, verify, write.

Everything between reading and writing is pure: a stage takes a value and returns a value. source, spec and link stop
on an error, so that one mistake does not cascade; rules all run. What else is wrong is found on a document in which
what stopped them is repaired.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

from cellc.compiler.artifact import Artifact
from cellc.compiler.catalog.compiled import DEVICE_FILE
from cellc.compiler.catalog.load import load_device_file
from cellc.compiler.catalog.read_model import is_device
from cellc.compiler.cell.cell import Cell
from cellc.compiler.graph.cell_graph import CellGraph, build_graph
from cellc.compiler.link.link import bare_cell, link
from cellc.compiler.plant.link import CheckedPart, is_plant
from cellc.compiler.plant.plant import Plant
from cellc.compiler.rules.ignores import apply_ignores, ignore_comments, misused_ignores
from cellc.compiler.rules.run import ALL_RULES, run_rules
from cellc.compiler.rules.shared_domain import Presence, presence_of
from cellc.compiler.source import read
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.source.findings import finding
from cellc.compiler.source.repaired import Repaired, repair
from cellc.compiler.source.text import with_shown_texts
from cellc.compiler.spec.parse import parse
from cellc.compiler.spec.plant import PART_KEY
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, Span
from cellc.contract.diagnostics.diagnostic import Findings, counted, findings_table
from cellc.contract.diagnostics.unsafe_text import escaped
from cellc.contract.frozen import dataclass
from cellc.contract.limits import limits
from cellc.contract.printing import stage
from cellc.robot.description.packages import root_of

DESCRIPTIONS = (".urdf", ".xacro")
"""Files of a robot alone, which no cell holds."""
_ROUNDS = 4
"""How often mistakes that stop a stage are repaired: those of shape, of names, and what is left out and needed."""
_MOST_REPAIRED = 25
"""A spec with more of them is another kind of file, or one of many names that a machine wrote."""
_ON_MODELS = tuple(rule for rule in ALL_RULES if rule.family == "MOD" or rule.code == "missing-velocity-limit")


@dataclass(frozen=True, slots=True, repr=False)
class Checked:
    """What checking one spec gave: all findings, and the graph where the stages before it found no error.

    It iterates over its findings, sorted by place.

    Attributes:
        excused: what rules found, and comments in the spec take out of the findings.
        document: what the graph was made of; None without one.
        plant: what the spec of a plant says, which has no graph.
    """

    findings: Findings
    graph: CellGraph | None
    excused: tuple[Diagnostic, ...] = ()
    document: SourceDocument | None = None
    plant: Plant | None = None

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The findings alone."""
        return self.findings.diagnostics

    @property
    def ok(self) -> bool:
        """Whether artifacts may be written: no finding is an error."""
        return (self.graph is not None or self.plant is not None) and self.findings.ok

    @property
    def presence(self) -> Presence | None:
        """What was checked as other specs of a call see it; None where errors hide it."""
        if self.plant is not None:
            return self.plant.presence
        return None if self.graph is None else presence_of(self.graph)

    @property
    def distro(self) -> str:
        """The distribution of ROS that it is for; empty where errors hide it."""
        cell = self.plant.first.cell if self.plant is not None else None if self.graph is None else self.graph.cell
        return "" if cell is None else cell.distro.value

    def __iter__(self) -> Iterator[Diagnostic]:
        return iter(self.diagnostics)

    def __repr__(self) -> str:
        return f"<Checked {escaped(self.findings.file)}: {counted(self.diagnostics)}>"

    def _repr_html_(self) -> str:
        return findings_table(f"{self.findings.file}: {counted(self.diagnostics)}", self.diagnostics)


def judge(path: str | Path) -> Checked:
    """Check a cell or a plant; or, by itself, the device of a ``device.yaml``, or the robot of a URDF or xacro file.

    What is no cell has no graph: its description is judged by the rules on descriptions alone, after the shape, the
    names and the figures of the file of a device.
    """
    file = Path(path)
    if file.suffix in DESCRIPTIONS:
        return _check_description(file)
    source = read(path)
    is_read = source.value is not None and source.ok
    if is_read and _is_device(file, source.value):
        return _check_device(file)
    return check_buildable(path)


def check_buildable(path: str | Path, edited: Mapping[str, str] | None = None) -> Checked:
    """Check what packages are built from: a cell, or a plant with its cells; the arguments are those of `check`."""
    stage("reading")
    source = read(path, edited)
    if not is_plant(source.value) or not source.ok:
        return _check_source(Path(path).as_posix(), source)
    # Few specs are plants, and only they compare cells.
    from cellc.compiler.plant.together import check_plant

    stage("checking the cells of the plant")
    assert source.value is not None  # it is a plant
    file, found = Path(path).as_posix(), check_plant(source.value, partial(_check_part, edited))
    diagnostics = _sorted([*source.diagnostics, *found.diagnostics])
    return replace(_checked(file, {**found.texts, **source.value.texts}, diagnostics), plant=found.plant)


def _check_part(edited: Mapping[str, str] | None, file: str) -> CheckedPart:
    checked = check(file, edited)
    return CheckedPart(checked.findings, checked.graph, checked.document)


def check(path: str | Path, edited: Mapping[str, str] | None = None) -> Checked:
    """Read, parse and link a spec, run every rule on its graph, and take out what comments in the spec excuse.

    Args:
        edited: texts that are read in place of files of the spec, by the name that spans carry.
    """
    stage("reading")
    return _check_source(Path(path).as_posix(), read(path, edited))


def _check_source(file: str, source: Outcome[SourceDocument]) -> Checked:
    if source.value is None or not source.ok:
        texts = {} if source.value is None else source.value.texts
        return _checked(file, texts, source.diagnostics)
    return check_document(source.value, source.diagnostics)


def check_document(document: SourceDocument, read_with: tuple[Diagnostic, ...] = ()) -> Checked:
    """Link a spec that was read, run every rule on its graph, and take out what comments in the spec excuse.

    Args:
        read_with: what was found when it was read.
    """
    stage("linking")
    file, texts = document.file, document.texts
    if _is_device(Path(file), document):
        device = finding("not-a-cell", f"`{file}` is a device, not a cell", Span(file, 1, 1, 1, 1))
        return _checked(file, texts, (device,))
    if is_plant(document):
        message = f"not supported in a plant yet: what was asked of `{file}`"
        advice = "`cellc check` and `cellc build` take a plant; for the rest name the spec of one of its cells"
        span = document.locate_key((PART_KEY,))
        plant = Diagnostic("unsupported-in-plant", Severity.ERROR, message, span, (PART_KEY,), advice)
        return _checked(file, texts, (plant,))
    linked = _linked(document)
    found = [*read_with, *linked.diagnostics]
    if linked.value is None or not linked.ok:
        return _checked(file, texts, _unexcused([*found, *_beyond_what_stopped(document, linked)], texts))
    graph = build_graph(linked.value)
    stage("rules")
    found += run_rules(graph)
    kept = _excused(found, texts)
    known = frozenset(kept)
    excused = tuple(diagnostic for diagnostic in found if diagnostic not in known)
    return replace(_checked(file, texts, kept, graph), excused=excused, document=document)


def _linked(document: SourceDocument) -> Outcome[Cell]:
    """Return the cell of a document, with what stopped reading its shape or its names."""
    spec = parse(document)
    if spec.value is None or not spec.ok:
        return Outcome(None, spec.diagnostics)
    cell = link(spec.value, document)
    return Outcome(cell.value, (*spec.diagnostics, *cell.diagnostics))


def _beyond_what_stopped(document: SourceDocument, stopped: Outcome[Cell]) -> Iterator[Diagnostic]:
    """Yield what is wrong beside the mistakes that stopped a stage, as if they were repaired or left out."""
    repaired = Repaired(document)
    ignores = ignore_comments(document.texts)
    for _ in range(_ROUNDS):
        errors = [found for found in stopped.diagnostics if found.severity is Severity.ERROR]
        further = repair(repaired, errors) if len(errors) <= _MOST_REPAIRED else None
        if further is None:
            return
        repaired, stopped = further, _linked(further.document)
        yield from filter(repaired.is_apart, stopped.diagnostics)
        if stopped.value is not None and stopped.ok and not repaired.left_out:
            ruled = run_rules(build_graph(stopped.value))
            excused = frozenset(apply_ignores(ruled, ignores, _codes())) if ignores else frozenset(ruled)
            yield from (found for found in ruled if found in excused and repaired.is_apart(found))
            return


def _is_device(path: Path, document: SourceDocument | None) -> bool:
    return document is not None and (path.name == DEVICE_FILE or is_device(document.data))


def _check_description(path: Path) -> Checked:
    # A spec that names devices of the catalog alone is checked without the reader of xacro.
    from cellc.robot.description.read_description import read_description

    stage("reading the description")
    root = root_of(path)
    read = read_description(path, {}, root)
    cell = None if read.value is None else bare_cell(read.value, path.as_posix(), root.as_posix())
    return _checked_model(path, read.diagnostics, cell)


def _check_device(path: Path) -> Checked:
    """Check a device by itself; its description and packages may lie beside its folder, as those of a spec there."""
    stage("reading the device")
    root = Path(os.path.normpath(path.parent / ".."))
    read = load_device_file(path, root)
    cell = None
    if read.value is not None:
        excused = {str(code): because for code, because in read.value.model.excused.items()}
        cell = bare_cell(read.value.description, path.as_posix(), root.as_posix(), excused)
    return _checked_model(path, read.diagnostics, cell)


def _checked_model(path: Path, read: tuple[Diagnostic, ...], cell: Cell | None) -> Checked:
    stage("rules")
    ruled = () if cell is None else run_rules(build_graph(cell), _ON_MODELS)
    return _checked(path.as_posix(), {}, _sorted([*read, *ruled]))


def out_of_time(file: str, *, alone: bool) -> Findings:
    """Return the finding of a spec that took the time of its command, or for which others left none."""
    who = "a spec alone" if alone else "all specs of one command together"
    message = f"{who} must take at most {limits().command_seconds} s of processor time"
    cut = finding("command-too-long", message, Span(file, 1, 1, 1, 1), limit="command-seconds")
    return Findings(file, {}, (cut,))


def compile_cell(checked: Checked) -> Outcome[tuple[Artifact, ...]]:
    """Emit the artifacts of a checked cell with the manifest over them, and have foreign parsers read them back."""
    if checked.plant is not None and checked.ok:
        from cellc.compiler.plant.emit import emit_plant

        return Outcome(emit_plant(checked.plant))
    emitted = emit_cell(checked)
    if emitted.value is None or checked.graph is None:
        return emitted
    # Foreign parsers are imported here: a check does not pay for them, nor does who only compares.
    from cellc.compiler.verify import unread, verify

    stage(f"reading back with other parsers{unread()}")
    return Outcome(emitted.value, verify(emitted.value, checked.graph))


def emit_cell(checked: Checked) -> Outcome[tuple[Artifact, ...]]:
    """Emit the artifacts of a checked cell with the manifest over them."""
    return emit_graph(checked.graph) if checked.graph is not None and checked.ok else Outcome(None)


def emit_graph(graph: CellGraph) -> Outcome[tuple[Artifact, ...]]:
    """Emit the artifacts of a graph, also of one in which rules find errors: to compare them, never to write them."""
    # Emitters are imported here: a check does not pay for them.
    from cellc.compiler.deploy.deployment import plan_deployment
    from cellc.compiler.emit.emit_all import emit_all
    from cellc.compiler.output.manifest import with_manifest

    stage("writing artifacts")
    beyond = _beyond_limits(graph)
    if beyond:
        return Outcome(None, beyond)
    plan = plan_deployment(graph)
    artifacts = with_manifest(
        emit_all(graph, plan),
        cell=graph.cell.name,
        configuration_id=plan.configuration_id,
        configuration_inputs=plan.configuration_inputs,
        version_tuple=plan.versions,
    )
    return Outcome(artifacts)


def _beyond_limits(graph: CellGraph) -> tuple[Diagnostic, ...]:
    """Return that the pairs of links take longer to find than they may: a check finds fewer of them."""
    from cellc.compiler.feasibility import disabled_links
    from cellc.compiler.rules.geometry import beyond_limits

    code, groups = "geometry-too-large", graph.cell.groups
    found = beyond_limits(graph, disabled_links(graph)) if groups else ()
    return tuple(
        Diagnostic(code, Severity.ERROR, finding.message, finding.span, finding.path, finding.help) for finding in found
    )


def _checked(
    file: str, texts: Mapping[str, str], found: tuple[Diagnostic, ...], graph: CellGraph | None = None
) -> Checked:
    return Checked(Findings(file, with_shown_texts(texts, found, Path(file).parent), found), graph)


def _excused(found: list[Diagnostic], texts: Mapping[str, str]) -> tuple[Diagnostic, ...]:
    """Take out what comments excuse, once every rule has run."""
    ignores = ignore_comments(texts)
    return _sorted(list(apply_ignores(found, ignores, _codes()))) if ignores else _sorted(found)


def _unexcused(found: list[Diagnostic], texts: Mapping[str, str]) -> tuple[Diagnostic, ...]:
    """Keep what stopped a stage, and tell comments that try to excuse it."""
    ignores = ignore_comments(texts)
    return _sorted([*found, *misused_ignores(ignores, _codes())]) if ignores else _sorted(found)


def _codes() -> Mapping[str, Severity]:
    # Few cells excuse anything, and only for them the codes of all stages are collected.
    from cellc.compiler.pages import all_codes

    return all_codes()


def _sorted(diagnostics: list[Diagnostic]) -> tuple[Diagnostic, ...]:
    return tuple(sorted(diagnostics, key=Diagnostic.sort_key))
