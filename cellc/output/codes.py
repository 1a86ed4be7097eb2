"""Every code that writing the generated folder can report, with its documentation page."""

from __future__ import annotations

from cellc.diagnostics import Severity
from cellc.diagnostics.page import CodePage


def _page(code: str, title: str, why: str, fix: str) -> CodePage:
    return CodePage(code, Severity.ERROR, title, why, fix)


CODES: tuple[CodePage, ...] = (
    _page(
        "bad-artifact-path",
        "a generated file would have an unusable path",
        "A generated file stands inside the generated folder, under a name that every file system can hold; two names "
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
        "something that is no file stands where a file is due, or no folder where a folder is due",
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
        "a symbolic link stands inside the generated folder or in its place",
        "Writing through a link changes files outside the folder that is under review.",
        "replace the link by a folder, or name the folder that it leads to",
    ),
    _page(
        "output-unwritable",
        "the operating system refused to write",
        "Permissions, a full disk or a lost network share; the reason of the system stands in the message. Every file "
        "that was already replaced has been put back.",
        "make the folder writable and free space, then build again",
    ),
)
