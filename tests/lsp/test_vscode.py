"""The extension for VS Code: driven with the real server behind it and a stub of the editor, and packed."""

from __future__ import annotations

import json
import os
import runpy
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree
from zipfile import ZipFile

import pytest

from cellc.version import __version__
from tests.cells import ROOT, spec_text

_EXTENSION = ROOT / "docs" / "editor" / "vscode"
_NODE = shutil.which("node")
_with_node = pytest.mark.skipif(_NODE is None, reason="Node.js is not installed, which runs the extension")


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Return what the editor showed in a session, from its start to a server that is not there."""
    folder = tmp_path_factory.mktemp("vscode")
    spec = folder / "cell.yaml"
    spec.write_text(spec_text("ur5e_pick"), encoding="utf-8")
    command = json.dumps([sys.executable, "-m", "cellc", "lsp"])
    done = subprocess.run(
        [_NODE or "node", ROOT / "tests/lsp/vscode/drive.js", spec],
        env={
            **os.environ,
            "PYTHONPATH": str(ROOT),
            "CELLC_COMMAND": command,
            "CELLC_FOLDER": str(folder),
            "CELLC_EXTENSION": str(_EXTENSION / "extension.js"),
        },
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def _text(edits: list[dict[str, Any]]) -> str:
    """Return the spec after edits, of which none is of another file."""
    lines = spec_text("ur5e_pick").split("\n")
    for edit in sorted(edits, key=lambda one: (one["range"]["start"]["line"], one["range"]["start"]["character"]))[
        ::-1
    ]:
        start, end = edit["range"]["start"], edit["range"]["end"]
        line = lines[start["line"]]
        lines[start["line"]] = line[: start["character"]] + edit["newText"] + line[end["character"] :]
    return "\n".join(lines)


@_with_node
def test_findings_are_those_of_the_server_with_their_fixes(shown: Any) -> None:
    assert {finding["source"] for finding in shown["first"]} == {"cellc"}
    assert {finding["severity"] for finding in shown["first"]} == {1, 2}, (
        "warnings of VS Code, where 0 is an error, and for the audit"
    )
    assert shown["wrong"]["severity"] == 0
    assert "there is no device `amr`" in shown["wrong"]["message"]
    nearest, other = (action for action in shown["actions"] if not action["title"].startswith("Ignore"))
    assert (nearest["title"], nearest["isPreferred"]) == ("amr becomes arm", True)
    assert (other["title"], other.get("isPreferred")) == ("amr becomes camera", None)
    assert [finding["code"] for finding in nearest["diagnostics"]] == ["unknown-device"]
    assert [edit["newText"] for edit in nearest["edit"]["edits"]] == ["arm"]


@_with_node
def test_places_are_explained_and_lead_to_others(shown: Any) -> None:
    assert "`0.01 rad` is 0.573 deg." in shown["hover"]["contents"]["value"]
    line = spec_text("ur5e_pick").split("\n").index("  arm:")
    assert shown["definition"]["range"]["start"] == {"line": line, "character": 2}
    assert len(shown["references"]) == 15
    assert shown["references"][0] == shown["definition"]
    assert [symbol["name"] for symbol in shown["symbols"]][:3] == ["format", "cell", "summary"]


@_with_node
def test_a_rename_is_shown_before_it_is_made_or_refused_with_its_reason(shown: Any) -> None:
    assert shown["prepared"]["placeholder"] == "arm"
    assert {edit["note"]["label"] for edit in shown["renamed"]} == {"Rename device arm to robot"}
    assert all(edit["note"]["needsConfirmation"] for edit in shown["renamed"])
    text = _text(shown["renamed"])
    assert "\n  robot:\n" in text
    assert "{parent: robot/tool0, xyz: 0 0 11 mm" in text
    assert "arm/" not in text
    assert shown["refused"] == "`arm` cannot become `gripper`: there is a device `gripper` already, in line 40"
    assert shown["nothing"].startswith("here is no name")


@_with_node
def test_a_completion_replaces_the_whole_name(shown: Any) -> None:
    link = next(item for item in shown["completion"] if item["label"] == "arm/tool0")
    assert link["insertText"] == "arm/tool0"
    assert link["range"]["end"]["character"] - link["range"]["start"]["character"] == len("arm/")
    assert shown["formatted"][0]["newText"] == spec_text("ur5e_pick")


@_with_node
def test_the_server_is_started_again_and_one_that_is_not_there_is_named(shown: Any) -> None:
    assert shown["restarted"] == len(shown["first"])
    assert shown["stderr"] == []
    assert shown["missing"][-1].startswith("cellc: `cellc-that-is-not-there` cannot be started: ")


@_with_node
@pytest.mark.parametrize("script", sorted(ROOT.glob("docs/editor/vscode/*.js")), ids=lambda path: path.name)
def test_a_script_is_javascript_of_some_length(script: Path) -> None:
    assert subprocess.run([_NODE or "node", "--check", script], check=False).returncode == 0
    assert len(script.read_text(encoding="utf-8").splitlines()) <= 400


def _packed(folder: Path) -> Path:
    folder.mkdir()
    packed: Path = runpy.run_path(str(_EXTENSION / "pack.py"))["pack"](folder)
    return packed


def test_the_package_has_what_vs_code_reads_and_is_the_same_each_time(tmp_path: Path) -> None:
    one, other = _packed(tmp_path / "one"), _packed(tmp_path / "other")
    assert one.read_bytes() == other.read_bytes()
    assert one.name == f"cellc-{__version__}.vsix"
    with ZipFile(one) as archive:
        files = {name: archive.read(name).decode() for name in archive.namelist()}
    types = ElementTree.fromstring(files["[Content_Types].xml"])
    known = {entry.attrib["Extension"] for entry in types}
    assert {Path(name).suffix for name in files} - {".xml"} == known
    manifest = ElementTree.fromstring(files["extension.vsixmanifest"])
    space = {"m": "http://schemas.microsoft.com/developer/vsx-schema/2011"}
    identity = manifest.find("m:Metadata/m:Identity", space)
    assert identity is not None
    stated = json.loads(files["extension/package.json"])
    assert (identity.attrib["Id"], identity.attrib["Version"]) == (stated["name"], stated["version"])
    assert all(asset.attrib["Path"] in files for asset in manifest.findall("m:Assets/m:Asset", space))
    assert stated["main"] == "./extension.js"
    assert "dependencies" not in stated


def test_the_extension_needs_only_the_editor_and_node() -> None:
    text = (_EXTENSION / "extension.js").read_text(encoding="utf-8")
    assert text.count("require(") == 2
    assert "require('child_process')" in text
    assert "require('vscode')" in text
