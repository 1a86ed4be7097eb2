"""A controller broken by hand fails in the mock for the reason that the real controller manager gave."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

from tests.cli.refused import process
from tests.foreign_yaml import safe_load
from tests.oracles import RECORDED

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
    assert {one["outcome"] for one in told["rehearsals"]} == {"bringup_failure"}
    reason = _reason_of_the_real_one().replace("arm_controller", "arm_trajectory")
    assert all(reason in one["reason"] for one in told["rehearsals"])
    assert any("controllers.yaml" in note and "edited" in note for note in told["notes"])


def _reason_of_the_real_one() -> str:
    messages = safe_load(OBSERVED.read_text(encoding="utf-8"))["messages"]
    warning = re.fullmatch(r"\[WARN\] \[controller_manager\]: (.+)", messages[0])
    assert warning is not None
    return warning[1]
