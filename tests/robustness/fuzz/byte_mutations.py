"""Changes of a file's bytes: what editors, transfers and encodings do to it."""

from __future__ import annotations

import random
from collections.abc import Callable

_PIECES = (
    b"\x00", b"\xff\xfe", b"\xfe\xff", b"\xef\xbb\xbf", b"\xc0\x80", b"\xed\xa0\x80", b"\x80", b"\xf4\x90\x80\x80",
    b"\xe2\x80\xae", b"\xc2\x9b", b"\xc2\x85", b"\xe2\x80\xa8", b"\t", b"\r", b"\r\n", b"\x0c", b"\x1b[2J", b":",
    b": ", b"{", b"}", b"[", b"]", b",", b"&a ", b"*a", b"#", b"|\n", b">-\n", b"? ", b"- ", b"---\n", b"...\n",
    b"%YAML 9.9\n", b"!!x ", b"<<: ", b"'", b'"', b"\\", b"`", b"@", b"<", b">", b"&", b"&x;", b"<!--", b"-->",
    b"]]>", b"<?x?>", b"${", b"$(", b"0", b"e999",
)  # fmt: skip


def mutate_bytes(data: bytes, chance: random.Random) -> bytes:
    """Return the file changed once."""
    return chance.choice(_CHANGES)(data, chance)


def _cut(data: bytes, chance: random.Random) -> bytes:
    return data[: chance.randrange(len(data) + 1)]


def _range_out(data: bytes, chance: random.Random) -> bytes:
    place = chance.randrange(len(data) + 1)
    return data[:place] + data[place + chance.choice((1, 2, 5, 40, 400)) :]


def _range_doubled(data: bytes, chance: random.Random) -> bytes:
    place = chance.randrange(len(data) + 1)
    return data[: place + chance.choice((1, 8, 60, 600))] + data[place:]


def _piece_in(data: bytes, chance: random.Random) -> bytes:
    place = chance.randrange(len(data) + 1)
    return data[:place] + chance.choice(_PIECES) * chance.choice((1, 1, 1, 2, 70)) + data[place:]


def _noise(data: bytes, chance: random.Random) -> bytes:
    if not data:
        return bytes(chance.randrange(256) for _ in range(16))
    changed = bytearray(data)
    for _ in range(chance.choice((1, 1, 2, 8))):
        changed[chance.randrange(len(changed))] = chance.randrange(256)
    return bytes(changed)


def _line_moved(data: bytes, chance: random.Random) -> bytes:
    lines = data.splitlines(keepends=True) or [b""]
    line = lines.pop(chance.randrange(len(lines)))
    for _ in range(chance.choice((0, 1, 2))):
        lines.insert(chance.randrange(len(lines) + 1), line)
    return b"".join(lines)


def _indented(data: bytes, chance: random.Random) -> bytes:
    lines = data.splitlines(keepends=True) or [b""]
    place = chance.randrange(len(lines))
    lines[place] = chance.choice((b" ", b"  ", b"    ", b"\t")) + lines[place]
    return b"".join(lines)


def _line_ends(data: bytes, chance: random.Random) -> bytes:
    ends = (b"\n", b"\r\n", b"\r", b"\x0b", b"\xc2\x85", b"\xe2\x80\xa8", b"\n\n")
    mixed = chance.random() < 0.5
    end = chance.choice(ends)
    return b"".join(line + (chance.choice(ends) if mixed else end) for line in data.splitlines())


def _encoded(data: bytes, chance: random.Random) -> bytes:
    text = data.decode("utf-8", "replace")
    codec = chance.choice(("utf-8-sig", "utf-16", "utf-16-le", "utf-32", "latin-1", "utf-7", "cp037"))
    return text.encode(codec, "replace")


def _empty(data: bytes, chance: random.Random) -> bytes:
    return chance.choice(
        (b"", b"\n", b" ", b"\xef\xbb\xbf", b"null", b"~", b"[]", b"{}", b"0", b"#", b"---", b'""', b"\x00" * 100)
    )


def _grown(data: bytes, chance: random.Random) -> bytes:
    piece = chance.choice((b" ", b"\n", b"#", b"a", b"[", b"- ", b"{a: ", b"<a>", b"\t", b"!", b"&a ", b"* "))
    end = piece * chance.choice((100, 2000, 50_000))
    return end + data if chance.random() < 0.3 else data + end


_CHANGES: tuple[Callable[[bytes, random.Random], bytes], ...] = (
    _cut, _range_out, _range_doubled, _piece_in, _piece_in, _piece_in, _noise, _line_moved, _indented, _line_ends,
    _encoded, _empty, _grown,
)  # fmt: skip
