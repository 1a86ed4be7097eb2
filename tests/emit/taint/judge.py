"""Whether artifacts with hostile texts say what those with harmless twins say, each text as it was written."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from tests.emit.taint.judges import Reading, readings, without_hashes
from tests.emit.taint.payloads import PLACEHOLDER

_SPACE = re.compile(r"\s+")
_END = re.compile(r"[\n\t\r]")
_MARK = re.compile(r"tq\d{4}q")


def differences(hostile: Mapping[str, str], twin: Mapping[str, str], texts: Mapping[str, str]) -> Iterator[str]:
    """Yield where a reader takes a hostile text for something else than text.

    Args:
        hostile: artifacts by path.
        twin: the same with harmless texts.
        texts: the hostile text in place of each harmless one.
    """
    if set(hostile) != set(twin):
        yield f"files: {sorted(set(hostile) ^ set(twin))}"
    change = Change(texts)
    for path in sorted(set(hostile) & set(twin)):
        try:
            found = readings(path, hostile[path])
        except Exception as error:  # whatever a foreign reader raises
            yield f"{path}: {type(error).__name__}: {error}"
            continue
        for reader, wanted in readings(path, twin[path]).items():
            yield from (
                f"{path} ({reader}): {one}"
                for one in _unlike(change, without_hashes(found[reader]), without_hashes(wanted), "")
            )


class Change:
    """Puts the hostile text in the place of each harmless one."""

    def __init__(self, texts: Mapping[str, str]) -> None:
        self._marked = {_MARK.findall(twin)[0]: (twin, text) for twin, text in texts.items()}
        # A parameter's name is nested at its dots, of which both twins have as many.
        self._parts = {
            part: other
            for twin, text in texts.items()
            for part, other in zip(twin.split("."), text.split("."), strict=True)
            if "." in twin and part != other
        }

    def expected(self, wanted: str) -> tuple[str, ...]:
        """Return what may stand in place of a text.

        Exactly so, with a space for each line end as in XML's attributes, on one line, without backticks, without
        spaces, or as a part between dots.
        """
        exact = attribute = lined = joined = split = wanted
        for part, other in self._parts.items():
            split = split.replace(part, other) if part in wanted else split
        for mark in dict.fromkeys(_MARK.findall(wanted)):
            for twin, text in self._pairs(mark, wanted):
                exact = exact.replace(twin, text)
                attribute = attribute.replace(_END.sub(" ", twin), _END.sub(" ", text))
                lined = _SPACE.sub(" ", lined).replace(_line(twin), _line(text))
                joined = _SPACE.sub("", joined).replace(_SPACE.sub("", twin), _SPACE.sub("", text))
        return exact, attribute, lined, lined.replace("`", ""), joined, split

    def _pairs(self, mark: str, wanted: str) -> Iterator[tuple[str, str]]:
        """Yield the whole text, and what is from its mark on: what stood there before may be split off."""
        if mark in self._marked:
            twin, text = self._marked[mark]
            for one, other in ((twin, text), (twin[twin.index(mark) :], text[text.index(mark) :])):
                yield one, other
                filled = re.search(re.escape(one).replace(re.escape(PLACEHOLDER), r"(\w+)"), wanted)
                if filled is not None and filled.groups():
                    yield filled[0], other.replace(PLACEHOLDER, filled[1])


def _line(text: str) -> str:
    return _SPACE.sub(" ", text).strip()


def _unlike(change: Change, found: Reading, wanted: Reading, where: str) -> Iterator[str]:
    if isinstance(wanted, str) and isinstance(found, str):
        if found not in change.expected(wanted):
            yield f"{where}: {found[:300]!r} for {wanted[:300]!r}"
    elif isinstance(wanted, dict) and isinstance(found, dict) and len(found) == len(wanted):
        for one, other in zip(found.items(), wanted.items(), strict=True):
            yield from _unlike(change, one[0], other[0], f"{where}.{other[0]!s:.30} as a key")
            yield from _unlike(change, one[1], other[1], f"{where}.{other[0]!s:.30}")
    elif isinstance(wanted, list) and isinstance(found, list) and len(found) == len(wanted):
        for number, (one, other) in enumerate(zip(found, wanted, strict=True)):
            yield from _unlike(change, one, other, f"{where}[{number}]")
    elif found != wanted:
        yield f"{where}: {_short(found)} for {_short(wanted)}"


def _short(value: Any) -> str:
    return repr(value)[:300]
