"""Where the links and joints of a device are written: in its URDF or xacro, of the catalog, a folder or a package."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from cellc.compiler.catalog.compiled import CATALOG, SHOWN
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device
from cellc.compiler.source.text import read_text
from cellc.contract.diagnostics import Span


def place_of_part(cell: Cell, name: str, kinds: tuple[str, ...]) -> Span | None:
    """Return where the link or joint ``device/part`` is written; None where the device has none, or its file is gone.

    A link that a macro makes is where the macro is called with its name.

    Args:
        kinds: what is meant where a link and a joint have one name.
    """
    owner, _, part = name.partition("/")
    device = next((device for device in cell.devices if device.name == owner), None)
    if device is None:
        return None
    named = list(_parts(device, part))
    if "joint" in kinds:
        named.reverse()
    for local_name, span in named:
        lines = _lines(span.file)
        if span.line <= len(lines):
            return span if local_name in lines[span.line - 1] else _called(device, local_name) or span
    return None


def _parts(device: Device, part: str) -> Iterator[tuple[str, Span]]:
    """Yield the link and the joint of a name, each as its file calls it."""
    links = [
        (link.name, link.span) for link in device.body.description.links if link.name == device.body.frames.get(part)
    ]
    moved = {joint.name for joint in device.joints if joint.local_name == part}
    joints = [(joint.name, joint.span) for joint in device.body.description.joints if joint.name in moved]
    for name, span in (*links, *joints):
        if span is not None:
            yield name.removeprefix(device.body.prefix), _at_hand(span)


def _called(device: Device, own: str) -> Span | None:
    """Return the first line of the description that makes something of a name, or None."""
    named = re.compile(rf"""\b(?:name|child)=["'](?:[^"']*\}})?{re.escape(own)}["']""")
    of = device.body.description
    spans = (*(link.span for link in of.links), *(joint.span for joint in of.joints))
    for file in dict.fromkeys(_at_hand(span).file for span in spans if span is not None):
        for number, line in enumerate(_lines(file), 1):
            if named.search(line):
                return Span(file, number, 1, number, len(line) + 1)
    return None


def _at_hand(span: Span) -> Span:
    """Return the place in the file that lies here: messages do not tell where cellc is installed."""
    within = span.file.removeprefix(f"{SHOWN}/")
    file = span.file if within == span.file else (CATALOG / within).as_posix()
    return Span(file, span.line, span.column, span.end_line, span.end_column)


def _lines(file: str) -> list[str]:
    text = read_text(Path(file), file, Span(file, 1, 1, 1, 1)).value
    return [] if text is None else text.split("\n")
