"""What a shell puts into its line, and on its terminal, of a folder and a journal of strangers."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cells import ROOT

HOSTILE = ["a$(touch pwned)", "a;touch", "a b", "a\nplain,forged", "a\x1b]0;x\x07", "a\u202eb", "`id`", "'", "a|b", "~"]


def _completed(shell: str, line: str, folder: Path) -> str:
    words = line.split(" ")
    variables = {"COMP_WORDS": line, "COMP_CWORD": str(len(words) - 1), "_CELLC_COMPLETE": f"{shell}_complete"}
    if shell == "fish":
        variables["COMP_CWORD"] = words[-1]
    asked = subprocess.run(
        [sys.executable, "-P" if sys.version_info >= (3, 11) else "-E", "-m", "cellc"],
        env={**os.environ, **variables},
        cwd=folder,
        capture_output=True,
        text=True,
        encoding="utf-8",
        timeout=60,
        check=False,
    )
    assert asked.stderr == ""
    return asked.stdout


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_a_name_that_a_shell_would_evaluate_is_no_word(shell: str, tmp_path: Path) -> None:
    shutil.copytree(ROOT / "generated/ur5e_pick", tmp_path / "x")
    file = tmp_path / "x/rehearsals.json"
    told = json.loads(file.read_text(encoding="utf-8"))
    (plain,) = (rehearsal for rehearsal in told["rehearsals"] if rehearsal["name"] == "stale_camera")
    told["rehearsals"] = [plain, *({**plain, "name": name} for name in HOSTILE)]
    file.write_text(json.dumps(told), encoding="utf-8")
    shown = _completed(shell, "cellc mock x --rehearsal ", tmp_path)
    assert "stale_camera" in shown
    assert set(shown) <= set("abcdefghijklmnopqrstuvwxyz_, \n\t")
    assert "forged" not in shown


@pytest.mark.parametrize(
    "run",
    ['{"passed":true,"number":1e999}', "[" * 200_000, '{"passed":1,"number":"' + "9" * 5000 + '"}', "\x1b]0;x\x07"],
    ids=["infinite", "deep", "long", "no JSON"],
)
def test_a_damaged_journal_has_no_words(run: str, tmp_path: Path) -> None:
    (tmp_path / "journal").write_text(f"{{}}\n{run}\n", encoding="utf-8")
    assert _completed("bash", "cellc replay x --journal journal s", tmp_path).strip() == ""
