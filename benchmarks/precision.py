"""How much of what is said of a mistake points at it: one value of a clean cell is changed at a time.

``python benchmarks/precision.py [--every 1]`` changes every value in each way that fits it: a number ten times as
large, one of the other sign, another unit of its kind, and a name that is under the same key elsewhere. Of each
changed cell the findings count that the cell did not have before. A finding points at the change where it is on its
line, or relates to it. A change that is no mistake, such as a rate of 30 Hz for 10, is counted as the others are: that
nothing is said of it is no fault, and what is said elsewhere is one.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from cellc.compiler.pipeline import check  # noqa: E402
from cellc.contract.diagnostics import Diagnostic  # noqa: E402  the checkout comes before what is installed

_NUMBER = re.compile(r"(?<![\w.-])-?\d+(?:\.\d+)?(?![\w.-])")
_OTHER_UNIT = {"mm": "m", "m": "mm", "deg": "rad", "rad": "deg", "ms": "s", "s": "ms", "kg": "g", "Hz": "kHz"}
_NAME = re.compile(r"[A-Za-z_][\w/]*")


@dataclass(frozen=True, slots=True)
class Leaf:
    """A value of a spec: its key, its text, its line from 1, and where it is in the text."""

    key: str
    text: str
    line: int
    start: int
    end: int


def leaves(node: yaml.Node, key: str = "") -> Iterator[Leaf]:
    """Yield every value that is on one line."""
    if isinstance(node, yaml.MappingNode):
        for name, value in node.value:
            yield from leaves(value, str(name.value))
    elif isinstance(node, yaml.SequenceNode):
        for value in node.value:
            yield from leaves(value, key)
    elif isinstance(node, yaml.ScalarNode) and node.start_mark.line == node.end_mark.line:
        yield Leaf(key, node.value, node.start_mark.line + 1, node.start_mark.index, node.end_mark.index)


def changes(leaf: Leaf, all_leaves: list[Leaf]) -> Iterator[tuple[str, str]]:
    """Yield each kind of change that fits a value, with the changed text."""
    number = next((found for found in _NUMBER.finditer(leaf.text) if float(found[0])), None)
    unit = leaf.text.rpartition(" ")[2]
    if number is not None:
        larger = f"{float(number[0]) * 10:g}"
        yield "ten times", leaf.text[: number.start()] + larger + leaf.text[number.end() :]
        turned = number[0].removeprefix("-") if number[0].startswith("-") else f"-{number[0]}"
        yield "sign", leaf.text[: number.start()] + turned + leaf.text[number.end() :]
    if number is not None and unit in _OTHER_UNIT:
        yield "unit", leaf.text.removesuffix(unit) + _OTHER_UNIT[unit]
    if _NAME.fullmatch(leaf.text):
        other = next((item.text for item in all_leaves if item.key == leaf.key and item.text != leaf.text), None)
        if other is not None and _NAME.fullmatch(other):
            yield "name", other


def main() -> None:
    """Print the figures by kind of change."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--every", type=int, default=1, help="change one value of so many")
    every = parser.parse_args().every
    changed, said, named, findings, pointing = (Counter[str]() for _ in range(5))
    for cell in sorted((ROOT / "cells").glob("*/cell.yaml")):
        text = cell.read_text(encoding="utf-8")
        before = {(found.code, found.message) for found in check(cell).diagnostics}
        node = yaml.compose(text, Loader=yaml.SafeLoader)
        assert node is not None
        known = list(leaves(node))
        for leaf in known[::every]:
            for kind, other in changes(leaf, known):
                spoilt = text[: leaf.start] + other + text[leaf.end :]
                new = [item for item in _found(spoilt) if (item.code, item.message) not in before]
                right = [item for item in new if leaf.line in _lines(item)]
                changed[kind] += 1
                said[kind] += bool(new)
                named[kind] += bool(right)
                findings[kind] += len(new)
                pointing[kind] += len(right)
    print("| change | cells | with a finding | named at its line | findings | pointing at it |")
    print("|---|---|---|---|---|---|")
    for kind in (*changed, "all"):
        counts = [count.total() if kind == "all" else count[kind] for count in (changed, said, named, findings)]
        share = (pointing.total() if kind == "all" else pointing[kind]) / max(counts[3], 1)
        print(f"| {kind} | {' | '.join(map(str, counts))} | {share:.0%} |", flush=True)


def _found(text: str) -> tuple[Diagnostic, ...]:
    with tempfile.NamedTemporaryFile("w", encoding="utf-8", suffix=".yaml") as file:
        file.write(text)
        file.flush()
        return check(file.name).diagnostics


def _lines(found: Diagnostic) -> set[int]:
    return {found.span.line, *(item.span.line for item in found.related)}


if __name__ == "__main__":
    main()
