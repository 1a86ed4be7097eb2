"""The Common Data Representation of ROS 2 messages: OMG CDR, little endian, as every RMW puts it on the wire.

Written here because it is small, and because messages of one shape can then be made by the thousand as rows of an array
(`MessageRows`); the tests compare the bytes with those of an independent implementation.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from cellc.contract.frozen import dataclass

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

    def octets(self, values: bytes) -> None:
        """Write a sequence of bytes."""
        self.uint32(len(values))
        self._bytes += values

    def fixed_float64s(self, values: Iterable[float]) -> None:
        """Write float64 fields one after the other."""
        for value in values:
            self.float64(value)

    def time(self, stamp_ns: int) -> int:
        """Write a builtin_interfaces/Time or Duration; return its offset in the message."""
        self.int32(stamp_ns // _NANOSECONDS)
        self.uint32(stamp_ns % _NANOSECONDS)
        return len(self._bytes) - 8


@dataclass(frozen=True, slots=True)
class MessageRows:
    """Encodes messages that differ in their stamp and in sequences of float64 of fixed length.

    Attributes:
        template: one encoded message.
        stamp_at: offset of its stamp, sec and nanosec.
        numbers_at: offset of the first element of each sequence.
    """

    template: bytes
    stamp_at: int
    numbers_at: tuple[int, ...]

    def encode(self, stamps_ns: NDArray[np.int64], numbers: Sequence[NDArray[np.float64]]) -> list[bytes]:
        """Return one message a stamp; ``numbers`` has one array of shape (messages, length) a sequence."""
        rows = np.tile(np.frombuffer(self.template, dtype=np.uint8), (len(stamps_ns), 1))
        seconds = (stamps_ns // _NANOSECONDS).astype("<i4")
        nanoseconds = (stamps_ns % _NANOSECONDS).astype("<u4")
        self._put(rows, self.stamp_at, seconds.view(np.uint8).reshape(-1, 4))
        self._put(rows, self.stamp_at + 4, nanoseconds.view(np.uint8).reshape(-1, 4))
        for offset, values in zip(self.numbers_at, numbers, strict=True):
            if values.shape[1]:
                packed = np.ascontiguousarray(values, dtype="<f8")
                self._put(rows, offset, packed.view(np.uint8).reshape(len(rows), -1))
        return [row.tobytes() for row in rows]

    @staticmethod
    def _put(rows: NDArray[np.uint8], offset: int, packed: NDArray[np.uint8]) -> None:
        rows[:, offset : offset + packed.shape[1]] = packed
