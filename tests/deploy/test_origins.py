"""Generated files say where they come from by the path in the spec, never by a line: an edit above would move it."""

from __future__ import annotations

import re

import pytest

from tests.cells import CELLS, ROOT, built, document_of, spec_of

_PATHS = re.compile(r"^ *(?:# |<!-- )(?:hardware of |driver of )?([a-z_]+(?:\.\w+)+)", re.MULTILINE)


@pytest.mark.parametrize("cell", CELLS)
def test_paths_in_generated_files_are_paths_of_the_spec(cell: str) -> None:
    document = document_of(spec_of(cell))
    found = {(file, path) for file, text in built(cell).texts.items() for path in _PATHS.findall(text)}
    assert {f"devices.{device.name}" for device in built(cell).graph.cell.devices} < {path for _, path in found}
    for file, path in found:
        assert document.has(tuple(path.split("."))) or path == "owners.approvals.graph", (file, path)


@pytest.mark.parametrize("cell", CELLS)
def test_every_part_of_a_description_or_parameter_file_names_its_path(cell: str) -> None:
    texts = built(cell).texts
    devices = [device.name for device in built(cell).graph.cell.devices]
    for target in ("mock", "real"):
        assert all(f"<!-- devices.{name}: " in texts[f"urdf/{cell}.{target}.urdf"] for name in devices)
    for file, text in texts.items():
        if file.startswith("config/") and "ros__parameters" in text:
            # Behind the header, a comment stands before each node.
            sections = [part for part in text.split("\n\n", 1)[1].split("\n") if part and part[0] not in " #\n"]
            assert len(re.findall(r"^# \w", text.split("\n\n", 1)[1], re.MULTILINE)) == len(sections), file


@pytest.mark.parametrize("cell", CELLS)
def test_no_generated_file_names_a_line_of_the_spec_and_the_readme_claims_none(cell: str) -> None:
    for file, text in built(cell).texts.items():
        assert not re.search(r"\.yaml:\d+", text), file
    assert "line of the spec they came from" not in (ROOT / "README.md").read_text(encoding="utf-8")
