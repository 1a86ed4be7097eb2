"""Messages of one shape, made by the hundred: a template, and the places in it that differ."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_NANOSECONDS = 1_000_000_000


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
