"""``cellc format``: the canonical form of cells and devices, written into their files or printed."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from cellc.contract.diagnostics.diagnostic import Findings
from cellc.contract.diagnostics.wording import count
from cellc.contract.errors import reason_of
from cellc.contract.file_names import SPEC_FILE
from cellc.contract.printing import Line, Stream, Style, Styled, as_text, refuse, show, show_document, stage
from cellc.tools.cli.batch import files_below
from cellc.tools.cli.findings import show_findings

if TYPE_CHECKING:
    from cellc.tools.layout.files import Taken

_STDIN = "-"
_DIFF_STYLES = {"+": Style.GREEN, "-": Style.RED, "@": Style.CYAN}


@click.command()
@click.argument("files", nargs=-1, required=True, metavar="FILES...", type=click.Path(path_type=str))
@click.option("--check", is_flag=True, help="Write nothing; fail if a file would change.")
@click.option("--diff", is_flag=True, help="Write nothing; show what would change.")
def format(files: tuple[str, ...], check: bool, diff: bool) -> None:
    """Format FILES: order of keys, spacing, spelling of quantities.

    A folder means every cell.yaml below it with its includes, and every device.yaml; `-` reads standard input and
    writes standard output. Comments stay in place, and no value changes.

    \b
    cellc format .                             every cell and device below
    cellc format cells/bench/cell.yaml         one file
    cellc format . --check --diff              what a pull request would change
    cellc format - < cell.yaml                 for an editor
    """
    if _STDIN in files and len(files) > 1:
        raise click.UsageError("expected `-` alone, or files and folders.")
    from cellc.tools.layout.files import take_content, take_file

    if _STDIN in files:
        done = [take_content(sys.stdin.buffer.read(), "<stdin>")]
    else:
        done = []
        for file in meant(files):
            stage(file)
            done.append(take_file(file))
    refused = [Findings(taken.name, {taken.name: taken.before}, taken.findings) for taken in done if taken.findings]
    if refused:
        show_findings(refused, "text")
    changed = [taken for taken in done if taken.changes]
    for taken in changed if diff else ():
        show(*_difference(taken))
    writes = not (check or diff)
    if _STDIN in files:
        failed = writes and not refused and not _shown(done[0].after)
    else:
        failed = [put(taken, writes=writes) for taken in changed].count(False) > 0
        if same := len(done) - len(changed) - len(refused):
            show(f"{count(same, 'file')} {'is' if same == 1 else 'are'} in canonical form", to=Stream.ERR)
    if refused or failed or (check and changed):
        raise click.exceptions.Exit(1)


def meant(files: Sequence[str]) -> Iterator[str]:
    """Yield each file once that arguments stand for."""
    from cellc.compiler.catalog.compiled import DEVICE_FILE, FAMILY_FILE
    from cellc.tools.layout.files import with_includes

    seen = set[str]()
    for file in files:
        below = files_below(file, SPEC_FILE, DEVICE_FILE, f"*{FAMILY_FILE}") if os.path.isdir(file) else ()
        if os.path.isdir(file) and not below:
            raise click.UsageError(f"there is no {SPEC_FILE}, {DEVICE_FILE} or *{FAMILY_FILE} below `{file}`.")
        for name in below or (file,):
            is_spec = bool(below) and os.path.basename(name) == SPEC_FILE
            for include in with_includes(name) if is_spec else (name,):
                if os.path.realpath(include) not in seen:
                    seen.add(os.path.realpath(include))
                    yield include


def put(one: Taken, *, writes: bool) -> bool:
    """Write a file in its form and say so on standard error, or say that it would be."""
    from cellc.tools.edit.rewrite import replace_text

    try:
        if writes and not replace_text(Path(one.name), one.after, one.before):
            refuse(f"`{one.name}` was changed meanwhile")
            return False
    except OSError as error:
        refuse(f"`{one.name}` cannot be written: {reason_of(error)}")
        return False
    show(f"{'formatted' if writes else 'would format'} {one.name}", to=Stream.ERR)
    return True


def _shown(text: str) -> bool:
    """Write a file to standard output, or nothing where a line of it would not come out as it is."""
    if as_text(text.removesuffix("\n").split("\n"), color=False) != text:
        refuse("a line reads like a command to a runner of CI; format the file itself")
        return False
    show_document(text)
    return True


def _difference(one: Taken) -> Iterator[Line]:
    from difflib import unified_diff

    before, after = one.before.split("\n"), one.after.split("\n")
    for line in unified_diff(before, after, one.name, one.name, lineterm=""):
        style = _DIFF_STYLES.get(line[:1])
        yield line if style is None or line[:3] in ("+++", "---") else (Styled(line, style),)
