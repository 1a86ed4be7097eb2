"""Which of many cases a session takes: a share of them, and with ``--long`` all."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterable
from typing import TypeVar

import pytest

_Case = TypeVar("_Case")


def sample(
    request: pytest.FixtureRequest, cases: Iterable[_Case], share: int, name: Callable[[_Case], str] = str
) -> list[_Case]:
    """Return one of so many cases, at least one, spread by their names and in their order.

    Args:
        request: of the test, whose ``--long`` takes all.
        cases: what could be tried.
        share: how many cases there are for each that is taken.
        name: what tells a case from the others, in every session the same.
    """
    every = list(cases)
    if request.config.option.long:
        return every
    ranked = sorted(range(len(every)), key=lambda place: (zlib.crc32(name(every[place]).encode()), place))
    return [every[place] for place in sorted(ranked[: -(-len(every) // share)])]
