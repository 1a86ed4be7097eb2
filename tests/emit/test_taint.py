"""No text of a spec or a device is anything but text in what is generated: for xacro, launch, shells, Markdown.

The readers refuse `${`, `$(` and hidden characters; here they are put in behind them, so that what writes files is held
by itself. One text is hostile at a time where it is looked for what a cell still takes, then all of those are at once.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
from collections.abc import Iterator, Mapping
from copy import deepcopy
from functools import cache
from pathlib import Path
from typing import Any
from unittest.mock import patch
from xml.etree import ElementTree

import pytest
import xacro
import yaml
from pydantic import ValidationError

from cellc.catalog.device_model import DeviceModel
from cellc.catalog.load import CatalogDevice, load_device
from cellc.cell.cell import Cell
from cellc.deploy.configuration import header_of
from cellc.deploy.deployment import plan_deployment
from cellc.diagnostics import Outcome, YamlPath
from cellc.emit.emit_all import emit_all
from cellc.formats.escape import markdown_comment
from cellc.graph.cell_graph import build_graph
from cellc.link.link import link
from cellc.spec.cell_spec import CellSpec
from tests.cells import ROOT, document_of, linked, spec_of

_DEVICE = ROOT / "cellc" / "catalog" / "devices" / "ur5e" / "device.yaml"
_BASH = shutil.which("bash") or "bash"
_FENCE = re.compile(r"^ *```sh\n(.*?)^ *```$", re.M | re.S)
HOSTILE = {
    "xacro": "taint ${1+1} b",
    "launch": "taint $(env HOME) b",
    "html": "taint <script> b",
    "quotes": "taint \"b' c",
    "backticks": "taint `touch b` c",
    "bars": "taint | b | c",
    "links": "taint [b](http://taint.example) c",
    "comment": "taint --> b",
    "lines": "taint\n# taint\ntaint: 1\n\n<script>\n\n- taint\n\n```\ntaint",
    "shell": "taint; taint; # b",
    "backslash": "taint\\",
    "dollars": "taint $$ b $$$(env HOME) c $$${1+1} $$",
}


def _leaves(data: Any, path: YamlPath = ()) -> Iterator[YamlPath]:
    if isinstance(data, str):
        yield path
    elif isinstance(data, (dict, list)):
        for key, value in data.items() if isinstance(data, dict) else enumerate(data):
            yield from _leaves(value, (*path, key))


def _linked(paths: tuple[YamlPath, ...], text: str) -> Cell | None:
    """Return the cell with a text at each of the paths; None where a stage up to linking refuses that."""
    document = document_of(spec_of("ur5e_pick"))
    data: Any = {"spec": deepcopy(document.data), "device": deepcopy(document_of(_DEVICE).data)}
    for *holders, last in paths:
        inner = data
        for part in holders:
            inner = inner[part]
        inner[last] = text
    try:
        spec = CellSpec.model_validate(_frozen(data["spec"]))
        model = DeviceModel.model_validate(_frozen(data["device"]))
    except ValidationError:
        return None
    known = load_device("ur5e").value
    assert known is not None
    changed = Outcome(CatalogDevice(model, known.description))
    with patch("cellc.link.devices.load_device", lambda name: changed if name == "ur5e" else load_device(name)):
        outcome = link(spec, document)
    return outcome.value if outcome.ok else None


def _frozen(data: Any) -> Any:
    if isinstance(data, dict):
        return {key: _frozen(value) for key, value in data.items()}
    return tuple(map(_frozen, data)) if isinstance(data, list) else data


@cache
def free_texts() -> tuple[YamlPath, ...]:
    """Return the places that take any text: what stands there is neither a name nor one of a few words."""
    spec = (("spec", *path) for path in _leaves(document_of(spec_of("ur5e_pick")).data))
    device = (("device", *path) for path in _leaves(document_of(_DEVICE).data))
    return tuple(path for path in (*spec, *device) if _linked((path,), "taint <b>") is not None)


@cache
def artifacts(text: str) -> Mapping[str, str]:
    """Return all artifacts of a cell whose free texts are hostile."""
    cell = _linked(free_texts(), text)
    assert cell is not None
    graph = build_graph(cell)
    return {artifact.path: artifact.text for artifact in emit_all(graph, plan_deployment(graph))}


def _of(text: str, *endings: str) -> dict[str, str]:
    return {path: made for path, made in artifacts(text).items() if path.endswith(endings)}


def test_many_places_take_any_text() -> None:
    assert len(free_texts()) > 40
    assert ("spec", "devices", "gripper", "connection", "port") in free_texts()
    assert ("device", "safety", "stop_authority") in free_texts()


each = pytest.mark.parametrize("text", HOSTILE.values(), ids=HOSTILE.keys())


@each
def test_xacro_leaves_every_text_of_the_urdf_as_it_was(text: str) -> None:
    for path, made in _of(text, ".real.urdf", ".mock.urdf").items():
        document = xacro.parse(re.sub(r"\$\(find (\w+)\)", r"/share/\1", made))
        xacro.process_doc(document)
        texts = set(ElementTree.fromstring(document.toxml()).itertext())
        assert text in texts or not path.endswith("real.urdf")
        assert not re.search(r"taint (2|/)", document.toxml())


@each
def test_xml_and_launch_files_hold_it_as_text(text: str) -> None:
    for path, made in _of(text, ".xml", ".svg", ".srdf").items():
        root = ElementTree.fromstring(made)
        assert not list(root.iter("script")), path
        if path.startswith("launch/"):
            assert not re.search(r"(?<!\\)\$\((?!var |find-pkg-share |find-pkg-prefix |eval |command )", made), path


@each
def test_yaml_holds_it_as_a_value(text: str) -> None:
    for path, made in _of(text, ".yaml").items():
        assert not any("taint" in str(key) for key in yaml.safe_load(made) or {}), path


@each
def test_shells_run_nothing_of_it(tmp_path: Path, text: str) -> None:
    fences = {path: "".join(_FENCE.findall(page)) for path, page in _of(text, ".md").items()}
    for path, script in (fences | _of(text, ".sh", ".bash")).items():
        # bash itself is the judge: no program is found, and what is looked for is written down.
        ran = tmp_path / path.replace("/", "_")
        noted = f'command_not_found_handle() {{ echo "$1" >> {ran}; }}\nexec > {os.devnull} 2>&1\n'
        tried = subprocess.run(
            [_BASH, "-c", noted + script], env={"PATH": "/nothing"}, cwd=tmp_path, timeout=60, check=False
        )
        programs = set(ran.read_text().split()) if ran.exists() else set()
        assert not programs & {"taint", "touch", "env", "b", "c"}, path
        assert tried.returncode != 2, f"{path}: bash cannot read it"


@each
def test_markdown_shows_it_on_its_line(text: str) -> None:
    for path, page in _of(text, ".md").items():
        prose = _FENCE.sub("", page.split("-->", 1)[1])
        assert not re.search(r"(?m)^\s*([#>`-]+ ?|\d+\. )?(taint: 1|# taint|- taint|<script>|```)", prose), path
        parts = (part for line in prose.splitlines() for part in re.split(r"(?<!\\)\|", line))
        shown = "\n".join(re.sub(r"(?<!`)(`+)(?!`).*?(?<!`)\1(?!`)", "", part) for part in parts)
        assert not re.search(r"(?<!\\)<script|(?<!\\)\]\(http://taint|<!--", shown), path
        for line in prose.splitlines():
            if line.startswith("|"):
                assert not re.search(r"taint (?<!\\)\| b", line), path


@each
def test_mermaid_holds_it_within_a_label(text: str) -> None:
    for made in _of(text, ".mmd").values():
        for line in made.splitlines():
            assert not line.lstrip().startswith(("taint", "# taint", "- taint", "<script"))
            assert "<script>" not in line
            assert line.count('"') % 2 == 0


def test_the_name_of_the_file_is_one_word_on_one_line(tmp_path: Path) -> None:
    spec = tmp_path / "a\ntouch b; $(touch c) --> d.yaml"
    shutil.copy(spec_of("minimal"), spec)
    header = header_of(linked(spec))
    assert shlex.split(header.command)[2:] == ["cells/minimal/a touch b; $(touch c) --> d.yaml"]
    assert len(header.text.splitlines()) == 2
    assert markdown_comment(header.text).count("-->") == 1
