"""The two-arm cell in the mock: controllers of one name under two managers are told apart."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.mock.cell import load, run_all
from tests.cells import DISTROS
from tests.consumers.matrix import build


@pytest.mark.parametrize("distro", DISTROS)
def test_each_arm_is_moved_by_its_own_controller(distro: str, tmp_path: Path) -> None:
    for path, text in build("two_arms", distro).texts.items():
        file = tmp_path / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    (result,) = run_all(load(tmp_path))
    assert result.passed, result
    claims = next(stage for stage in result.bringup if stage.stage == "claim").facts
    for side in ("left", "right"):
        owner = f"/{side}/arm_trajectory"
        assert f"`{side}_elbow_joint/position` is claimed by `{owner}`" in claims
    moved = {record.controller_name for record in result.attempts if record.controller_name}
    assert "/left/gripper_action" in moved
