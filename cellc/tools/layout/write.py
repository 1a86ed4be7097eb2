"""From the tree of what is written to the canonical text.

Two spaces a level, lists indented below their key, at most one empty line. What is in braces takes one line where
it fits; else its author's lines stay, aligned behind the brace, or it takes as few as it needs where one is too long. A
comment beside a value stays in its column where it can.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.tools.layout.tree import Collection, Comment, Entry, Scalar, Value, Written

WIDTH = 120
_STEP = 2
_GAP = 2
_DEEP = 40
"""A brace that would stand deeper, with lines below it, begins a line of its own."""


def write_written(written: Written) -> str:
    """Return the text of a whole file."""
    lines = [*written.head, *_root(written)]
    while lines and not lines[0]:
        del lines[0]
    while lines and not lines[-1] and not _ends_in_block(written.root):
        del lines[-1]
    return "\n".join(lines) + "\n"


def _ends_in_block(value: Value) -> bool:
    while isinstance(value, Collection):
        if value.flow or value.below or not value.entries:
            return False
        value = value.entries[-1].value
    return value.block is not None


def _root(written: Written) -> Iterator[str]:
    root = written.root
    if isinstance(root, Collection) and not root.flow:
        yield from ([root.anchor.rstrip()] if root.anchor else [])
        yield from _block(root, 0)
        return
    lines = _value_lines(root, 0, 0, 0)
    yield from _with_comment(lines, written.beside)
    if isinstance(root, Collection):
        yield from (root.below if root.flow and not root.entries else [])


def _block(value: Collection, depth: int) -> Iterator[str]:
    pad = " " * depth
    for entry in value.entries:
        yield from _indented(entry.above, pad)
        yield from _key_entry(entry, depth) if value.is_mapping else _item(entry, depth)
    yield from _indented(value.below, pad)


def _key_entry(entry: Entry, depth: int) -> Iterator[str]:
    value, pad = entry.value, " " * depth
    name = f"{pad}{entry.key}:"
    if isinstance(value, Scalar):
        first, *others = _scalar(value, depth)
        yield from _beside_scalar(value, [f"{name} {first}".rstrip(), *others], entry.beside)
    elif not value.flow:
        yield _commented(f"{name} {value.anchor}".rstrip(), entry.beside)
        yield from _block(value, depth + _STEP)
    else:
        yield from _flow_entry(entry, value, name, depth)


def _flow_entry(entry: Entry, value: Collection, name: str, depth: int) -> Iterator[str]:
    whole = _inline(value)
    # What is said of the key, where the value begins below it, is not said of the end of the value.
    is_apart = entry.broken and entry.beside is not None
    fits = whole is not None and len(name) + 1 + len(whole) <= WIDTH and not is_apart
    if fits or not (entry.broken or len(name) + 1 > _DEEP):
        first, *others = _value_lines(value, len(name) + 1, 0, depth)
        yield from _with_comment([f"{name} {first}", *others], entry.beside)
        return
    below = depth + _STEP
    first, *others = _value_lines(value, below, 0, depth)
    yield _commented(name, entry.beside if entry.broken else None)
    yield from _with_comment([" " * below + first, *others], None if entry.broken else entry.beside)


def _item(entry: Entry, depth: int) -> Iterator[str]:
    value, pad = entry.value, " " * depth
    if isinstance(value, Scalar):
        first, *others = _scalar(value, depth)
        yield from _beside_scalar(value, [f"{pad}- {first}".rstrip(), *others], entry.beside)
    elif value.flow:
        first, *others = _value_lines(value, depth + _STEP, 0, depth)
        yield from _with_comment([f"{pad}- {first}", *others], entry.beside)
    elif value.anchor or entry.beside or value.entries[0].above:
        yield _commented(f"{pad}- {value.anchor}".rstrip(), entry.beside)
        yield from _block(value, depth + _STEP)
    else:
        first, *others = _block(value, depth + _STEP)
        yield f"{pad}- {first.lstrip()}"
        yield from others


def _scalar(value: Scalar, depth: int) -> list[str]:
    """Return the lines of a scalar, the first without indentation."""
    if value.block is not None:
        return [value.lines[0], *_moved(value.block, depth - value.depth)]
    pad = " " * (depth + _STEP)
    return [value.lines[0], *(f"{pad}{line}" if line else "" for line in value.lines[1:])]


def _moved(block: tuple[str, ...], by: int) -> Iterator[str]:
    for line in block:
        if by >= 0:
            yield " " * by + line if line.strip() else line
        else:
            yield line[min(-by, len(line) - len(line.lstrip(" "))) :]


def _value_lines(value: Value, column: int, tail: int, depth: int, *, keep: bool | None = None) -> list[str]:
    """Return the lines of a value that begins in a column; the first without indentation, the others with theirs.

    Args:
        tail: number of characters that follow the last line.
        depth: of the entry, for scalars of several lines.
        keep: whether lines within braces are those of their author; so where none is too long, if None.
    """
    if isinstance(value, Scalar):
        return _scalar(value, depth)
    whole = _inline(value)
    if whole is not None and _fits(whole, column, tail):
        return [whole]
    lines = _Lines(value, column, tail, keep=keep is not False).made()
    too_long = any(len(line) + (0 if number else column) > WIDTH for number, line in enumerate(lines))
    return _Lines(value, column, tail, keep=False).made() if keep is None and too_long else lines


class _Lines:
    """The lines of what is in braces, and the one that is being written.

    Args:
        keep: whether a line begins where it did, not where the last one is full.
    """

    def __init__(self, value: Collection, column: int, tail: int, *, keep: bool) -> None:
        self._opening, self._closing = _marks(value)
        self._value, self._tail, self._keep = value, tail, keep
        self._start = column + len(value.anchor) + len(self._opening)
        self._lines: list[str] = []
        self._current = value.anchor + self._opening
        self._lead = column
        """The column in which the current line begins."""
        self._is_fresh = True

    def made(self) -> list[str]:
        """Return them all."""
        entries = self._value.entries
        for number, entry in enumerate(entries):
            self._put(entry, is_last=number == len(entries) - 1)
        if self._value.below:
            self._break(self._value.below)
        if not self._current.strip():
            self._current = " " * (self._start - len(self._opening))
        return [*self._lines, self._current + self._closing]

    def _break(self, above: list[str]) -> None:
        if self._current.strip():
            self._lines.append(self._current)
        self._lines += [" " * self._start + text for text in above]
        self._current, self._lead, self._is_fresh = " " * self._start, 0, True

    def _put(self, entry: Entry, *, is_last: bool) -> None:
        behind = 1 if not is_last else 0 if self._value.below else len(self._closing) + self._tail
        piece = _inline_entry(entry)
        if entry.above or not (self._is_fresh or self._goes_on(entry, piece, behind)):
            self._break(entry.above)
        used = self._lead + len(self._current) + (0 if self._is_fresh else 1)
        fits = piece is not None and _fits(piece, used, behind)
        first, *others = [piece] if piece is not None and fits else self._several(entry, used, behind)
        self._current += first if self._is_fresh else f" {first}"
        self._is_fresh = False
        if others:
            self._lines += [self._current, *others[:-1]]
            self._current, self._lead = others[-1], 0
        self._current += "" if is_last else ","
        if entry.beside is not None:
            self._lines.append(_commented(self._current, entry.beside, self._lead))
            self._current, self._lead, self._is_fresh = " " * self._start, 0, True

    def _several(self, entry: Entry, used: int, behind: int) -> list[str]:
        """Return the lines of an entry that does not fit on one."""
        name = "" if entry.key is None else f"{entry.key}: "
        first, *others = _value_lines(entry.value, used + len(name), behind, self._start, keep=self._keep)
        return [f"{name}{first}", *others]

    def _goes_on(self, entry: Entry, piece: str | None, behind: int) -> bool:
        """Whether an entry is on the line of the one before it."""
        if self._keep:
            return not entry.opens
        return piece is not None and _fits(piece, self._lead + len(self._current) + 1, behind)


def _fits(piece: str, used: int, behind: int) -> bool:
    return used + len(piece) + behind <= WIDTH


def _marks(value: Collection) -> tuple[str, str]:
    if value.bare:
        return "", ""
    return ("{", "}") if value.is_mapping else ("[", "]")


def _inline(value: Value) -> str | None:
    """Return a value on one line; None where a comment or a line break of its own forbids it."""
    if isinstance(value, Scalar):
        return value.lines[0] if len(value.lines) == 1 and value.block is None else None
    pieces = [_inline_entry(entry) for entry in value.entries]
    if value.below or any(piece is None or entry.beside for piece, entry in zip(pieces, value.entries, strict=True)):
        return None
    opening, closing = _marks(value)
    return f"{value.anchor}{opening}{', '.join(piece for piece in pieces if piece is not None)}{closing}"


def _inline_entry(entry: Entry) -> str | None:
    value = None if entry.above else _inline(entry.value)
    return value if value is None or entry.key is None else f"{entry.key}: {value}"


def _beside_scalar(value: Scalar, lines: list[str], comment: Comment | None) -> list[str]:
    """Put the comment of a block behind its header: its last line is text."""
    if value.block is None:
        return _with_comment(lines, comment)
    return [_commented(lines[0], comment), *lines[1:]]


def _with_comment(lines: list[str], comment: Comment | None) -> list[str]:
    return [*lines[:-1], _commented(lines[-1], comment)]


def _commented(line: str, comment: Comment | None, lead: int = 0) -> str:
    if comment is None:
        return line
    gap = 1 if line.endswith("-") else _GAP
    return line.ljust(max(comment.column - lead, len(line) + gap)) + comment.text


def _indented(lines: list[str], pad: str) -> Iterator[str]:
    yield from (f"{pad}{line}" if line else "" for line in lines)
