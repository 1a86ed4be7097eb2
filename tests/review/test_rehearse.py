"""How rehearsals end before and after a change, on the mock as `cellc mock` runs it."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

from tests.cells import generated
from tests.cli.run import run


def test_outcomes_are_compared(tmp_path: Path) -> None:
    folder = tmp_path / "minimal"
    shutil.copytree(generated("minimal"), folder)
    # The pose wants the elbow at 1.57 rad.
    contract = json.loads((folder / "contract.json").read_text(encoding="utf-8"))
    contract["joint_limits"]["arm_elbow_joint"]["upper"] = 1.0
    (folder / "contract.json").write_text(json.dumps(contract), encoding="utf-8")
    ran = run("diff", generated("minimal").as_posix(), folder.as_posix(), "--rehearse")
    assert ran.code == 1
    lines = ran.out.splitlines()
    assert f"note: {folder.as_posix()}: `contract.json` was edited after it was generated" in lines
    assert any(
        line.startswith("rehearsal ready: succeeded -> ") and line.endswith(", not as declared") for line in lines
    )
