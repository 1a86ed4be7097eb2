"""How hard bodies pressed on each other at most, and when: planned contacts too, as those of fingers and a part."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from cellc.mock.control.interfaces import Array, Times
from cellc.mock.result import Contact


class Contacts:
    """The largest force between each two bodies, over all their points of contact in one cycle."""

    def __init__(self, bodies: Sequence[str]) -> None:
        """Begin with none; ``bodies`` have their numbers by their place."""
        self._bodies = tuple(bodies)
        self._most: dict[int, tuple[float, int]] = {}

    def begin(self) -> None:
        """Forget what was so far: something begins that is looked at alone."""
        self._most.clear()

    def add(self, times_ns: Times, pressing: Sequence[tuple[NDArray[np.intp], Array]]) -> None:
        """Add what pressed on what in some cycles: numbers of two bodies in each contact, and its force in N."""
        lengths = [len(forces) for _, forces in pressing]
        if not any(lengths):
            return
        count = len(self._bodies)
        pairs = np.concatenate([rows for rows, _ in pressing])
        keys = pairs[:, 0] * count + pairs[:, 1]
        cycles = np.repeat(np.arange(len(lengths)), lengths)
        found, places = np.unique(keys + cycles * count**2, return_inverse=True)
        forces = np.bincount(places.ravel(), np.concatenate([forces for _, forces in pressing]))
        for key in np.unique(keys).tolist():
            of_pair = np.flatnonzero(found % count**2 == key)
            most = int(of_pair[forces[of_pair].argmax()])
            if forces[most] > self._most.get(key, (0.0, 0))[0]:
                self._most[key] = float(forces[most]), int(times_ns[int(found[most]) // count**2])

    def __iter__(self) -> Iterator[Contact]:
        """Yield what pressed on what, the hardest first."""
        found = [
            Contact(self._bodies[key // len(self._bodies)], self._bodies[key % len(self._bodies)], most_n, at_ns)
            for key, (most_n, at_ns) in self._most.items()
        ]
        yield from sorted(found, key=lambda each: (-each.most_n, each.one, each.other))
