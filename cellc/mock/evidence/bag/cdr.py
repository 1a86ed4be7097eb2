"""The Common Data Representation of ROS 2 messages: OMG CDR, little endian, as every RMW puts it on the wire.

Written here because it is small, and because messages of one shape can then be made by the thousand as rows of an array
(`rows`); the tests compare the bytes with those of an independent implementation.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Sequence

_HEADER = b"\x00\x01\x00\x00"
"""Representation identifier CDR_LE and no options (RTPS 2.5, table 10.3)."""
_NANOSECONDS = 1_000_000_000


class CdrWriter:
    """Appends values to one message; each is aligned to its own size, counted from the end of the header."""

    def __init__(self) -> None:
        self._bytes = bytearray(_HEADER)

    def message(self) -> bytes:
        """Return the message as written so far."""
        return bytes(self._bytes)

    def _align(self, size: int) -> None:
        self._bytes += b"\x00" * (-(len(self._bytes) - len(_HEADER)) % size)

    def octet(self, value: int) -> None:
        """Write a byte, uint8 or bool."""
        self._bytes.append(value)

    def int32(self, value: int) -> None:
        """Write an int32."""
        self._align(4)
        self._bytes += struct.pack("<i", value)

    def uint32(self, value: int) -> None:
        """Write a uint32, or the length of a sequence."""
        self._align(4)
        self._bytes += struct.pack("<I", value)

    def float64(self, value: float) -> int:
        """Write a float64; return its offset in the message."""
        self._align(8)
        self._bytes += struct.pack("<d", value)
        return len(self._bytes) - 8

    def string(self, text: str) -> None:
        """Write a string: its length with the closing zero, then UTF-8."""
        encoded = text.encode()
        self.uint32(len(encoded) + 1)
        self._bytes += encoded + b"\x00"

    def strings(self, texts: Sequence[str]) -> None:
        """Write a sequence of strings."""
        self.uint32(len(texts))
        for text in texts:
            self.string(text)

    def float64s(self, values: Sequence[float]) -> int:
        """Write a sequence of float64; return the offset of its first element, 0 where it has none."""
        self.uint32(len(values))
        offsets = [self.float64(value) for value in values]
        return offsets[0] if offsets else 0

    def fixed_float64s(self, values: Iterable[float]) -> None:
        """Write float64 fields one after the other."""
        for value in values:
            self.float64(value)

    def time(self, stamp_ns: int) -> int:
        """Write a builtin_interfaces/Time or Duration; return its offset in the message."""
        self.int32(stamp_ns // _NANOSECONDS)
        self.uint32(stamp_ns % _NANOSECONDS)
        return len(self._bytes) - 8
