"""What a run draws, by its number alone: any run can be made again without those before it.

The generator is counter-based, Philox4x64-10 (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011),
with seed and run as its key and a number of the quantity's name as its counter. So a quantity that is added changes no
other one, and two sweeps of one seed differ by what was changed alone. The raw 64 bits are the same in every numpy,
which is not promised of its distributions (NEP 19), so these are inverted here.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping, Sequence
from functools import lru_cache
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from cellc.contract.transforms import Pose, Vector3, identity
from cellc.contract.uncertainty import UncertainQuantity
from cellc.mock.reality import Displacement, OtherPart, Reality

Bits = NDArray[np.uint64]
_ROUNDS = 10
_MULTIPLIERS = (np.uint64(0xD2E7470EE14C6C93), np.uint64(0xCA5A826395121157))
_WEYL = (np.uint64(0x9E3779B97F4A7C15), np.uint64(0xBB67AE8584CAA73B))
_TOGETHER = 1 << 14
_NORMAL = NormalDist()
_NOISE = "noise of samples"
LINKS = ("calibration", "repeatability", "place")
"""Kinds of quantities that displace a frame of the description, one after the other where they have the same."""


class _Bits:
    """The generator of one run: 64 bits by a name, whatever was asked before."""

    def __init__(self, seed: int, run: int) -> None:
        self._philox = np.random.Philox(key=(run << 64) | seed)
        self._fresh = self._philox.state

    def of(self, name: str) -> int:
        """Return the bits of a name."""
        self._philox.state = {**self._fresh, "state": {**self._fresh["state"], "counter": _counter(name)}}
        return int(self._philox.random_raw())


@lru_cache(maxsize=4096)
def _counter(name: str) -> Bits:
    """Return a number of a name, in the lower three quarters of a counter."""
    return np.frombuffer(hashlib.sha256(name.encode()).digest()[:24] + bytes(8), dtype="<u8").astype(np.uint64)


def draw(quantities: Sequence[UncertainQuantity], seed: int, run: int) -> dict[str, float]:
    """Return the values of a run by the names of the quantities, SI, about zero."""
    bits = _Bits(seed, run)
    return {quantity.name: _spread(quantity, (bits.of(quantity.name) >> 11) + 0.5) for quantity in quantities}


def draw_all(quantities: Sequence[UncertainQuantity], seed: int, numbers: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return what ``draw`` does for each of many runs, to the last bit: quantities in rows, runs in columns."""
    values = np.empty((len(quantities), len(numbers)))
    for start in range(0, len(numbers), _TOGETHER):
        runs = numbers[start : start + _TOGETHER].astype(np.uint64)
        for row, quantity in zip(values, quantities, strict=True):
            bits = (_philox(_counter(quantity.name), seed, runs) >> np.uint64(11)).tolist()
            row[start : start + len(runs)] = [_spread(quantity, number + 0.5) for number in bits]
    return values


def _philox(counter: Bits, seed: int, runs: Bits) -> Bits:
    """Return the first 64 bits behind a counter for each key (seed, run), by the definition of Philox4x64-10."""
    first, second, third, fourth = (np.full(len(runs), word) for word in counter)
    first += np.uint64(1)  # a generator steps before it gives
    low, high = np.full(len(runs), seed, np.uint64), runs.copy()
    for _ in range(_ROUNDS):
        (over, first_product), (above, third_product) = (
            _product(_MULTIPLIERS[0], first),
            _product(_MULTIPLIERS[1], third),
        )
        first, second, third, fourth = above ^ second ^ low, third_product, over ^ fourth ^ high, first_product
        low += _WEYL[0]
        high += _WEYL[1]
    return first


def _product(factor: np.uint64, values: Bits) -> tuple[Bits, Bits]:
    """Return the upper and the lower 64 bits of the products."""
    half, mask = np.uint64(32), np.uint64(0xFFFFFFFF)
    low, high = factor & mask, factor >> half
    lower, upper = values & mask, values >> half
    crossed = lower * high + (lower * low >> half)
    crosswise = upper * low + (crossed & mask)
    return upper * high + (crossed >> half) + (crosswise >> half), values * factor


def _spread(one: UncertainQuantity, of_2_to_53: float) -> float:
    share = of_2_to_53 * 2.0**-53  # between 0 and 1, and neither
    return scale(one) * (2.0 * share - 1.0 if one.distribution == "uniform" else _NORMAL.inv_cdf(share))


def scale(one: UncertainQuantity) -> float:
    """Return the standard deviation of a quantity, or half the range of a uniform one."""
    return one.spread / math.sqrt(3.0) if one.distribution == "isotropic" else one.spread


def reality_of(quantities: Sequence[UncertainQuantity], values: Mapping[str, float], seed: int, run: int) -> Reality:
    """Return what is different in a run with these values."""
    parts: dict[tuple[str, str], dict[str, float]] = {}
    for quantity in quantities:
        axes = parts.setdefault((quantity.kind, quantity.target), {})
        axes[quantity.axis] = (
            axes.get(quantity.axis, 0.0) + values[quantity.name]
        )  # two devices that move one tip add up
    links: dict[str, Pose] = {}
    for kind in LINKS:
        for target, axes in _of(kind, parts):
            links[target] = links.get(target, identity()) @ Pose(_along(axes), _turn(axes))
    return Reality(
        links=links,
        objects={
            target: Displacement(_along(axes), Pose((0.0, 0.0, 0.0), _turn(axes)))
            for target, axes in _of("region", parts)
        },
        offsets_s={target: axes["offset"] for target, axes in _of("clock", parts)},
        part_more_kg={target: axes["mass"] for target, axes in _of("part", parts)},
        compensation={target: axes["share"] for target, axes in _of("compensation", parts)},
        tool_more_kg={target: axes["mass"] for target, axes in _of("payload", parts)},
        parts=_other_parts(dict(_of("mass", parts)), dict(_of("friction", parts))),
        noise=_Bits(seed, run).of(_NOISE) >> 32,
    )


def _other_parts(
    masses: Mapping[str, Mapping[str, float]], frictions: Mapping[str, Mapping[str, float]]
) -> dict[str, OtherPart]:
    nothing: Mapping[str, float] = {}
    return {
        name: OtherPart(masses.get(name, nothing).get("mass", 0.0), frictions.get(name, nothing).get("friction", 0.0))
        for name in dict.fromkeys((*masses, *frictions))
    }


def _of(kind: str, parts: Mapping[tuple[str, str], dict[str, float]]) -> list[tuple[str, dict[str, float]]]:
    return [(target, axes) for (of, target), axes in parts.items() if of == kind]


def _along(axes: Mapping[str, float]) -> Vector3:
    return axes.get("x", 0.0), axes.get("y", 0.0), axes.get("z", 0.0)


def _turn(axes: Mapping[str, float]) -> tuple[float, float, float, float]:
    """Return the turn whose rotation vector has these components, rad, as a quaternion x, y, z, w."""
    x, y, z = (axes.get(name, 0.0) for name in ("rx", "ry", "rz"))
    angle = math.sqrt(x * x + y * y + z * z)
    if angle == 0.0:
        return 0.0, 0.0, 0.0, 1.0
    share = math.sin(angle / 2.0) / angle
    return x * share, y * share, z * share, math.cos(angle / 2.0)
