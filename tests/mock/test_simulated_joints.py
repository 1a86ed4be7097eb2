"""What a spec says of simulated joints is what the mock's joints do."""

from __future__ import annotations

from pathlib import Path

from cellc.mock import load
from cellc.mock.plant import Plant
from tests.cells import CORPUS, build_into


def test_figures_of_a_joint_count_before_those_of_all(tmp_path: Path) -> None:
    cell = load(build_into(tmp_path / "demo", CORPUS / "valid" / "simulated_joints.yaml"))
    assert {name: (j.lag_s, j.max_velocity) for name, j in cell.contract.simulated_joints.items()} == {
        "stage_turn": (0.01, None),
        "stage_slide": (0.005, 0.2),
    }
    plants: list[Plant] = []
    entry = cell.entries[0]
    assert cell.rehearse(entry, seed=0, watch=plants.append).outcome == entry.expect
    disturbances = plants[0].control.managers["stages"].disturbances
    turn, slide = disturbances.joints.of("stage_turn"), disturbances.joints.of("stage_slide")
    assert turn is not None
    assert slide is not None
    assert (turn.time_constant_s, slide.time_constant_s, slide.max_velocity) == (0.01, 0.005, 0.2)
    noise = turn.noise
    assert noise is not None
    assert abs(noise.amplitude - 0.000174533) < 1e-9  # 0.01 deg
