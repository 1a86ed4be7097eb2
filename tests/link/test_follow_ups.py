"""One wrong name is one finding: what refers rightly to something that hangs on it is not reported too."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cells import diagnose, spec_text, written


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("mount: {parent: arm/tool0, xyz: 0 -70", "mount: {parent: arm/toolO, xyz: 0 -70"),
        ("mount: {parent: arm/tool0, xyz: 0 0 11", "mount: {parent: arm/flang, xyz: 0 0 11"),
        ("mount: {parent: world, xyz: 0 0 0.8 m}", "mount: {parent: wrld, xyz: 0 0 0.8 m}"),
        ("tcp: {parent: gripper/base", "tcp: {parent: gripper/bass"),
        ("    parent: camera/color_optical", "    parent: camera/colour_optical"),
    ],
)
def test_wrong_parent_is_told_once_and_where_it_stands(old: str, new: str, tmp_path: Path) -> None:
    text = spec_text("ur5e_pick")
    assert text.count(old) == 1
    line = text[: text.index(old)].count("\n") + 1
    found = diagnose(written(tmp_path, text.replace(old, new)))
    assert [(one.code, one.span.line) for one in found] == [("unknown-frame", line)]
