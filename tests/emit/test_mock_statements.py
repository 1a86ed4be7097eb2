"""What only a statement of somebody keeps from hardware on the mock is shown to those who approve and start it."""

from __future__ import annotations

import shutil

import pytest

from cellc.tools.report.resolved import flatten, resolved_tree
from tests.cells import CORPUS, Compiled, compiled, written

_SPEC = """format: 1
cell: demo
summary: A cell of made-up devices
include: base/all.yaml
mock_plugins:
  bare_arm_simulation/Hardware: {touches_no_hardware: true, by: Ada of controls, date: 2026-07-01}
  nobody/UsesThis: {touches_no_hardware: true, by: Nemo, date: 2026-07-01}
mock_programs:
  bare_arm_driver/status: {touches_no_hardware: true, by: Ben of drivers, date: 2026-07-02}
devices:
  one: {model: ./base/own_mock_arm, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: bare 1.0.0}
  two: {model: ./base/own_program_arm, mount: {parent: world, xyz: 0 4 0 m}, revision: A, firmware: bare 1.0.0}
"""


@pytest.fixture(scope="module")
def cell(tmp_path_factory: pytest.TempPathFactory) -> Compiled:
    folder = tmp_path_factory.mktemp("cell")
    shutil.copytree(CORPUS / "invalid" / "base", folder / "base")
    return compiled(written(folder, _SPEC))


@pytest.mark.parametrize(("file", "gate"), [("gates/promotion.md", "## G2 "), ("gates/network.md", "## L6 ")])
def test_a_person_looks_at_what_is_signed_for_before_the_mock_starts(file: str, gate: str, cell: Compiled) -> None:
    section = cell.texts[file].split(gate)[1].split("\n## ")[0]
    lines = [line for line in section.splitlines() if "touches no hardware" in line]
    assert [line.startswith("- [ ] ") for line in lines] == [True, True]
    assert "`bare_arm_simulation/Hardware`" in lines[0]
    assert "Ada of controls, dated 2026-07-01" in lines[0]
    assert "`bare_arm_driver/status`" in lines[1]
    assert "Ben of drivers, dated 2026-07-02" in lines[1]
    assert section.index(lines[1]) < section.index("```sh")


def test_audit_says_what_rests_on_a_statement(cell: Compiled) -> None:
    proof = cell.texts["audit.md"].split("\n## What the mock cannot prove\n")[1]
    said = [line for line in proof.splitlines() if "touches no hardware" in line]
    assert [line.partition(":")[0] for line in said] == ["- one", "- two"]
    assert [line.rpartition(" of ")[2] for line in said] == [
        "controls, 2026-07-01",
        "drivers, 2026-07-02",
    ]


def test_show_tells_each_statement_with_its_line(cell: Compiled) -> None:
    leaves = dict(flatten(resolved_tree(cell.graph.cell)))
    by = leaves["mock_plugins.bare_arm_simulation/Hardware.by"]
    assert (by.text, by.origin.rpartition(":")[2]) == ("Ada of controls", "6")
    assert leaves["mock_plugins.nobody/UsesThis.by"].text == "Nemo"
    assert leaves["mock_programs.bare_arm_driver/status.touches_no_hardware"].text == "true"
