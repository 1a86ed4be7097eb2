"""A cell on another distribution: what its pins, parameters and package become, compiled in memory."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from pathlib import Path

from cellc.compiler.catalog.tables import DistroFacts
from cellc.compiler.cell.cell import Cell
from cellc.compiler.deploy.bringup import bring_up
from cellc.compiler.emit.security.policy import granted
from cellc.compiler.pipeline import Checked, check
from cellc.contract.diagnostics import Severity
from cellc.contract.errors import reason_of
from cellc.contract.upgrade import Upgrade, UpgradeInterface, UpgradePin
from cellc.contract.vocabulary import UNKNOWN, Distro, ReviewArea
from cellc.tools.edit.rewrite import Edit, rewrite
from cellc.tools.report.json_report import as_review_finding
from cellc.tools.review.declared import NodeParameters, parameter_changes
from cellc.tools.review.facts import Facts
from cellc.tools.review.leaves import Leaf
from cellc.tools.review.moved_spec import UpgradeError, edited_check, facts_of_distro
from cellc.tools.review.review import gates_again, review
from cellc.tools.review.sides import Package, SideError, package_of
from cellc.tools.review.tuples import PinMove, moved_pins


@dataclass(frozen=True, slots=True)
class Planned:
    """What an upgrade would change, and the edits of the spec that do it."""

    upgrade: Upgrade
    edits: tuple[Edit, ...]
    texts: Mapping[str, str]

    def write(self) -> tuple[Edit, ...]:
        """Write the edits into the spec and what it includes, each file as a whole or not at all.

        Raises:
            UpgradeError: a file cannot be written, or is no longer what was read.
        """
        for file, edits in groupby(sorted(self.edits, key=lambda one: one.file), key=lambda one: one.file):
            try:
                changed = rewrite(Path(file), tuple(edits), self.texts[file])
            except OSError as error:
                raise UpgradeError(f"`{file}` cannot be written: {reason_of(error)}") from None
            if not changed:
                raise UpgradeError(f"`{file}` changed while it was read; nothing of it was written")
        return self.edits


def plan_upgrade(file: str, target: Distro) -> Planned:
    """Return what another distribution makes of a cell.

    Raises:
        UpgradeError: the spec cannot be edited, or holds errors as it is.
        SideError: nothing can be made of it.
    """
    checked = check(file)
    errors = [diagnostic for diagnostic in checked.diagnostics if diagnostic.severity is Severity.ERROR]
    if errors or checked.graph is None:
        more = f"; {len(errors) - 1} more" if len(errors) > 1 else ""
        raise UpgradeError(f"{errors[0].span}: {errors[0].message}{more}; see `cellc check`")
    before = replace(package_of(file, checked), name=f"{file} on {checked.graph.cell.distro}")
    cell = checked.graph.cell
    moves = moved_pins(cell, target, facts_of_distro(target))
    edits, moved = edited_check(file, cell, checked.findings.texts, [(move.pin, move.text) for move in moves])
    moved = moved or checked
    try:
        after = package_of(f"{file} on {target}", moved) if moved.ok else None
    except SideError:
        after = None
    return Planned(_upgrade(cell, target, moves, before, after, moved), edits, checked.findings.texts)


def _upgrade(
    cell: Cell, target: Distro, moves: Sequence[PinMove], before: Package, after: Package | None, moved: Checked
) -> Upgrade:
    # What changes is the version tuple as a whole: no pin of it is tried alone.
    compared = None if after is None else review(replace(before, document=None), after)
    parameters = parameter_changes(cell, target, _given(before.facts), _given((after or before).facts))
    asked = (
        *(move.question for move in moves),
        *(parameter.question for parameter in parameters),
        _rollback(cell, moves),
    )
    errors = (diagnostic for diagnostic in moved.diagnostics if diagnostic.severity is Severity.ERROR)
    return Upgrade(
        format=1,
        cell=cell.name,
        before=cell.distro.value,
        after=target.value,
        facts=tuple(_of_distro(facts_of_distro(target))),
        pins=tuple(_pin(cell, move) for move in moves),
        parameters=parameters,
        interfaces=() if after is None or moved.graph is None else tuple(_interfaces(cell, moved.graph.cell)),
        review=compared,
        errors=() if after is not None else tuple(map(as_review_finding, errors)),
        gates=gates_again((ReviewArea.VERSIONS,)) if compared is None else compared.gates,
        questions=tuple(question for question in asked if question),
    )


def _of_distro(facts: DistroFacts) -> Iterator[str]:
    support = "with long support" if facts.lts else "without long support"
    yield f"{facts.title}, released {facts.released}, {support}; its end of life is {facts.end_of_life}"
    if facts.end_of_life_note is not None:
        yield facts.end_of_life_note
    yield f"built for {', '.join(facts.os)}, with Python {facts.python}"


def _pin(cell: Cell, move: PinMove) -> UpgradePin:
    pin = move.pin
    return UpgradePin(
        holder=pin.holder,
        part=pin.part,
        before=pin.text,
        after=move.text,
        place=str(cell.locate(*pin.path)) if cell.states(*pin.path) else "",
        answer=move.judged.answer.value,
        evidence=move.judged.evidence,
        question=move.question,
    )


def _rollback(cell: Cell, moves: Sequence[PinMove]) -> str:
    """Return what is asked before the first of another tuple runs: what one goes back to."""
    known = UNKNOWN not in (cell.versions.rollback.image, cell.versions.rollback.configuration)
    if known or all(move.text == move.pin.text for move in moves):
        return ""
    return "`rollback`: to which image and configuration does the cell roll back? The spec names neither"


def _given(facts: Facts) -> NodeParameters:
    """Return the parameters of each node of a package, by its full name."""
    given: dict[str, dict[str, Leaf]] = {}
    for path, leaf in facts.leaves.items():
        if path[0] == "parameters" and path[3:4] == ("ros__parameters",):
            given.setdefault(f"/{path[2].strip('/')}", {})[".".join(path[4:])] = leaf
    return given


def _interfaces(before: Cell, after: Cell) -> Iterator[UpgradeInterface]:
    """Yield the names at the graph that one side's policy grants alone, those of several nodes once."""
    was, now = (granted(cell, bring_up(cell)) for cell in (before, after))
    changes: dict[tuple[str, str, str], list[str]] = {}
    for change, some, others in (("gained", now, was), ("lost", was, now)):
        for node, rights in some.items():
            for right, name in sorted(rights - others.get(node, frozenset())):
                changes.setdefault((change, right, name), []).append(node)
    for (change, right, name), nodes in changes.items():
        yield UpgradeInterface.model_validate({"nodes": nodes, "right": right, "name": name, "change": change})
