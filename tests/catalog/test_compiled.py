"""The compiled catalog says what its files say; where it does not know a file, the file itself is read."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cellc.compiler.catalog import compiled, load
from cellc.compiler.catalog.compiled import CATALOG, compile_catalog, compiled_device, compiled_table
from cellc.compiler.catalog.controller_kind import ControllerKind
from cellc.compiler.catalog.load import controller_kinds, device_names, load_controller_kind, load_device, read_device
from cellc.compiler.catalog.read_model import read_model
from tests.cells import there

UR = "devices/universal_robots/ur"
WRITTEN = sorted((CATALOG / "compiled").rglob("*.json"))


def test_compiled_files_are_up_to_date() -> None:
    # After a change in the catalog: python -m cellc.compiler.catalog.compiled
    expected = dict(compile_catalog())
    assert {file: file.read_text(encoding="utf-8") for file in WRITTEN} == expected


@pytest.mark.parametrize("name", device_names())
def test_compiled_device_is_the_device_of_the_files(name: str) -> None:
    assert compiled_device(name) is not None
    assert load_device(name) == read_device(name)


@pytest.mark.parametrize("kind", controller_kinds())
def test_compiled_kind_is_the_kind_of_the_file(kind: str) -> None:
    read = read_model(CATALOG / f"controllers/{kind}.yaml", kind, ControllerKind)
    assert load_controller_kind(kind).value == there(read.value)[0]


def test_compiled_tables_are_those_of_the_files(monkeypatch: pytest.MonkeyPatch) -> None:
    loads = (
        load.load_distros,
        load.load_controller_manager,
        load.load_message_types,
        load.load_packages,
        load.load_qos_profiles,
        load.load_releases,
    )
    recalled = [table() for table in loads]
    monkeypatch.setattr(load, "compiled_table", lambda file: None)
    for table in loads:
        table.cache_clear()
    assert [table() for table in loads] == recalled


@pytest.mark.parametrize(
    "changed", ["devices/universal_robots/ur5e.yaml", f"{UR}.family.yaml", f"{UR}.urdf.xacro", "devices/shapes.xacro"]
)
def test_device_whose_files_changed_is_not_taken_from_the_compiled_one(
    changed: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    copy = tmp_path / "catalog"
    shutil.copytree(CATALOG, copy, ignore=shutil.ignore_patterns("*.py", "__pycache__"))
    monkeypatch.setattr(compiled, "CATALOG", copy)
    assert compiled_device("ur5e") is not None
    (copy / changed).write_bytes((copy / changed).read_bytes() + b" ")
    assert compiled_device("ur5e") is None


def test_missing_compiled_file_is_no_loss(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shutil.copy(CATALOG / "distros.yaml", tmp_path)
    monkeypatch.setattr(compiled, "CATALOG", tmp_path)
    assert compiled_table("distros.yaml") is None


def test_line_ends_of_another_system_change_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    copy = tmp_path / "catalog"
    shutil.copytree(CATALOG, copy, ignore=shutil.ignore_patterns("*.py", "__pycache__"))
    monkeypatch.setattr(compiled, "CATALOG", copy)
    (copy / "distros.yaml").write_bytes((copy / "distros.yaml").read_bytes().replace(b"\n", b"\r\n"))
    assert compiled_table("distros.yaml") is not None
