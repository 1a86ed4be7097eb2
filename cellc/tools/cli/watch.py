"""``cellc watch``: check cells, and build them, whenever a file of theirs is saved."""

from __future__ import annotations

import os
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from cellc.compiler.link.reads import Reads, is_below, reads_of
from cellc.contract.diagnostics.wording import count
from cellc.contract.file_names import SPEC_FILE
from cellc.contract.printing import Stream, clear, show
from cellc.tools.cli.batch import State, cell_files, matched, states
from cellc.tools.cli.build import OUTPUT, summary_of, written
from cellc.tools.cli.findings import IGNORE, SELECT, read_selection, selected, show_findings
from cellc.tools.cli.limit_option import limit_option
from cellc.tools.report.selection import Selection

if TYPE_CHECKING:
    from cellc.compiler.pipeline import Checked

_PAUSE_S = 0.1
_SHARE = 9.0
"""Looking takes a tenth of the time at most, however many files there are."""
_SETTLED_S = 0.02
"""An editor that saves in several steps is done when nothing has changed for so long."""


@click.command()
@click.argument("files", nargs=-1, required=True, metavar="FILES...", type=click.Path(path_type=str))
@click.option("--build", "builds", is_flag=True, help="Also build each cell once it has no errors.")
@OUTPUT
@SELECT
@IGNORE
@limit_option
def watch(files: tuple[str, ...], builds: bool, output: Path, select: tuple[str, ...], ignore: tuple[str, ...]) -> None:
    """Check the cells in FILES, and check a cell again each time one of its files is saved, until Ctrl-C.

    A folder means every cell.yaml below it, new ones included. All files that a cell reads are watched: includes,
    devices, descriptions, meshes, measured files and its `packages`. The compiler stays loaded, so an answer takes a
    fraction of a second.

    \b
    cellc watch cells/bench/cell.yaml          check on save
    cellc watch . --build                      and write generated/NAME of each
    """
    wanted = read_selection(select, ignore)
    missing = next((path for path in matched(files) if not os.path.lexists(path)), None)
    if missing is not None:
        raise click.UsageError(f"there is no file or folder `{missing}`.")
    watched = Watched(files, output)
    before, changed = watched.look(), watched.specs()
    while True:
        clear()
        for spec in changed:
            if not os.path.isdir(spec):
                watched.packages[spec] = _answer(spec, wanted, output if builds else None)
                watched.learn(spec)
        empty = [text for text in watched.specs() if os.path.isdir(text)]
        show(*(f"there is no {SPEC_FILE} below `{folder}` yet" for folder in empty))
        number = len(watched.specs()) - len(empty)
        show(f"watching {count(number, 'cell')}; Ctrl-C ends it", to=Stream.ERR)
        # Folders that a cell names only now have no past; what changed meanwhile has one.
        before, changed = watched.next_change({**watched.look(), **before})


def _answer(spec: str, wanted: Selection, output: Path | None) -> tuple[str, ...]:
    """Show what is found in a cell, and then build it; return the folders of packages that it names."""
    from cellc.compiler.pipeline import check

    checked = check(spec)
    show_findings([selected(checked.findings, wanted)], "text", sum_blockers=output is not None)
    if checked.graph is None:
        return ()
    if output is not None and checked.ok:
        _build(checked, output / checked.graph.cell.name)
    return checked.graph.cell.packages


def _build(checked: Checked, folder: Path) -> None:
    """Write what a cell makes, and show what hinders that."""
    from cellc.compiler.pipeline import compile_cell

    compiled = compile_cell(checked)
    findings, report = replace(checked.findings, diagnostics=compiled.diagnostics), None
    if compiled.value is not None and compiled.ok:
        findings, report = written(findings, compiled.value, folder, force=False)
    if findings.diagnostics:
        show_findings([findings], "text")
    if report is not None:
        show(summary_of(report, folder))


class Watched:
    """The files of some cells, and when they were changed.

    Args:
        paths: specs and folders as the user named them.
        output: what cellc generates, which is not looked at.
    """

    def __init__(self, paths: Sequence[str], output: Path) -> None:
        self._paths, self._output = tuple(paths), output
        self.packages: dict[str, tuple[str, ...]] = {}
        """Of each cell the folders of packages that it names."""
        self._reads: dict[str, Reads] = {}

    def specs(self) -> tuple[str, ...]:
        """Return the cells that there are now."""
        return cell_files(self._paths)

    def look(self) -> dict[str, State]:
        """Return the state of every file that counts: no other may keep a change from being answered."""
        named = (path if os.path.isdir(path) else os.path.dirname(path) or "." for path in self._paths)
        folders = (*named, *(folder for folders in self.packages.values() for folder in folders))
        places = dict.fromkeys(map(os.path.abspath, folders))
        outer = (place for place in places if not any(place != other and is_below(place, (other,)) for other in places))
        return self._counting(states(outer, self._output))

    def learn(self, spec: str) -> None:
        """Find out again what a cell reads."""
        self._reads[spec] = reads_of(spec, self.packages.get(spec, ()), self._reads.get(spec))

    def next_change(self, before: Mapping[str, State]) -> tuple[dict[str, State], tuple[str, ...]]:
        """Wait until a cell has changed, come or gone; return the state of all files then, and cells to be checked."""
        before = self._counting(before)
        after = self._settled(before)
        touched = different(before, after)
        there = self.specs()
        self._reads = {spec: reads for spec, reads in self._reads.items() if spec in there}
        return after, tuple(spec for spec in there if any(self._of(spec).has(text) for text in touched))

    def _counting(self, found: Mapping[str, State]) -> dict[str, State]:
        for spec in self.specs():
            self._of(spec)
        reads = tuple(self._reads.values())  # also of a cell that has gone since
        return {file: state for file, state in found.items() if any(read.has(file) for read in reads)}

    def _of(self, spec: str) -> Reads:
        if spec not in self._reads:
            self.learn(spec)
        return self._reads[spec]

    def _settled(self, before: Mapping[str, State]) -> dict[str, State]:
        seen = before
        while True:
            began = time.monotonic()
            now = self.look()
            if now == seen and now != before:
                return now
            seen, took = now, time.monotonic() - began
            time.sleep(_SETTLED_S if now != before else max(_PAUSE_S, _SHARE * took))


def different(before: Mapping[str, State], after: Mapping[str, State]) -> set[str]:
    """Return the files that were changed, removed or added."""
    return {file for file in before.keys() | after.keys() if before.get(file) != after.get(file)}
