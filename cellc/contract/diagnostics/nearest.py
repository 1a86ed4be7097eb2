"""Existing names that a misspelled one may have meant."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from heapq import nsmallest
from itertools import takewhile

_COMPARED = 128
"""Most candidates that one name is compared with."""
_LONGEST = 200
"""Longest text that is compared at all."""
_SHOWN = 12
_SEPARATORS = str.maketrans("", "", "-_ ")


class Advice(str):
    """A help that says what may stand in the place of a text; to all else it is its words.

    Attributes:
        written: what is there; empty where it is not known.
        instead: what it may become, the nearest first.
        is_near: whether the first is near enough to be what was meant; else each is one of the few that exist.
    """

    __slots__ = ("instead", "is_near", "written")
    written: str
    instead: tuple[str, ...]
    is_near: bool

    def __new__(cls, text: str, written: str = "", instead: Iterable[str] = (), *, is_near: bool = True) -> Advice:
        advice = super().__new__(cls, text)
        advice.written, advice.instead, advice.is_near = written, tuple(dict.fromkeys(instead)), is_near
        return advice

    def and_more(self, text: str) -> Advice:
        """Return the same with further words."""
        return Advice(f"{self}{text}", self.written, self.instead, is_near=self.is_near)

    def without(self, texts: Iterable[str]) -> Advice:
        """Return the same words, with less that may be put in the place."""
        left = set(texts)
        instead = (text for text in self.instead if text not in left)
        return Advice(str(self), self.written, instead, is_near=self.is_near)


def nearest(name: str, candidates: Iterable[str], limit: int = 3) -> tuple[str, ...]:
    """Return up to ``limit`` candidates that look like ``name``, best first, ties in alphabetical order.

    Of very many candidates those of its length are compared, and a text as long as no name is compared with none: a
    untrusted file may hold thousands of both.
    """
    if len(name) > _LONGEST:
        return ()
    known = sorted({candidate for candidate in candidates if len(candidate) <= _LONGEST})
    lowered = {candidate.lower(): candidate for candidate in reversed(known)}
    compared = sorted(lowered)
    if len(compared) > _COMPARED:
        compared = sorted(nsmallest(_COMPARED, compared, key=lambda one: abs(len(one) - len(name))))
    matches = get_close_matches(name.lower(), compared, n=limit, cutoff=0.6)
    return tuple(lowered[match] for match in matches)


def did_you_mean(name: str, candidates: Iterable[str], kind: str) -> Advice:
    """Write the help for an unknown name: the nearest that exist, or all of them where few exist.

    Args:
        kind: plural noun for what the candidates are, such as ``links of `arm```.
    """
    known = sorted(set(candidates))
    close = nearest(name, known)
    if close:
        return meant(name, close)
    if not known:
        return Advice(f"there are no {kind}")
    shown = ", ".join(f"`{candidate}`" for candidate in known[:_SHOWN])
    more = f" and {len(known) - _SHOWN} more" if len(known) > _SHOWN else ""
    return Advice(f"use one of the {kind}: {shown}{more}", name, known[:_SHOWN], is_near=False)


def meant(name: str, close: Sequence[str]) -> Advice:
    """Write the help for a text with others that are near to it, the nearest first."""
    return Advice("did you mean " + " or ".join(f"`{match}`" for match in close) + "?", name, close)


def write(text: str, written: str, more: str = "") -> Advice:
    """Write the help of a text that must be another one."""
    return Advice(f"write `{text}`{more}", written, (text,))


def only_nearest(name: str, candidates: Iterable[str]) -> str | None:
    """Return the one candidate that `did_you_mean` suggests, or the one of several that is one slip away."""
    close = nearest(name, candidates)
    slips = [candidate for candidate in close if is_slip(name, candidate)]
    those = slips if len(close) > 1 else close
    return those[0] if len(those) == 1 else None


def is_slip(key: str, meant: str) -> bool:
    """Whether one slip of the fingers lies between two names; a suggestion may be further, but a person reads that.

    A slip is one character too many, too few, wrong, or swapped with its neighbor; or another way to join words.
    """
    if key.lower().translate(_SEPARATORS) == meant.lower().translate(_SEPARATORS):
        return True
    start = _common_start(key, meant)
    end = _common_start(key[start:][::-1], meant[start:][::-1])
    ours, theirs = key[start : len(key) - end], meant[start : len(meant) - end]
    return max(len(ours), len(theirs)) == 1 or (len(ours) == len(theirs) == 2 and ours == theirs[::-1])


def _common_start(ours: str, theirs: str) -> int:
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(ours, theirs, strict=False)))
