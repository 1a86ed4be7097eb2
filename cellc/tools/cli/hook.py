"""``cellc hook``: form, findings and generated folder of every cell in one process, for a commit."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import click

from cellc.contract.diagnostics import Severity, Span
from cellc.contract.diagnostics.diagnostic import Findings
from cellc.contract.diagnostics.wording import count
from cellc.contract.printing import Line, Stream, show, stage
from cellc.tools.cli.batch import cell_files, results
from cellc.tools.cli.build import OUTPUT, Built, build_command, built, unless_shared
from cellc.tools.cli.findings import show_findings
from cellc.tools.cli.fleet import Task
from cellc.tools.cli.format import meant, put

_SHOWN = 12
"""Lines of the differences of one folder; `cellc build --check` shows all."""


@click.command()
@click.argument("files", nargs=-1, required=True, type=click.Path(path_type=str))
@OUTPUT
@click.option("--fix", is_flag=True, help="Write the form and the folders instead of saying how.")
def hook(files: tuple[str, ...], output: Path, fix: bool) -> None:
    """Check FILES for a commit: canonical form, errors, and generated folders that are up to date.

    A folder means every cell.yaml below it. Prints only what fails, with the command that corrects it; a cell that
    has not changed since it was built is not compiled again.

    \b
    cellc hook .                  fails where something must be done
    cellc hook --fix .            formats and builds, and fails where an error is left
    """
    refused = list[Findings]()
    in_form = all(list(_formed(files, fix, refused)))
    cells = cell_files(files)
    done = list(_built(cells, output, fix))
    failing = [findings for cell in done if (findings := _errors(cell)).diagnostics]
    reported = {finding.span.file for findings in failing for finding in findings.diagnostics}
    failing += [findings for findings in refused if findings.file not in reported]
    show_findings(failing, "text")
    for file, cell in zip(cells, done, strict=True):
        if cell.wrote:
            show(*cell.messages)
        if cell.problem:
            show(*_shortened(cell.messages, build_command(file, output)), cell.problem)
    if failing or not in_form or any(cell.problem for cell in done):
        raise click.exceptions.Exit(1)
    show(f"{count(len(done), 'cell')} up to date", to=Stream.ERR)


def _formed(files: Sequence[str], fix: bool, refused: list[Findings]) -> Iterator[bool]:
    """Put each file into its form, or say which command does; yield whether it needs nothing more.

    Args:
        refused: gets what is wrong with files that cannot be read.
    """
    from cellc.tools.layout.files import take_file

    for file in meant(files):
        stage(file)
        taken = take_file(file)
        if taken.findings:
            refused.append(Findings(taken.name, {taken.name: taken.before}, taken.findings))
        elif taken.changes and fix:
            yield put(taken, writes=True)
        elif taken.changes:
            show(f"`{file}` is not in canonical form; run `cellc format {file}`")
            yield False


def _built(cells: Sequence[str], output: Path, fix: bool) -> Iterator[Built]:
    tasks, places = [Task(file) for file in cells], dict[tuple[str, str], Span]()
    for task, result in zip(tasks, results("compile", tasks), strict=True):
        yield built(task, unless_shared(result, "", places), output, only_compare=not fix, force=False)


def _errors(cell: Built) -> Findings:
    found = cell.result.findings
    return replace(found, diagnostics=tuple(each for each in found.diagnostics if each.severity is Severity.ERROR))


def _shortened(lines: Sequence[Line], command: str) -> list[Line]:
    more = len(lines) - _SHOWN
    if more <= 1:
        return list(lines)
    return [*lines[:_SHOWN], f"and {more} more lines, which `{command} --check` shows"]
