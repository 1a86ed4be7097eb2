"""Text that other programs would run, hide or obey: what readers refuse, and how it is shown where it is there.

``xacro``, ``ros2 launch`` and shells replace ``${…}`` and ``$(…)`` by what they evaluate, on the host that starts the
cell. Control characters, direction marks and characters without a width make a reviewer see something else than what
programs read. The runner of GitHub Actions takes lines of a log for commands.
"""

from __future__ import annotations

import json
import re

# What YAML 1.2.2, production c-printable, leaves out, and what only hides text: separators of lines that not all
# readers break at; Default_Ignorable_Code_Point of Unicode 15.1 (DerivedCoreProperties.txt), which has no width: soft
# hyphens, direction marks, fillers, byte order marks, tags; and what is no character at all. Written out, because the
# tables of one Python are not those of the next.
_HIDDEN_CLASS = (
    "\x00-\x08\x0b-\x1f\x7f-\x9f\u00ad\u034f\u061c\u115f\u1160\u17b4\u17b5\u180b-\u180f\u200b\u200e\u200f\u2028-\u202e"
    "\u2060-\u206f\u3164\ud800-\udfff\ufdd0-\ufdef\ufeff\uffa0\ufff0-\ufffb\ufffe\uffff"
    "\U0001bca0-\U0001bca3\U0001d173-\U0001d17a\U000e0000-\U000e0fff"
)
_JOINERS = "\u200c\u200d"
# Joiners belong between letters of some scripts and between emoji, a choice of form behind an emoji or a digit.
HIDDEN = re.compile(
    f"[{_HIDDEN_CLASS}]|(?<![^\\x00-\\x7f])[{_JOINERS}]|[{_JOINERS}](?![^\\x00-\\x7f])"
    "|(?<![^\\x00-\\x7f])(?<![0-9#*])[\ufe00-\ufe0f]"
)
_STEERING_ALONE = re.compile(f"[\t\n{_JOINERS}{_HIDDEN_CLASS}]")
_STEERING = re.compile(f"[\t\n{_JOINERS}]|{HIDDEN.pattern}")
# xacro stops at `$$` with anything else than a bracket behind it.
_SUBSTITUTION = re.compile(r"\$[{($]")
# What a runner obeys: `::error::` behind nothing but blanks, and `##[error]` anywhere (ActionCommand.cs of
# actions/runner); `##vso[…]` of Azure and `##teamcity[…]` are its kin.
_COMMAND_START = re.compile(r"\s*(?=::)")
_COMMAND_WITHIN = re.compile(r"##(?=[A-Za-z]*\[)")
_JSON_ESCAPE = re.compile(r"\\(?:u[dD][89abAB][0-9a-fA-F]{2}\\u[dD][c-fC-F][0-9a-fA-F]{2}|u[0-9a-fA-F]{4}|[^u])")


def hidden(text: str) -> str | None:
    """Say which character hides text, or None."""
    match = None if text.isascii() and text.isprintable() else HIDDEN.search(text)
    return None if match is None else _said(match[0])


def _said(character: str) -> str:
    return f"the text holds the character U+{ord(character):04X}"


def hidden_on_line(text: str) -> tuple[int, str] | None:
    """Return the line of the first character that hides text, and say which, or None."""
    line = text.replace("\r\n", "\n")
    match = HIDDEN.search(line)
    return None if match is None else (line.count("\n", 0, match.start()) + 1, _said(match[0]))


def hidden_in_json(text: str) -> tuple[int, str] | None:
    """Return the same of a JSON text, in which a character is as it is or as an escape."""
    return hidden_on_line(_JSON_ESCAPE.sub(lambda found: _unescaped(found[0]), text) if "\\" in text else text)


def _unescaped(escape: str) -> str:
    try:
        return str(json.loads(f'"{escape}"')).replace("\n", " ")  # which ends no line of the file
    except ValueError:  # no escape of JSON, which its reader refuses
        return ""


def escaped(text: str) -> str:
    """Return a text on one line, with an escape such as ``\\x1b`` for each character that hides text or steers."""
    if text.isascii() and text.isprintable():
        return text
    return _STEERING.sub(_as_escape, text)


def escaped_character(character: str) -> str:
    """Return a character itself, or its escape where it hides or steers whatever is beside it."""
    return _STEERING_ALONE.sub(_as_escape, character)


def escaped_within(text: str) -> str:
    """Return a text with an escape for each character that hides text; tabs, line feeds and joiners stay."""
    return text if text.isascii() and text.isprintable() else HIDDEN.sub(_as_escape, text)


def _as_escape(found: re.Match[str]) -> str:
    return found[0].encode("unicode_escape").decode("ascii")


def harmless_line(line: str) -> str:
    """Return a line that no runner takes for a command; it is on one line already."""
    if "::" in line and (start := _COMMAND_START.match(line)):
        line = f"{start[0]}\\x3a{line[start.end() + 1 :]}"
    return _COMMAND_WITHIN.sub("#\\\\x23", line) if "##" in line else line


def harmless_json(text: str) -> str:
    """Return JSON of the same value, in which no text hides anything or is taken for a command by a runner."""
    if text.isascii() and "\x7f" not in text and "##" not in text:
        return text
    shown = HIDDEN.sub(lambda found: json.dumps(found[0]).strip('"').replace("\x7f", "\\u007f"), text)
    return _COMMAND_WITHIN.sub(r"#\\u0023", shown)


def json_document(data: object) -> str:
    """Return data as JSON of several lines that is harmless, with a line break at its end."""
    return harmless_json(json.dumps(data, ensure_ascii=False, indent=2)) + "\n"


def substitution(text: str) -> str | None:
    """Say that a text holds what xacro, ros2 launch or a shell would evaluate; None where it does not."""
    match = _SUBSTITUTION.search(text) if "$" in text else None
    return None if match is None else f"`{match[0]}` begins what xacro, ros2 launch or a shell would evaluate"
