"""What an answer is computed from is asked through `cellc.disk` alone, or kept answers would outlive their causes."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.cli.run import ROOT

# What decides the answer for a spec; who writes the folder and talks to people does not.
STAGES = (
    *("source", "spec", "catalog", "cell", "link", "graph", "description", "feasibility", "planning", "formats"),
    *("rules", "emit", "verify", "contract", "transforms", "diagnostics"),
)
DOORS = re.compile(
    r"(?<![\w.])(?<!def )open\(|\.(open|read_text|read_bytes)\(|\.(exists|is_file|is_dir|is_symlink|lstat)\(\)"
    r"|os\.(stat|lstat|listdir|scandir|walk|access|readlink|getcwd|environ|getenv)\b"
    r"|os\.path\.(exists|isfile|isdir|islink|realpath|getsize|getmtime|lexists|expanduser)\("
    r"|\.(iterdir|glob|rglob|resolve|cwd|home|expanduser)\(|^\s*import glob\b"
    r"|\.(today|now|utcnow)\(|time\.(time|monotonic|localtime)\(|^\s*import (time|platform|socket|locale)\b"
)
# The package's own files, which belong to the mark of the program; and the way to the child that expands xacro, whose
# current folder is part of what an answer is kept under.
ALLOWED = {
    "catalog/load.py: glob(",
    "description/xacro_expander.py: os.getcwd",
    "description/xacro_expander.py: os.environ",
    "description/xacro_expander.py: resolve(",
    "description/xacro_expansion.py: os.getcwd",
    "emit/launch/bring_up.py: read_text(",
}


@pytest.mark.parametrize("stage", STAGES)
def test_no_stage_looks_at_the_disk_or_the_clock_by_itself(stage: str) -> None:
    found = {
        f"{file.relative_to(ROOT / 'cellc').as_posix()}: {match[0].lstrip('.')}"
        for file in sorted((ROOT / "cellc" / stage).rglob("*.py"))
        for line in _code(file)
        for match in DOORS.finditer(line)
    }
    assert found - ALLOWED == set()


def test_nothing_is_allowed_that_nobody_does() -> None:
    for entry in ALLOWED:
        name, _, words = entry.partition(": ")
        assert words in (ROOT / "cellc" / name).read_text(encoding="utf-8"), entry


def _code(file: Path) -> list[str]:
    return [line.partition("#")[0] for line in file.read_text(encoding="utf-8").splitlines()]
