"""Every code that writing the generated folder can report, with its page, and the diagnostics made from them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from cellc.contract.diagnostics import Diagnostic, Related, Severity, Span
from cellc.contract.diagnostics.diagnostic import CodePage

# What a shell gets beside a sound `cell.yaml`; its last command reports it.
_EXAMPLES: Mapping[str, str] = {
    "bad-artifact-path": """
$ echo 'hosts: {PC: {}, pc: {}}' >> cell.yaml
$ cellc build cell.yaml
""",
    "edited-by-hand": """
$ cellc build cell.yaml
$ echo 'mine' >> generated/minimal/README.md
$ cellc build cell.yaml
""",
    "output-blocked": """
$ mkdir -p generated/minimal
$ touch generated/minimal/launch
$ cellc build cell.yaml
""",
    "output-shared": """
$ cp cell.yaml other.yaml
$ cellc build cell.yaml other.yaml
""",
    "output-symlink": """
$ mkdir generated elsewhere
$ ln -s ../elsewhere generated/minimal
$ cellc build cell.yaml
""",
    "output-unwritable": """
$ cellc build cell.yaml --output /proc
""",
}


def _page(code: str, title: str, why: str, fix: str) -> CodePage:
    return CodePage(code, Severity.ERROR, title, why, fix, _EXAMPLES.get(code, ""))


CODES: tuple[CodePage, ...] = (
    _page(
        "bad-artifact-path",
        "a generated file would have an unusable path",
        "A generated file is inside the generated folder, under a name that every file system can hold; two names "
        "that differ only in case are one file on some of them.",
        "rename the part of the cell that the file is named after",
    ),
    _page(
        "edited-by-hand",
        "a generated file was edited by hand",
        "Its content is neither what the last build wrote nor what this one would write, so the edit would be lost "
        "without a trace. Nothing is written until somebody decides.",
        "move the change into the spec or into a file of your own, or build with `--force` to discard it",
    ),
    _page(
        "output-blocked",
        "a folder is where a file must be, or a file where a folder must be",
        "Replacing a folder by a file, or the other way round, would delete things that cellc did not make.",
        "move it away",
    ),
    _page(
        "output-busy",
        "another build is writing the same folder",
        "Two builds that replace files of one folder at a time leave a mixture of both.",
        "wait until the other build has ended",
    ),
    _page(
        "output-shared",
        "two specs of one call make the same folder",
        "The generated folder has the name of its cell. The second build would replace what the first one wrote, and "
        "which of the two is left would depend on the order of the arguments.",
        "rename one of the cells, or build them with different `--output` folders",
    ),
    _page(
        "output-symlink",
        "a symbolic link is inside the generated folder or in its place",
        "Writing through a link changes files outside the folder that is under review.",
        "replace the link by a folder, or name the folder that it leads to",
    ),
    _page(
        "output-unwritable",
        "the operating system refused to write",
        "Permissions, a full disk or a lost network share; the message has the system's reason. Every file "
        "that was already replaced has been put back.",
        "make the folder writable and free space, then build again",
    ),
)

_PAGES = {page.code: page for page in CODES}


def finding(code: str, message: str, file: Path, advice: str = "") -> Diagnostic:
    """Return the diagnostic; it marks the first line of the file or folder that it is about.

    Raises:
        KeyError: the code has no page.
    """
    page = _PAGES[code]
    place = Span(file.as_posix(), 1, 1, 1, 1)
    return Diagnostic(code, page.severity, message, place, (), advice or page.fix)


def shared_output(name: str, here: Span, first: Span) -> Diagnostic | None:
    """Report that another spec of the call has made the folder already; the same file named twice is no fault.

    Args:
        name: of the cell, and so of its folder.
        here: where the later spec names its cell.
        first: where the earlier one does.
    """
    if Path(here.file).resolve() == Path(first.file).resolve():
        return None
    return Diagnostic(
        "output-shared",
        Severity.ERROR,
        f"two specs of this call are called `{name}` and would replace each other's folder",
        here,
        ("cell",),
        "rename one of the cells, or build them with different `--output` folders",
        (Related("the other cell of this name", first),),
    )
