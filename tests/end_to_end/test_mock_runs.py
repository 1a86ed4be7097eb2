"""The mock runs what was built, tells it to programs, and leaves the same records every time."""

from __future__ import annotations

import json
from pathlib import Path

from tests.cli.refused import process

# The keys that other programs may rely on (issue 2, "Done when" 2).
KEYS = {"name", "outcome", "expected", "passed", "sim_time_s", "wall_time_s"}


def test_built_cell_passes_its_rehearsals(pick: Path) -> None:
    ran = process("mock", str(pick), "--json")
    assert ran.code == 0, ran.err
    told = json.loads(ran.out)
    contract = json.loads((pick / "contract.json").read_text(encoding="utf-8"))
    assert told["configuration_id"] == contract["configuration_id"]
    assert all(set(one) >= KEYS for one in told["rehearsals"])
    assert [(one["name"], one["outcome"], one["passed"]) for one in told["rehearsals"]] == [
        ("pick_and_place", "succeeded", True),
        ("stale_camera", "stale_state", True),
        ("program_stopped", "claim_failure", True),
        ("jogged_and_restarted", "succeeded", True),
        ("stopped_and_resumed", "succeeded", True),
        ("gripper_activated", "succeeded", True),
        ("canceled", "canceled", True),
    ]


def test_attempt_records_are_the_same_bytes_from_run_to_run(pick: Path, tmp_path: Path) -> None:
    for name, seed in (("a", "0"), ("b", "1"), ("c", "4242")):
        assert process("mock", str(pick), "--records", str(tmp_path / name), PYTHONHASHSEED=seed).code == 0
    first = (tmp_path / "a").read_bytes()
    assert first.count(b"\n") >= 3
    assert (tmp_path / "b").read_bytes() == first
    assert (tmp_path / "c").read_bytes() == first


def test_records_do_not_depend_on_where_the_folder_lies(pick: Path, tmp_path: Path) -> None:
    moved = tmp_path / "else where"
    moved.symlink_to(pick)
    near = process("mock", "else where", "--records", "near", "--rehearsal", "canceled", cwd=tmp_path)
    far = process("mock", str(pick), "--records", str(tmp_path / "far"), "--rehearsal", "canceled")
    assert near.code == far.code == 0
    assert (tmp_path / "near").read_bytes() == (tmp_path / "far").read_bytes()
