"""Noise of a measured position: bounded, drawn from a seed, and the same however cycles are grouped into blocks."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass

import numpy as np

from cellc.mock.control.interfaces import Array

# Steps and multipliers of SplitMix64 (Steele, Lea, Flood: Fast Splittable Pseudorandom Number Generators, 2014), whose
# n-th value needs none of those before it.
_STEP = np.uint64(0x9E3779B97F4A7C15)
_MIX = (np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB))


@dataclass(frozen=True, slots=True)
class Noise:
    """Evenly distributed noise of one joint.

    Attributes:
        amplitude: rad or m; no value is farther from zero.
        key: of the sequence.
    """

    amplitude: float
    key: int

    @classmethod
    def of_joint(cls, joint: str, amplitude: float, seed: int) -> Noise:
        """Return the noise of a joint in a run with a seed."""
        digest = hashlib.sha256(f"{seed}/{joint}".encode()).digest()
        return cls(amplitude, int.from_bytes(digest[:8], "big"))

    def values(self, first: int, count: int) -> Array:
        """Return the values of ``count`` update cycles, of which ``first`` is the number of the first one."""
        state = (np.arange(first + 1, first + count + 1, dtype=np.uint64) * _STEP) + np.uint64(self.key)
        state = (state ^ (state >> np.uint64(30))) * _MIX[0]
        state = (state ^ (state >> np.uint64(27))) * _MIX[1]
        state ^= state >> np.uint64(31)
        unit: Array = (state >> np.uint64(11)).astype(np.float64) * 2.0**-53
        return (2.0 * unit - 1.0) * self.amplitude
