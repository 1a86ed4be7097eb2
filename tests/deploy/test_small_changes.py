"""What a change of one value changes: few files, and few lines of them, so that a review reads the change."""

from __future__ import annotations

from difflib import unified_diff
from pathlib import Path

import pytest

from tests.cells import built, compiled, spec_text, written

# The mount of a camera, of a gripper and of an arm, each moved by a millimetre.
_MOVES = [
    ("ur5e_pick", "xyz: 0 -70 30 mm", "xyz: 0 -70 31 mm"),
    ("ur5e_pick", "xyz: 0 0 11 mm", "xyz: 0 0 12 mm"),
    ("fr3_hand", "xyz: 0 0 0.7 m", "xyz: 0 0 0.701 m"),
]


def changed(folder: Path, cell: str, old: str, new: str) -> dict[str, list[str]]:
    """Return the changed lines, old and new, of every file that another value of a spec changes."""
    text = spec_text(cell)
    assert text.count(old) == 1
    before, after = built(cell).texts, compiled(written(folder, text.replace(old, new))).texts
    assert set(before) == set(after)
    return {
        path: [
            line
            for line in unified_diff(before[path].splitlines(), after[path].splitlines(), lineterm="", n=0)
            if line[0] in "+-" and not line.startswith(("+++", "---"))
        ]
        for path in before
        if before[path] != after[path]
    }


@pytest.mark.parametrize(("cell", "old", "new"), _MOVES)
def test_moved_mount_changes_few_files(cell: str, old: str, new: str, tmp_path: Path) -> None:
    files = changed(tmp_path, cell, old, new)
    described = {f"urdf/{cell}.mock.urdf", f"urdf/{cell}.real.urdf", "config/frames.yaml"}
    assert described | {"contract.json", "manifest.json"} <= set(files)
    assert len(files) <= 8
    # The value where it is, also of a gate, the configuration id, and the hashes of these files in the manifest.
    assert all(2 <= len(files[path]) <= 4 for path in described | {"contract.json"})
    assert sum(map(len, files.values())) <= 40


def test_changed_deadline_changes_what_speaks_of_it(tmp_path: Path) -> None:
    files = changed(tmp_path, "ur5e_pick", "cancel_within: 200 ms", "cancel_within: 150 ms")
    assert {path for path in files if path.startswith(("urdf/", "config/", "launch/", "security/"))} == set()
    assert len(files) <= 8
