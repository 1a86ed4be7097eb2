"""From a text to the tree of what is written."""

from __future__ import annotations

import re
from collections.abc import Iterator

import yaml

from cellc.compiler.source.events import comments, last_written, parse_events
from cellc.contract.errors import CellcError
from cellc.tools.layout.tree import Collection, Comment, Entry, Scalar, Value, Written

_COMMENT = re.compile("#")
_KEEPS_ALL = re.compile(r"[|>][0-9]*\+")


class UnusualError(CellcError, ValueError):
    """What this reader does not take apart: explicit keys, directives, aliases as keys, several documents."""


def read_written(text: str) -> Written:
    """Return a text as a tree.

    Args:
        text: of a file without any finding of ``compose``, with line breaks as ``\\n``.

    Raises:
        UnusualError: the text is legal and has a form that is not written by hand.
    """
    return _Reader(text).document()


class _Reader:
    """The events that come next, and the comments that no value has yet."""

    def __init__(self, text: str) -> None:
        self._lines = text.split("\n")
        self._events: list[yaml.Event] = [
            event
            for event in parse_events(text)
            if not isinstance(event, (yaml.StreamStartEvent, yaml.StreamEndEvent, yaml.DocumentEndEvent))
        ]
        self._at = 0
        # The first of a line that no scalar holds: whatever follows is part of it.
        newest_first = reversed(comments(text, _COMMENT))
        self._comments = {comment.line - 1: Comment(comment.column - 1, comment.text) for comment in newest_first}
        self._last = -1
        """The line up to which comments have their place."""

    def document(self) -> Written:
        start = self._next()
        first = self._events[self._at]
        line = _start(first)[0]
        if not isinstance(start, yaml.DocumentStartEvent) or start.version or start.tags:
            raise UnusualError("the text has directives")
        head = self._head(start, line)
        if any(text.startswith("...") for text in self._lines):
            raise UnusualError("the end of the document is marked")
        root = self._value(-1)
        tree = Written(_squeezed(head), root, self._beside())
        rest = self._own_lines(len(self._lines))
        if isinstance(root, Collection) and not root.flow:
            root.below += rest
        elif any(rest):
            raise UnusualError("comments follow a value in braces")
        if self._comments:
            raise UnusualError("a comment is where it cannot be")
        return tree

    def _head(self, start: yaml.DocumentStartEvent, line: int) -> list[str]:
        """Return what is before the line of the first value."""
        if not start.explicit:
            return self._own_lines(line)
        mark = _start(start)[0]
        if mark == line or self._lines[mark].strip() != "---":
            raise UnusualError("a value or a comment is behind the mark of a document")
        above, self._last = self._own_lines(mark), mark
        return [*above, "---", *self._own_lines(line)]

    def _next(self) -> yaml.Event:
        self._at += 1
        return self._events[self._at - 1]

    def _value(self, parent: int) -> Value:
        """Read the next value; ``parent`` is the column that a block scalar is indented against."""
        event = self._next()
        if isinstance(event, yaml.CollectionStartEvent):
            anchor = f"&{event.anchor} " if event.anchor else ""
            if event.flow_style:
                return self._flow(event, anchor)
            return self._block(event, anchor, parent)
        return self._scalar(event, parent)

    def _scalar(self, event: yaml.Event, parent: int) -> Scalar:
        line, column = _start(event)
        end, end_column = _end(event)
        if isinstance(event, yaml.ScalarEvent) and event.style in ("|", ">"):
            return self._block_scalar(line, column, end, parent)
        if isinstance(event, yaml.ScalarEvent) and not event.style and not event.value and not event.anchor:
            self._last = max(self._last, min(line, last_written(self._lines, line, column)[0]))
            return Scalar(("",))
        end, end_column = last_written(self._lines, end, end_column)
        self._last = end
        if line == end:
            return Scalar((self._lines[line][column:end_column],))
        between = (text.strip() for text in self._lines[line + 1 : end])
        return Scalar((self._lines[line][column:].rstrip(), *between, self._lines[end][:end_column].strip()))

    def _block_scalar(self, line: int, column: int, end: int, parent: int) -> Scalar:
        comment = self._comments.get(line)
        header = self._lines[line][column : comment.column if comment else None].rstrip()
        content = self._lines[line + 1 : end]
        while content and not content[-1].strip() and not _KEEPS_ALL.search(header):
            content.pop()
        self._last = line + len(content)
        if comment is not None:
            # As behind any other value, once its last line is passed.
            self._comments[self._last] = self._comments.pop(line)
        return Scalar((header,), tuple(content), parent)

    def _block(self, start: yaml.CollectionStartEvent, anchor: str, parent: int) -> Collection:
        column = _start(self._events[self._at])[1] if isinstance(start, yaml.MappingStartEvent) else _start(start)[1]
        collection = Collection(isinstance(start, yaml.MappingStartEvent), anchor)
        if not collection.is_mapping and anchor:
            column = len(self._lines[_start(self._events[self._at])[0]].split("-", 1)[0])
        while not isinstance(self._events[self._at], yaml.CollectionEndEvent):
            self._entry(collection, column)
        self._next()
        # A list may stand as deep as the key above it: what is no deeper may belong to the next key.
        self._take_below(collection, max(column, parent + 1))
        return collection

    def _entry(self, made: Collection, column: int) -> None:
        event = self._events[self._at]
        line = _start(event)[0] if made.is_mapping else self._dash(_start(event)[0], column)
        entry = Entry(None, Scalar(("",)), self._own_lines(line))
        if made.is_mapping:
            entry.key = self._key()
        self._last = line
        after = _start(self._events[self._at])[0]
        is_block = _is_block(self._events[self._at])
        entry.broken = after > line and not _is_empty(self._events[self._at])
        if entry.broken or (is_block and made.is_mapping):
            entry.beside = self._comments.pop(line, None)
        if entry.broken and not is_block:
            entry.above += [text for text in self._own_lines(after) if text]
        entry.value = self._value(column)
        behind = self._beside() if not is_block else None
        if behind is not None and entry.beside is not None:
            entry.above.append(entry.beside.text)
        if behind is not None:
            entry.beside, entry.broken = behind, is_block
        made.entries.append(entry)

    def _dash(self, line: int, column: int) -> int:
        """Return the line of the dash before a value that may begin below it."""
        while self._lines[line][column : column + 1] != "-":
            line -= 1
            if line <= self._last - 1 or line < 0:
                raise UnusualError("the dash of an item is not found")
        return line

    def _key(self) -> str:
        event = self._next()
        (line, column), (end, end_column) = _start(event), _end(event)
        before = self._lines[line][:column].rstrip()
        if not isinstance(event, yaml.ScalarEvent) or end != line or before.endswith("?") or event.anchor:
            raise UnusualError("a key is not plain text")
        return self._lines[line][column:end_column]

    def _flow(self, start: yaml.CollectionStartEvent, anchor: str) -> Collection:
        line, column = _start(start)
        is_mapping = isinstance(start, yaml.MappingStartEvent)
        collection = Collection(is_mapping, anchor, flow=True)
        collection.bare = is_mapping and self._lines[line][column : column + 1] not in ("{", "&")
        self._last = max(line, self._last)
        while not isinstance(self._events[self._at], yaml.CollectionEndEvent):
            self._flow_entry(collection)
        end = _end(self._next())[0]
        if not collection.bare:
            rest = self._comments_before(collection, end)
            collection.below += rest
            self._last = end
        return collection

    def _flow_entry(self, made: Collection) -> None:
        line, last = _start(self._events[self._at])[0], self._last
        entry = Entry(None, Scalar(("",)), self._comments_before(made, line), opens=line > last)
        if made.is_mapping:
            entry.key = self._key()
            if not _is_empty(self._events[self._at]):
                entry.above += self._comments_before(None, _start(self._events[self._at])[0])
        entry.value = self._value(0)
        if isinstance(entry.value, Collection) and entry.value.bare:
            # A pair without braces of its own has no line of its own either.
            entry.above += entry.value.entries[0].above
            entry.value.entries[0].above = []
        made.entries.append(entry)

    def _comments_before(self, made: Collection | None, line: int) -> list[str]:
        """Take the comments before a line within braces; one behind an entry goes to that entry."""
        taken = []
        for number in range(max(self._last, 0), line):
            comment = self._comments.pop(number, None)
            if comment is None:
                continue
            last = made.entries[-1] if made is not None and made.entries else None
            if last is not None and number == self._last and last.beside is None:
                last.beside = comment
            else:
                taken.append(comment.text)
        self._last = max(self._last, line)
        return taken

    def _beside(self) -> Comment | None:
        return self._comments.pop(self._last, None)

    def _own_lines(self, until: int) -> list[str]:
        """Take the comments between the last value and a line, with an empty line as "" where there is one."""
        taken = list(self._own(self._last + 1, until))
        self._last = max(self._last, until - 1)
        return _squeezed(taken)

    def _own(self, first: int, until: int) -> Iterator[str]:
        for number in range(first, until):
            comment = self._comments.pop(number, None)
            if comment is not None:
                yield comment.text
            elif not self._lines[number].strip():
                yield ""

    def _take_below(self, made: Collection, column: int) -> None:
        """Take the comments after a collection that stand as deep as it does."""
        following = self._at
        while following < len(self._events) and isinstance(self._events[following], yaml.CollectionEndEvent):
            following += 1
        until = len(self._lines) if following == len(self._events) else _start(self._events[following])[0]
        numbers = [number for number in range(self._last + 1, until) if number in self._comments]
        deep = 0
        while deep < len(numbers) and self._comments[numbers[deep]].column >= column:
            deep += 1
        if deep:
            made.below += self._own_lines(numbers[deep - 1] + 1)


def _squeezed(lines: list[str]) -> list[str]:
    """Leave one of several empty lines."""
    return [line for number, line in enumerate(lines) if line or number == 0 or lines[number - 1]]


def _is_block(event: yaml.Event) -> bool:
    return isinstance(event, yaml.CollectionStartEvent) and not event.flow_style


def _is_empty(event: yaml.Event) -> bool:
    return isinstance(event, yaml.ScalarEvent) and not (event.value or event.style or event.anchor)


def _start(event: yaml.Event) -> tuple[int, int]:
    assert event.start_mark is not None  # every event that comes from a parser has both marks
    return event.start_mark.line, event.start_mark.column


def _end(event: yaml.Event) -> tuple[int, int]:
    assert event.end_mark is not None
    return event.end_mark.line, event.end_mark.column
