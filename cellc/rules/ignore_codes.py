"""Every code that a comment `# cellc: ignore` can earn, with its documentation page."""

from __future__ import annotations

from cellc.diagnostics import Severity
from cellc.diagnostics.page import CodePage

CODES: tuple[CodePage, ...] = (
    CodePage(
        "ignore-refused",
        Severity.ERROR,
        "a comment ignores a finding that nobody may ignore",
        "Errors and blockers of safety, ownership and frames say that something can move that nobody stops, commands, "
        "or knows the place of; errors of reading and linking say that the cell is not known. A comment can justify "
        "neither, so both stay: the finding, and this one.",
        "remove the comment and mend what the code reports",
    ),
    CodePage(
        "ignore-without-reason",
        Severity.ERROR,
        "a comment ignores a finding and does not say why",
        "Whoever reviews the cell later must be able to judge whether the exception still holds. Without a reason the "
        "comment has no effect.",
        "write `# cellc: ignore CODE reason`",
    ),
    CodePage(
        "unknown-ignored-code",
        Severity.ERROR,
        "a comment ignores a code that does not exist",
        "A misspelt code ignores nothing, and the finding that was meant looks as if it came back by itself.",
        "write a code that `cellc explain` lists; several are separated by commas",
    ),
    CodePage(
        "unused-ignore",
        Severity.WARNING,
        "a comment ignores a finding that is not there",
        "What was excused is gone or stands on another line, and the comment would hide the next defect of its kind. "
        "It counts at the end of the line that is reported.",
        "delete the comment, or move it to the end of the reported line",
    ),
)
