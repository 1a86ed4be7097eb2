"""XML text from a tree: two spaces a level, attributes in the order given.

One element a line; an element with nothing but one other that takes a line shares it where both fit.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from xml.etree.ElementTree import Element

from cellc.contract.diagnostics.unsafe_text import HIDDEN, escaped_within

_COMMENT = "!--"
_DECLARATION = '<?xml version="1.0"?>'
"""Without an encoding, which is UTF-8 then: some parsers refuse a text in memory that declares one."""
_WIDTH = 120
_NO_CHARACTER = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


def element(
    tag: str, attributes: Mapping[str, str] | None = None, children: Iterable[Element] = (), text: str = ""
) -> Element:
    """Build an element with its attributes, children and text."""
    built = Element(tag, dict(attributes or {}))
    built.text = text or None
    built.extend(tuple(children))
    return built


def comment(text: str) -> Element:
    """Build a comment; two hyphens in a row, which XML forbids there, are set apart."""
    built = Element(_COMMENT)
    built.text = _apart(text)
    return built


def render(root: Element, header: str = "") -> str:
    """Write a document: the declaration, the header comment, the tree.

    Args:
        root: the root element.
        header: text of a comment before the root; several lines are allowed, empty for none.
    """
    return headed("\n".join((_DECLARATION, *_lines(root, 0), "")), header)


def headed(document: str, header: str) -> str:
    """Return a document that was written without a header with one."""
    if not header:
        return document
    lines = (_DECLARATION, "<!--", *(f"  {_apart(line)}".rstrip() for line in header.splitlines()), "-->")
    return "\n".join(lines) + document.removeprefix(_DECLARATION)


def _apart(text: str) -> str:
    return re.sub("-(?=-)", "- ", escaped_within(text))


# As xml.sax.saxutils does it, whose import takes 8 ms of every check because it brings urllib along.
def _escaped(text: str) -> str:
    shown = text.replace("&", "&amp;").replace(">", "&gt;").replace("<", "&lt;")
    return shown if shown.isascii() and shown.isprintable() else HIDDEN.sub(_reference, shown)


def _reference(found: re.Match[str]) -> str:
    """Return a reference to a character that hides text; XML 1.0 takes none to what its production Char leaves out."""
    character = found[0]
    return "\ufffd" if _NO_CHARACTER.match(character) else f"&#x{ord(character):X};"


def _quoted(value: str) -> str:
    escaped = _escaped(value).replace("\n", "&#10;").replace("\t", "&#9;")
    if '"' not in escaped:
        return f'"{escaped}"'
    return '"{}"'.format(escaped.replace('"', "&quot;")) if "'" in escaped else f"'{escaped}'"


def _lines(node: Element, depth: int) -> Iterator[str]:
    indent = "  " * depth
    if node.tag == _COMMENT:
        if depth == 1:
            yield ""
        yield f"{indent}<!-- {node.text} -->"
        return
    start = node.tag + "".join(f" {name}={_quoted(value)}" for name, value in node.attrib.items())
    if len(node) == 0:
        yield f"{indent}<{start}>{_escaped(node.text)}</{node.tag}>" if node.text else f"{indent}<{start}/>"
        return
    inner = [line for child in node for line in _lines(child, depth + 1)]
    alone = f"{indent}<{start}>{inner[0].strip()}</{node.tag}>"
    if len(inner) == 1 and len(alone) <= _WIDTH:
        yield alone
        return
    yield from (f"{indent}<{start}>", *inner, f"{indent}</{node.tag}>")
