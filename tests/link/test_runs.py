"""What `run` may say: a package and an executable, and nothing else."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cells import linking, written
from tests.spec.reading import ARM, HEAD


@pytest.mark.parametrize(
    ("run", "refused"),
    [
        ("cell_tasks/pick_place", False),
        ("cell_tasks", True),
        ("/pick_place", True),
        ("cell_tasks/", True),
        ("1cell/pick_place", True),
        ("cell_tasks/bin/pick_place", True),
    ],
)
def test_program_of_a_node_is_a_package_and_an_executable(run: str, refused: bool, tmp_path: Path) -> None:
    spec = f"{HEAD}{ARM}nodes: {{task: {{run: {run}}}}}\n"
    found = [(one.code, one.yaml_path) for one in linking(written(tmp_path, spec)).diagnostics]
    assert (("not-an-executable", ("nodes", "task", "run")) in found) is refused, found
