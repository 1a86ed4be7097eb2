"""User name and password of a device are read as the cell is launched: no file of the package has them."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

from cellc.compiler.catalog.load import device_names
from tests.cells import EVERY_CELL, built, catalog_facts, diagnose, spec_text, written
from tests.emit.cells import emitted

_SECRET = "p&s<s>'$w\"d"


def _expanded(text: str, folder: Path, **env: str) -> subprocess.CompletedProcess[str]:
    file = folder / "robot.urdf"
    file.write_text(text, encoding="utf-8")
    program = "import sys, xacro; sys.stdout.write(xacro.process_file(sys.argv[1]).toxml())"
    command = [sys.executable, "-c", program, str(file)]
    return subprocess.run(command, env={**os.environ, **env}, capture_output=True, text=True, check=False)


def _parameters(text: str) -> dict[str, str]:
    return {node.attrib["name"]: node.text or "" for node in ElementTree.fromstring(text).iter("param")}


def test_no_device_of_the_catalog_has_a_password() -> None:
    for name in device_names():
        real = ((catalog_facts(name).get("control") or {}).get("hardware") or {}).get("real") or {}
        for key, value in (real.get("parameters") or {}).items():
            assert "password" not in key or value == "{password}", (name, key)


@pytest.mark.parametrize("cell", EVERY_CELL)
def test_no_file_of_a_cell_has_the_factory_password(cell: str) -> None:
    for path, text in built(cell).texts.items():
        assert '<param name="password">admin' not in text, path


def test_environment_of_the_launch_has_user_name_and_password(tmp_path: Path) -> None:
    text = built("gen3_2f").texts["urdf/gen3_2f.real.urdf"]
    ran = _expanded(text, tmp_path, GEN3_USERNAME="ada", GEN3_PASSWORD=_SECRET)
    assert ran.returncode == 0, ran.stderr
    parameters = _parameters(ran.stdout)
    assert (parameters["username"], parameters["password"]) == ("ada", _SECRET)


def test_launch_without_the_variables_ends_with_their_name(tmp_path: Path) -> None:
    ran = _expanded(built("gen3_2f").texts["urdf/gen3_2f.real.urdf"], tmp_path, GEN3_USERNAME="ada")
    assert ran.returncode != 0
    assert "GEN3_PASSWORD" in ran.stderr


def test_file_beside_the_launch_has_them_instead(tmp_path: Path) -> None:
    secret = tmp_path / "arm.yaml"
    secret.write_text('username: ada\npassword: "p&s<s>w"\n', encoding="utf-8")
    spec = spec_text("gen3_2f").replace("credentials: GEN3", "credentials: /etc/cell/arm.yaml")
    texts = emitted(tmp_path, spec)
    assert "/etc/cell/arm.yaml" in texts["gates/promotion.md"]
    text = texts["urdf/gen3_2f.real.urdf"].replace("/etc/cell/arm.yaml", str(secret))
    ran = _expanded(text, tmp_path)
    assert ran.returncode == 0, ran.stderr
    assert (_parameters(ran.stdout)["username"], _parameters(ran.stdout)["password"]) == ("ada", "p&s<s>w")


@pytest.mark.parametrize("stated", ["gen3", "{ARM_PASSWORD: admin}", "''", '"/a\'.yaml"', "a.yaml"])
def test_what_is_no_place_of_credentials_is_an_error_at_its_line(stated: str, tmp_path: Path) -> None:
    spec = written(tmp_path, spec_text("gen3_2f").replace("credentials: GEN3", f"credentials: {stated}"))
    errors = [diagnosis for diagnosis in diagnose(spec) if "credentials" in ".".join(map(str, diagnosis.yaml_path))]
    assert errors
    assert all(error.span.line == 39 for error in errors)
