"""Text as each format takes it for text alone: xacro, launch files, shells and Markdown.

XML, YAML and JSON are built as structures. Readers refuse most of what is escaped here; this holds without them.
"""

from __future__ import annotations

import re
import shlex

from cellc.contract.diagnostics.unsafe_text import escaped_within

_SPACE = re.compile(r"\s+")
_CODE = re.compile(r"((?<!`)(`+)(?!`).+?(?<!`)\2(?!`))")
_MARKED = re.compile(r"[\\`*\[\]<~$]|&(?=[A-Za-z#])|(?<!\w)_+|_+(?!\w)")
_BLOCK = re.compile(r"[#>+=~-]|\d+(?=[.)](\s|$))")


def one_line(text: str) -> str:
    """Return a text without line breaks, and with an escape for each character that hides text."""
    line = _SPACE.sub(" ", text).strip() if _SPACE.search(text) else text
    return escaped_within(line)


def xacro_text(text: str) -> str:
    """Return what xacro turns into the text: one `$` more before a bracket, and no other two in a row."""
    bracketed = re.sub(r"\$+(?=[{(])", lambda found: found[0] + "$", text)
    return re.sub(r"\$\$+(?![${(])", lambda found: "${'$'}" * (len(found[0]) - 1) + "$", bracketed)


def launch_text(text: str) -> str:
    """Return what `ros2 launch` turns into the text: a backslash before each dollar and backslash."""
    return re.sub(r"[\\$]", lambda found: f"\\{found[0]}", text)


def launch_words(*words: str) -> str:
    """Return words of a command line in a launch file, which takes escapes out and then splits as a shell does."""
    return launch_text(" ".join(map(shell_word, words)))


def shell_word(text: str) -> str:
    """Return one word of a command, in quotes where it needs them."""
    return shlex.quote(one_line(text))


def shell_quoted(text: str) -> str:
    """Return the text between the double quotes of a shell."""
    return re.sub(r'[\\"$`]', lambda found: f"\\{found[0]}", one_line(text))


def markdown(text: str) -> str:
    """Return a text that is one line of prose; code between backticks stays, for it is shown as it is."""
    line = one_line(text)
    pieces: list[str] = []
    end = 0
    for match in _CODE.finditer(line):
        # In a cell of a table no reader tells a backslash before a bar from the one that escapes the bar.
        code = match[0] if "\\|" not in match[0] else _prose(match[0].strip("`"))
        pieces += [_prose(line[end : match.start()]), code]
        end = match.end()
    shown = "".join([*pieces, _prose(line[end:])])
    block = _BLOCK.match(shown)
    if block is None:
        return shown
    return f"{block[0]}\\{shown[block.end() :]}" if block[0].isdigit() else f"\\{shown}"


def _prose(text: str) -> str:
    return _MARKED.sub(lambda found: "&amp;" if found[0] == "&" else re.sub("(.)", r"\\\1", found[0]), text)


def code(text: str) -> str:
    """Return a text as code within prose, between more backticks than it has in a row."""
    line = one_line(text)
    fence = "`" * (max(map(len, re.findall("`+", line)), default=0) + 1)
    apart = " " if line.startswith("`") or line.endswith("`") else ""
    return f"{fence}{apart}{line}{apart}{fence}"


def markdown_comment(text: str) -> str:
    """Return lines as a comment of Markdown, which two hyphens and a bracket would end."""
    apart = re.sub("-(?=-)", "- ", text)
    return f"<!--\n{apart}\n-->"
