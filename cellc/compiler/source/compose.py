"""A list or mapping whose end has not been reached."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field

import yaml

from cellc.compiler.source.document import MAX_FINDINGS, Child, Node, Plain, PlainScalar
from cellc.compiler.source.events import event_span, flow_span, parse_events
from cellc.compiler.source.findings import finding
from cellc.compiler.source.scalar import NumberOutOfRangeError, resolve
from cellc.compiler.source.syntax import syntax_finding
from cellc.contract.diagnostics import Diagnostic, Outcome, Related, Span, YamlPath
from cellc.contract.diagnostics.unsafe_text import hidden, substitution
from cellc.contract.frozen import dataclass
from cellc.contract.limits import limits


@dataclass(frozen=True, slots=True)
class Key:
    """A key that waits for its value; ``name`` is None where the key was refused and its value is dropped."""

    name: str | None
    span: Span


@dataclass(slots=True)
class OpenCollection:
    """What is known of a collection between its start and its end."""

    start: yaml.CollectionStartEvent
    is_mapping: bool
    key: Key | None = None
    children: dict[str | int, Child] = field(default_factory=dict)
    size: int = 1
    height: int = 0

    @property
    def expects_key(self) -> bool:
        """Whether the next value is a key."""
        return self.is_mapping and self.key is None

    @property
    def position(self) -> str | int | None:
        """The key or index at which the next value will stand, None before or after a refused key."""
        if not self.is_mapping:
            return len(self.children)
        return self.key.name if self.key is not None else None

    def put(self, node: Node, span: Span) -> None:
        """Take the next value, written at ``span``."""
        position = self.position
        key_span = self.key.span if self.key is not None else None
        if position is not None:
            self.children[position] = Child(node, span, key_span)
        self.key = None
        self.size += node.size
        self.height = max(self.height, node.height)

    def close(self, end: yaml.Event, file: str, lines: Sequence[str]) -> Node:
        """Return the complete node."""
        span = flow_span(self.start, end, file) or self._first_span(file, lines)
        data: Plain
        if self.is_mapping:
            data = {str(name): child.node.data for name, child in self.children.items()}
        else:
            data = [child.node.data for child in self.children.values()]
        return Node(span, data, "", self.children, self.size, self.height + 1)

    def _first_span(self, file: str, lines: Sequence[str]) -> Span:
        first = next(iter(self.children.values()), None)
        if first is not None and first.key_span is not None and not self.start.flow_style:
            return first.key_span
        return event_span(self.start, file, lines)


_NO_VALUES = "put spaces between the numbers, or quotes round all of them: in `{}` a comma ends a value"


def compose(file: str, text: str, *, pure: bool = False) -> Outcome[Node]:
    """Return the root node of a YAML text, or every reason not to trust it.

    Args:
        pure: use the parser written in Python; for the comparison of the two.
    """
    composer = _Composer(file, text)
    try:
        for event in parse_events(text, pure=pure):
            composer.take(event)
            if composer.is_hopeless:
                break
    except (yaml.YAMLError, ValueError) as error:
        composer.findings.append(syntax_finding(error, file, text))
    findings = tuple(composer.findings)
    return Outcome(None if findings else composer.root, findings)


class _Composer:
    """The collections that are open at one event, and what was found so far."""

    def __init__(self, file: str, text: str) -> None:
        self.findings: list[Diagnostic] = []
        self.root: Node | None = None
        self.is_hopeless = False
        self._file = file
        self._limits = limits()
        self._lines = text.split("\n")
        self._open: list[OpenCollection] = []
        self._anchors: dict[str, Node] = {}
        self._documents = 0
        self._values = 0

    def take(self, event: yaml.Event) -> None:
        """Continue with the next event of the file."""
        if isinstance(event, yaml.ScalarEvent):
            self._take_scalar(event)
        elif isinstance(event, yaml.AliasEvent):
            self._take_alias(event)
        elif isinstance(event, yaml.CollectionStartEvent):
            self._start_collection(event)
        elif isinstance(event, yaml.CollectionEndEvent):
            self._end_collection(event)
        elif isinstance(event, yaml.DocumentStartEvent):
            self._start_document(event)

    def _start_document(self, event: yaml.DocumentStartEvent) -> None:
        self._documents += 1
        if self._documents > 1:
            self._stop("several-documents", "a second document begins here", self._span(event))

    def _take_scalar(self, event: yaml.ScalarEvent) -> None:
        self._refuse_tag(event)
        span = self._span(event)
        self._refuse_unsafe(event.value, span)
        data = event.value if event.style else self._resolve(event.value, span)
        node = Node(span, data, event.value)
        if event.anchor is not None:
            self._anchors[event.anchor] = node
        if self._open and self._open[-1].expects_key and event.value == "<<" and not event.style:
            self._report("merge-key", "merge keys `<<` are not part of YAML 1.2", span)
            self._open[-1].key = Key(None, span)
            return
        self._add(node, span)

    def _resolve(self, text: str, span: Span) -> PlainScalar:
        try:
            return resolve(text)
        except NumberOutOfRangeError:
            self._report("number-out-of-range", f"the number `{_short(text)}` does not fit into 64 bits", span)
            return text

    def _take_alias(self, event: yaml.AliasEvent) -> None:
        span, name = self._span(event), event.anchor or ""
        node = self._anchors.get(name)
        if node is None:
            if any(collection.start.anchor == name for collection in self._open):
                self._report("recursive-alias", f"`*{_short(name)}` is inside its own anchor", span)
            else:
                self._report("unknown-alias", f"there is no anchor `&{_short(name)}` before this alias", span)
            node = Node(span, None)
        self._add(node, span)

    def _start_collection(self, event: yaml.CollectionStartEvent) -> None:
        self._refuse_tag(event)
        if len(self._open) >= self._limits.spec_depth:
            message = f"values are nested more than {self._limits.spec_depth} deep"
            self._stop("too-deep", message, self._span(event))
            return
        self._anchors.pop(event.anchor or "", None)
        self._open.append(OpenCollection(event, isinstance(event, yaml.MappingStartEvent)))

    def _end_collection(self, event: yaml.CollectionEndEvent) -> None:
        collection = self._open.pop()
        node = collection.close(event, self._file, self._lines)
        if node.size > self._limits.spec_values:
            message = f"aliases expand to more than {self._limits.spec_values} values"
            self._stop("alias-bomb", message, node.span)
        elif node.height + len(self._open) > self._limits.spec_depth:
            message = f"aliases nest values more than {self._limits.spec_depth} deep"
            self._stop("too-deep", message, node.span)
        else:
            # An anchor of the same name inside this collection comes later in the file and stays in force.
            if collection.start.anchor is not None:
                self._anchors.setdefault(collection.start.anchor, node)
            self._add(node, node.span)

    def _add(self, node: Node, span: Span) -> None:
        """Put a complete value where it belongs: the root, a key, or the value of a key or an item."""
        self._values += 1
        if self._values > self._limits.spec_values:
            message = f"the file holds more than {self._limits.spec_values} values"
            self._stop("too-many-values", message, span)
        elif not self._open:
            self.root = node
        elif self._open[-1].expects_key:
            self._open[-1].key = Key(self._accept_key(self._open[-1], node, span), span)
        else:
            self._open[-1].put(node, span)

    def _accept_key(self, collection: OpenCollection, node: Node, span: Span) -> str | None:
        """Return the name of a key, or None after reporting why it cannot be one."""
        if not isinstance(node.data, str):
            shown = f"`{_short(node.text)}`" if node.text else "an empty key" if node.data is None else "a collection"
            advice = _NO_VALUES if collection.start.flow_style and self._has_no_value(span) else ""
            self._report("non-string-key", f"the key is {_kind(node)}: {shown}", span, advice=advice)
            return None
        first = collection.children.get(node.data)
        if first is not None:
            related = (Related("first written here", first.key_span or first.span),)
            self._report(
                "duplicate-key", f"the key `{_short(node.data)}` is written twice", span, related, (node.data,)
            )
            return None
        return node.data

    def _has_no_value(self, span: Span) -> bool:
        """Return whether a comma or the closing brace follows a key, without a value."""
        rest = self._lines[span.end_line - 1][span.end_column - 1 :].lstrip()
        return rest[:1] in (",", "}")

    def _refuse_tag(self, event: yaml.ScalarEvent | yaml.CollectionStartEvent) -> None:
        if event.tag is not None:
            self._report("yaml-tag", f"the value carries the tag `{_short(event.tag)}`", self._span(event))

    def _refuse_unsafe(self, text: str, span: Span) -> None:
        # Hidden characters can stand here as escapes alone: as they are the text of the file was refused for them.
        if message := hidden(text):
            self._report("control-character", message, span)
        if message := substitution(text):
            self._report("substitution-in-text", message, span)

    def _report(
        self,
        code: str,
        message: str,
        span: Span,
        related: tuple[Related, ...] = (),
        key: YamlPath = (),
        advice: str = "",
    ) -> None:
        path = tuple(part for collection in self._open if (part := collection.position) is not None) + key
        self.findings.append(finding(code, message, span, path=path, advice=advice, related=related))
        self.is_hopeless = self.is_hopeless or len(self.findings) >= MAX_FINDINGS

    def _stop(self, code: str, message: str, span: Span) -> None:
        self._report(code, message, span)
        self.is_hopeless = True

    def _span(self, event: yaml.Event) -> Span:
        return event_span(event, self._file, self._lines)


def _short(text: str) -> str:
    return text if len(text) <= 48 else f"{text[:45]}..."


def _kind(node: Node) -> str:
    if isinstance(node.data, bool):
        return "a boolean"
    if isinstance(node.data, (int, float)):
        return "a number"
    return "no text"
