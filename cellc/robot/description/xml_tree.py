"""XML read into a small tree with positions, bounded in size and depth, without entities.

The standard ElementTree keeps no columns and minidom expands entities; an untrusted description needs neither.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from xml.parsers import expat

from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, Span
from cellc.contract.limits import MIB, limits, option

_START_TAG = re.compile(rb"""<[^>"']*(?:(?:"[^"]*"|'[^']*')[^>"']*)*>""")

_ATTRIBUTE = re.compile(rb"""\s+([^\s=]+)\s*=\s*("[^"]*"|'[^']*')""")


@dataclass(slots=True)
class XmlElement:
    """One element: tag and attributes as written, children in order, ``span`` its start tag.

    ``text`` is what is between its start tag and its first child, or its end tag where it has no child.
    """

    tag: str
    attributes: dict[str, str]
    span: Span
    text: str = ""
    children: list[XmlElement] = field(default_factory=list)

    def first(self, tag: str) -> XmlElement | None:
        """Return the first child of that tag, or None."""
        return next((child for child in self.children if child.tag == tag), None)

    def all(self, tag: str) -> list[XmlElement]:
        """Return the children of that tag in order."""
        return [child for child in self.children if child.tag == tag]


class _XmlError(Exception):
    """Stops expat inside a callback; carries code and message."""

    def __init__(self, code: str, message: str, help_text: str) -> None:
        super().__init__(message)
        self.code, self.message, self.help_text = code, message, help_text


def read_xml(text: str, file: str) -> Outcome[XmlElement]:
    """Parse XML text into its root element.

    Args:
        text: the whole document.
        file: the path as the user named it, for spans.

    Returns:
        The root, or one diagnostic of ``xml-too-large``, ``xml-not-well-formed``, ``xml-entities`` or ``xml-too-deep``.
    """
    data = text.encode("utf-8", "surrogatepass")
    if len(data) > limits().xml_bytes:
        message = f"the description is {len(data) / MIB:.1f} MiB, at most {limits().xml_bytes // MIB} MiB are read"
        help_text = f"keep meshes in files of their own; {option('xml-bytes')}"
        return _refused("xml-too-large", message, help_text, Span(file, 1, 1, 1, 1))
    zero = text.find("\0")
    if zero >= 0:  # expat would take it for UTF-16, and places in it for others
        line, column = text.count("\n", 0, zero) + 1, zero - text.rfind("\n", 0, zero)
        span = Span(file, line, column, line, column + 1)
        return _refused(
            "xml-not-well-formed", "not well-formed XML: a zero byte, as in UTF-16", "save it as UTF-8", span
        )
    builder = _TreeBuilder(data, file)
    try:
        builder.parser.Parse(data, True)
    except expat.ExpatError as error:
        span = Span(file, error.lineno, error.offset + 1, error.lineno, error.offset + 2)
        return _refused("xml-not-well-formed", f"not well-formed XML: {expat.ErrorString(error.code)}", "", span)
    except _XmlError as error:
        return _refused(error.code, error.message, error.help_text, builder.here())
    assert builder.root is not None  # expat reports a document without an element as an error
    return Outcome(builder.root)


def with_values(text: str, tag: str, attribute: str, change: Callable[[str], str]) -> str:
    """Return a document that `read_xml` takes with the values of an attribute changed, and all else to the letter."""
    data = text.encode("utf-8", "surrogatepass")
    parser, values = expat.ParserCreate(encoding="utf-8"), list[tuple[int, str]]()

    def start(name: str, attributes: dict[str, str]) -> None:
        if name == tag and attribute in attributes:
            values.append((parser.CurrentByteIndex, attributes[attribute]))

    parser.StartElementHandler = start
    parser.Parse(data, True)
    parts, done = list[bytes](), 0
    for at, value in values:
        begin, end = _value_place(data, at + 1 + len(tag.encode()), attribute.encode())
        changed = change(value)
        if changed != value:
            parts += [data[done:begin], _quoted(changed).encode("utf-8", "surrogatepass")]
            done = end
    return b"".join((*parts, data[done:])).decode("utf-8", "surrogatepass")


# As xml.sax.saxutils does it, whose import takes 8 ms of every check because it brings urllib along.
_REFERENCES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", "\n": "&#10;", "\r": "&#13;", "\t": "&#9;"})


def _quoted(value: str) -> str:
    escaped = value.translate(_REFERENCES)
    if '"' not in escaped:
        return f'"{escaped}"'
    return '"{}"'.format(escaped.replace('"', "&quot;")) if "'" in escaped else f"'{escaped}'"


def _value_place(data: bytes, at: int, attribute: bytes) -> tuple[int, int]:
    """Return where the value of an attribute of a start tag is, with its quotes."""
    while match := _ATTRIBUTE.match(data, at):
        if match[1] == attribute:
            return match.span(2)
        at = match.end()
    raise AssertionError("expat found the attribute")


def _refused(code: str, message: str, help_text: str, span: Span) -> Outcome[XmlElement]:
    return Outcome(None, (Diagnostic(code, Severity.ERROR, message, span, help=help_text),))


class _TreeBuilder:
    """Expat's callbacks; the stack holds the open elements."""

    def __init__(self, data: bytes, file: str) -> None:
        self.data, self.file = data, file
        self.depth = limits().xml_depth
        self.root: XmlElement | None = None
        self.stack: list[XmlElement] = []
        # The text is already decoded: an encoding named in the XML declaration no longer holds.
        self.parser = expat.ParserCreate(encoding="utf-8")
        self.parser.buffer_text = True
        self.parser.buffer_size = 1 << 20
        self.parser.StartElementHandler = self.start
        self.parser.EndElementHandler = self.end
        self.parser.CharacterDataHandler = self.characters
        self.parser.StartDoctypeDeclHandler = self.doctype

    def here(self) -> Span:
        line, column = self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1
        return Span(self.file, line, column, line, column + 1)

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        if len(self.stack) >= self.depth:
            message = f"elements are nested deeper than {self.depth} levels"
            raise _XmlError("xml-too-deep", message, "check that the file is a robot description")
        element = XmlElement(tag, attributes, self.start_tag_span())
        if self.stack:
            self.stack[-1].children.append(element)
        else:
            self.root = element
        self.stack.append(element)

    def end(self, tag: str) -> None:
        self.stack.pop()

    def characters(self, text: str) -> None:
        # The parser gathers what it calls this with: a call for each line break would make long texts quadratic.
        element = self.stack[-1]
        if not element.children:
            element.text += text

    def doctype(self, name: str, system_id: str | None, public_id: str | None, has_subset: bool) -> None:
        raise _XmlError(
            "xml-entities", "a document type with entities is refused", "remove the `<!DOCTYPE …>` declaration"
        )

    def start_tag_span(self) -> Span:
        start = self.here()
        match = _START_TAG.match(self.data, self.parser.CurrentByteIndex)
        if match is None:
            return start
        lines = match[0].decode("utf-8", "replace").split("\n")
        if len(lines) == 1:
            return Span(self.file, start.line, start.column, start.line, start.column + len(lines[0]))
        return Span(self.file, start.line, start.column, start.line + len(lines) - 1, len(lines[-1]) + 1)
