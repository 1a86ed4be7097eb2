"""Texts that steer a terminal, hide what is written, or are commands to a program that runs CI; and who is their judge.

What the runners parse: `ActionCommand.cs` of actions/runner (a line that begins with `::` behind any white space of
.NET, and `##[` anywhere), `Command.cs` of the agent of Azure Pipelines (`##vso[` anywhere), and `section_start:` behind
ESC[0K or a carriage return in logs of GitLab.
"""

from __future__ import annotations

import re

PAYLOADS = {
    "workflow command": "\n::error file=forged.yaml::forged",
    "workflow command at the start": "::error::forged",
    "workflow command behind blanks": " \u3000\t::add-mask::forged",
    "old workflow command": "a ##[error]forged",
    "azure command": "a ##vso[task.setvariable variable=a]forged",
    "carriage return": "a\r::error::forged",
    "percent": "a%0A::error::forged",
    "gitlab section": "\x1b[0Ksection_start:1:forged\r\x1b[0Kforged",
    "colour": "\x1b[31mforged",
    "clear": "\x1b[2J\x1b[H",
    "title": "\x1b]0;forged\x07",
    "link": "\x1b]8;;http://forged.example\x1b\\forged\x1b]8;;\x1b\\",
    "C1 control": "\u009b31mforged",
    "next line": "a\u0085::error::forged",
    "line separator": "a\u2028::error::forged",
    "right to left": "a\u202eforged\u202c",
    "isolate": "a\u2066forged\u2069",
    "without width": "a\u200bb\u200db\u2060c\ufeffd",
    "tags": "a\U000e0066\U000e006f",
    "soft hyphen": "a\u00adb",
    "delete": "a\x7f\x08b",
}

_STEERING = re.compile(
    "[\x00-\x09\x0b-\x1f\x7f-\x9f\u00ad\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\U000e0000-\U000e0fff]"
)
_COLOUR = re.compile(r"\x1b\[[0-9;]*m")


def harm(output: str, own_commands: frozenset[str] = frozenset()) -> list[str]:
    """Return the lines that a terminal or a runner would obey, or that hide something.

    Args:
        own_commands: workflow commands that the output may have.
    """
    return [line for line in output.split("\n") if _STEERING.search(line) or _obeyed(line, own_commands)]


def hides(text: str) -> bool:
    """Whether a file holds what hides text or steers a terminal; tabs and ends of lines are its own."""
    return _STEERING.search(text.replace("\t", "")) is not None


def without_colour(output: str) -> str:
    return _COLOUR.sub("", output)


def _obeyed(line: str, own_commands: frozenset[str]) -> bool:
    told = line.strip()
    if told.startswith("::"):
        return told[2:].partition("::")[0].partition(" ")[0] not in own_commands
    return re.search(r"##\w*\[", told) is not None
