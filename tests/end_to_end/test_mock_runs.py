"""The mock runs what was built, alone, as every further cell says it, and leaves the same records."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from cellc.mock import load
from tests.cells import CELLS, EVERY_CELL, ROOT, spec_text, there
from tests.cli.refused import process
from tests.foreign_yaml import safe_load
from tests.oracles import RECORDED

# The keys that other programs may rely on (issue 2, "Done when" 2).
KEYS = {"name", "outcome", "expected", "passed", "sim_time_s", "wall_time_s"}


def test_built_cell_passes_its_rehearsals(pick: Path) -> None:
    ran = process("mock", str(pick), "--json")
    assert ran.code == 0, ran.err
    told = json.loads(ran.out)
    contract = json.loads((pick / "contract.json").read_text(encoding="utf-8"))
    assert told["configuration_id"] == contract["configuration_id"]
    assert all(set(rehearsal) >= KEYS for rehearsal in told["rehearsals"])
    assert [(rehearsal["name"], rehearsal["outcome"], rehearsal["passed"]) for rehearsal in told["rehearsals"]] == [
        ("pick_and_place", "succeeded", True),
        ("stale_camera", "stale_state", True),
        ("program_stopped", "claim_failure", True),
        ("jogged_and_restarted", "succeeded", True),
        ("stopped_and_resumed", "succeeded", True),
        ("gripper_activated", "succeeded", True),
        ("canceled", "canceled", True),
        ("no_part", "grip_failure", True),
        ("wrong_part", "grip_failure", True),
        ("lost_part", "grip_failure", True),
        ("slipped", "grip_failure", True),
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


# The mock, the format between it and the compiler, and what both use: the reader of URDF, planner, files, processes.
NEEDED = ("mock", "contract", "robot")
MODULES = ("__init__.py", "version.py")


def copy_the_mock(package: Path) -> None:
    """Copy what the mock needs of the package, and nothing else."""
    package.mkdir()
    for name in MODULES:
        shutil.copy(ROOT / "cellc" / name, package)
    for name in NEEDED:
        shutil.copytree(ROOT / "cellc" / name, package / name, ignore=shutil.ignore_patterns("__pycache__"))


def test_mock_runs_a_folder_where_the_compiler_is_absent(pick: Path, tmp_path: Path) -> None:
    copy_the_mock(tmp_path / "cellc")
    shutil.copytree(pick, tmp_path / "folder")
    # The working directory comes first in the search path, so the installed package does not fill in what is absent.
    assert _python(tmp_path, "-c", "import cellc.compiler.spec").returncode == 1
    done = _python(tmp_path, "-m", "cellc.mock", "folder", "--json")
    assert done.returncode == 0, done.stderr
    assert all(rehearsal["passed"] for rehearsal in json.loads(done.stdout)["rehearsals"])


def _python(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONSAFEPATH")}
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


FURTHER = tuple(cell for cell in EVERY_CELL if cell not in CELLS)


@pytest.mark.parametrize("name", FURTHER)
def test_a_further_cell_is_short_and_its_rehearsals_pass(name: str) -> None:
    assert len(spec_text(name).splitlines()) <= 134
    cell = load(ROOT / "generated" / name)
    ended = {rehearsal: cell.run(rehearsal, seed=0) for rehearsal in cell.rehearsals}
    assert not [f"{one}: {result.outcome}" for one, result in ended.items() if not result.passed]
    assert len(ended) >= 4


OBSERVED = RECORDED / "controller_manager/cases/y_badjoint/observed.yaml"


def test_wrong_joint_name_fails_as_in_the_real_controller_manager(pick: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(pick, tmp_path / "pick"))
    file = folder / "config/controllers.yaml"
    # The case of the oracle: a joint that the hardware does not have, in `joints` of the trajectory controller.
    broken = file.read_text().replace("      - arm_elbow_joint\n", "      - jointX\n")
    assert broken != file.read_text()
    file.write_text(broken)
    ran = process("mock", str(folder), "--edited", "--json")
    assert ran.code == 1
    told = json.loads(ran.out)
    assert {rehearsal["outcome"] for rehearsal in told["rehearsals"]} == {"bringup_failure"}
    reason = _reason_of_the_real_one().replace("arm_controller", "arm_trajectory")
    assert all(reason in rehearsal["reason"] for rehearsal in told["rehearsals"])
    assert any("controllers.yaml" in note and "edited" in note for note in told["notes"])


def _reason_of_the_real_one() -> str:
    messages = safe_load(OBSERVED.read_text(encoding="utf-8"))["messages"]
    warning = there(re.fullmatch(r"\[WARN\] \[controller_manager\]: (.+)", messages[0]))
    return warning[1]
