"""Which frames the description of a cell holds, of frames built by hand: none that hangs on a dynamic one."""

from __future__ import annotations

import pytest

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.entity import Places
from cellc.compiler.cell.frame import WORLD, Frame, FrameKind, Solid
from cellc.compiler.formats.urdf.robot import described_frames
from cellc.compiler.link.frames import ROBOT_STATE_PUBLISHER
from cellc.contract.diagnostics import Span
from cellc.contract.stated import Versions
from cellc.contract.transforms import identity
from cellc.contract.vocabulary import Distro

_PLACE = Span("cell.yaml", 1, 1, 1, 2)


def _frame(name: str, parent: str) -> Frame:
    dynamic = name.startswith("seen")
    return Frame(
        name=name,
        path=("frames", name),
        span=_PLACE,
        kind=FrameKind.DYNAMIC if dynamic else FrameKind.FIXED,
        parent=parent,
        transform_to_parent=None if dynamic else identity(),
        authority="camera" if dynamic else ROBOT_STATE_PUBLISHER,
    )


def _described(frames: dict[str, str], boxes: dict[str, str]) -> set[str]:
    cell = Cell(
        name="demo",
        places=Places(""),
        distro=Distro.JAZZY,
        versions=Versions(ros="jazzy"),
        frames=tuple(_frame(name, parent) for name, parent in frames.items()),
        scene=tuple(
            Solid(
                name=name,
                path=("scene", name),
                span=_PLACE,
                parent=parent,
                transform_to_parent=identity(),
                size=(1.0, 1.0, 1.0),
                kind="box",
            )
            for name, parent in boxes.items()
        ),
    )
    return set(described_frames(cell)) - {WORLD}


@pytest.mark.parametrize(
    ("frames", "boxes", "described"),
    [
        ({"table": WORLD, "tray": "table"}, {"wall": WORLD, "bin": "tray"}, {"table", "tray", "wall", "bin"}),
        ({"seen": WORLD}, {"on": "seen"}, set()),
        # The last of a chain is asked first, in the middle and at the end.
        ({"third": "second", "second": "first", "first": "seen", "seen": WORLD}, {"on": "third"}, set()),
        ({"second": "first", "third": "second", "seen": "table", "first": "seen", "table": WORLD}, {}, {"table"}),
        ({"seen": "table", "table": WORLD, "first": "seen", "second": "first"}, {"b": "table"}, {"table", "b"}),
        # Two chains, one of which moves; a dynamic frame below another.
        ({"a": WORLD, "b": "a", "seen": "a", "c": "seen", "d": "c"}, {}, {"a", "b"}),
        ({"seen": WORLD, "arm": "seen", "seen_too": "arm", "tip": "seen_too"}, {}, set()),
        # A circle has no end, and nothing of it moves.
        ({"a": "b", "b": "a", "c": "b"}, {}, {"a", "b", "c"}),
    ],
)
def test_what_hangs_on_a_dynamic_frame_stays_out(
    frames: dict[str, str], boxes: dict[str, str], described: set[str]
) -> None:
    assert _described(frames, boxes) == described
