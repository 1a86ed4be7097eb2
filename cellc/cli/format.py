"""``cellc format``: the canonical form of cells and devices, written into their files or told."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import click

from cellc.cli.batch import SPEC_FILE, files_below
from cellc.cli.findings import show_findings
from cellc.diagnostics import Diagnostic
from cellc.diagnostics.diagnostic import Findings
from cellc.printing import Line, Stream, Style, Styled, as_text, refuse, show, show_document

_STDIN = "-"
_DIFF_STYLES = {"+": Style.GREEN, "-": Style.RED, "@": Style.CYAN}


@click.command()
@click.argument("files", nargs=-1, required=True, metavar="FILES...", type=click.Path(path_type=str))
@click.option("--check", is_flag=True, help="Write nothing, and fail where a file would change.")
@click.option("--diff", is_flag=True, help="Write nothing, and show what would change.")
def format(files: tuple[str, ...], check: bool, diff: bool) -> None:
    """Put FILES into their canonical form: order of keys, spacing, spelling of quantities.

    A folder stands for every cell.yaml below it with what it includes, and every device.yaml; `-` reads standard input
    and writes standard output. Every comment stays with what it belongs to, and no value changes.

    \b
    cellc format .                             every cell and device of a repository
    cellc format cells/bench/cell.yaml         one file
    cellc format . --check --diff              what a pull request would change
    cellc format - < cell.yaml                 for an editor
    """
    if _STDIN in files and len(files) > 1:
        raise click.UsageError("expected `-` alone, or files and folders.")
    done = [_taken(file, writes=not (check or diff)) for file in _meant(files)]
    refused = [Findings(one.name, {one.name: one.before}, one.findings) for one in done if one.findings]
    if refused:
        show_findings(refused, "text")
    changed = [one for one in done if one.after != one.before and not one.findings]
    for one in changed if diff else ():
        show(*_difference(one))
    if _STDIN in files and not (check or diff or refused):
        _show_formatted(done[0].after)
    elif _STDIN not in files:
        _tell(done, changed, would=check or diff)
    if refused or any(one.failed for one in done) or (check and changed):
        raise click.exceptions.Exit(1)


@dataclass(frozen=True, slots=True)
class _Taken:
    """A file as it was and in its canonical form, with line breaks as ``\\n``."""

    name: str
    before: str = ""
    after: str = ""
    findings: tuple[Diagnostic, ...] = ()
    failed: bool = False


def _meant(files: Sequence[str]) -> Iterator[str]:
    """Yield each file once that arguments stand for."""
    from cellc.catalog.compiled import DEVICE_FILE, FAMILY_FILE
    from cellc.source import read

    seen = set[str]()
    for file in files:
        below = files_below(file, SPEC_FILE, DEVICE_FILE, f"*{FAMILY_FILE}") if os.path.isdir(file) else ()
        for name in below or (file,):
            document = read(name).value if below and os.path.basename(name) == SPEC_FILE else None
            for one in (name, *(document.texts if document is not None else ())):
                if os.path.realpath(one) not in seen:
                    seen.add(os.path.realpath(one))
                    yield one


def _taken(file: str, *, writes: bool) -> _Taken:
    from cellc.diagnostics import Span
    from cellc.layout.layout import formatted
    from cellc.source.read import link_out
    from cellc.source.text import read_text, text_of

    name = "<stdin>" if file == _STDIN else file.replace(os.sep, "/")
    escape = link_out(Path(file), name)
    if escape is not None:
        return _Taken(name, findings=(escape,))
    place = Span(name, 1, 1, 1, 1)
    text = text_of(sys.stdin.buffer.read(), name) if file == _STDIN else read_text(Path(file), name, place)
    if text.value is None or text.diagnostics:
        return _Taken(name, text.value or "", findings=text.diagnostics)
    made = formatted(name, text.value)
    if made.value is None:
        return _Taken(name, text.value, findings=made.diagnostics)
    failed = writes and file != _STDIN and made.value != text.value and not _written(file, made.value, text.value)
    return _Taken(name, text.value, made.value, failed=failed)


def _written(file: str, text: str, expected: str) -> bool:
    from cellc.edit.rewrite import replace_text

    try:
        if replace_text(Path(file), text, expected):
            return True
        refuse(f"`{file}` was changed meanwhile")
    except OSError as error:
        refuse(f"`{file}` cannot be written: {(error.strerror or 'unknown reason').lower()}")
    return False


def _show_formatted(text: str) -> None:
    """Write a file to standard output, or nothing where a line of it would not come out as it is."""
    if as_text(text.removesuffix("\n").split("\n"), colour=False) != text:
        refuse("a line reads like a command to a runner of CI; format the file itself")
        raise click.exceptions.Exit(1)
    show_document(text)


def _difference(one: _Taken) -> Iterator[Line]:
    from difflib import unified_diff

    before, after = one.before.split("\n"), one.after.split("\n")
    for line in unified_diff(before, after, one.name, one.name, lineterm=""):
        style = _DIFF_STYLES.get(line[:1])
        yield line if style is None or line[:3] in ("+++", "---") else (Styled(line, style),)


def _tell(done: Sequence[_Taken], changed: Sequence[_Taken], *, would: bool) -> None:
    """Say on standard error what was done, or would be."""
    for one in changed:
        if not one.failed:
            show(f"{'would format' if would else 'formatted'} {one.name}", to=Stream.ERR)
    same = len(done) - len(changed) - sum(1 for one in done if one.findings)
    if same:
        show(f"{same} {'file is' if same == 1 else 'files are'} in canonical form", to=Stream.ERR)
