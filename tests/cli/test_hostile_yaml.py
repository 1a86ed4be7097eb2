"""YAML of other programs whose values are none, or take the square of their length, through the commands."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import pytest

from tests.cli.hostile_cell import make, new_cell
from tests.cli.run import run

_HOSTILE = {
    "no bool": "!!bool x",
    "no int": "!!int ''",
    "no timestamp": "!!timestamp x",
    "too large a float": "1" + ":1" * 300 + ".5",
    "a long number": "1" + ":1" * 400_000,  # YAML 1.1, 10.2.1.4: to base 60
}
_values = pytest.mark.parametrize("value", _HOSTILE.values(), ids=_HOSTILE)


@pytest.fixture(name="cell")
def cell_fixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a cell and its generated folder, which is the current one."""
    folder = new_cell(tmp_path / "cell")
    monkeypatch.chdir(folder)
    assert run("build", "cell.yaml").code == 0
    return folder


def _spoil(folder: Path, file: str, value: str) -> None:
    """Add a value to a generated file, and make the manifest agree with it."""
    place = folder / file
    place.write_text(place.read_text(encoding="utf-8") + f"\nmore: {value}\n", encoding="utf-8")
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    digest = hashlib.sha256(place.read_bytes()).hexdigest()
    manifest["files"][file] = f"sha256:{digest}" if ":" in manifest["files"][file] else digest
    (folder / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")


@_values
def test_diff_and_mock_refuse_a_generated_folder_with_it(value: str, cell: Path) -> None:
    _spoil(cell / "generated/fuzzed", "config/controllers.yaml", value)
    ran = run("diff", "cell.yaml", "generated/fuzzed")
    assert (ran.code, "config/controllers.yaml: is not YAML that cellc writes" in ran.err) == (2, True), ran
    ran = run("mock", "generated/fuzzed")
    assert ran.code in (1, 2), ran
    assert "Traceback" not in ran.err


@_values
def test_import_passes_over_a_file_with_it(value: str, cell: Path) -> None:
    text = (cell / "stage/stage.urdf").read_text(encoding="utf-8")
    make(cell, {"vendor/arm.urdf": text, "vendor/controllers.yaml": f"joint_limits:\n  turn: {value}\n"})
    ran = run("import", "vendor/arm.urdf", "-o", "arm")
    assert (ran.code, (cell / "arm/device.yaml").exists()) == (0, True), ran
    (cell / "arm/device.yaml").write_text(f"kind: arm\nvendor: {value}\n", encoding="utf-8")
    ran = run("import", "vendor/arm.urdf", "-o", "arm")
    assert ran.code in (0, 1), ran
    assert "Traceback" not in ran.err
