"""Whatever text stands anywhere in a spec or a device: it is refused, or it is text in all that is made of them.

A share of ``python -m tests.emit.taint --all``, which gives every payload to every place.
"""

from __future__ import annotations

import shlex
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from cellc.compiler.deploy.configuration import header_of
from cellc.compiler.deploy.deployment import plan_deployment
from cellc.compiler.emit.launch.launch import emit
from cellc.compiler.formats.escape import markdown_comment
from cellc.compiler.graph.cell_graph import CellGraph
from tests.cells import ROOT, graph_of, linked, spec_of
from tests.emit.taint.cells import variants
from tests.emit.taint.judge import differences
from tests.emit.taint.judges import readings
from tests.emit.taint.payloads import PAYLOADS, twin_of
from tests.emit.taint.rounds import behind_the_readers, run

# Each with another part of the payloads; places of descriptions take the longest, and are tried by the script.
_ROUNDS = (("fr3_hand-lyrical", "single", 7), ("complete", "family", 1))


@pytest.mark.parametrize(("name", "kind", "turn"), _ROUNDS)
def test_every_place_refuses_a_hostile_text_or_it_is_text_everywhere(
    tmp_path: Path, name: str, kind: str, turn: int
) -> None:
    done = run(tmp_path, variants()[name], kind, turn, (".yaml",) if kind == "single" else (".yaml", ".urdf"))
    assert not done.faults
    assert len(done.trial.refused) > 200
    assert len(done.trial.taken) > 10


def test_what_launch_and_xacro_would_evaluate_is_text_even_where_a_reader_lets_it_in(tmp_path: Path) -> None:
    with behind_the_readers():
        done = run(tmp_path, variants()["ur5e_pick-jazzy"], "single", 0, (".yaml",))
    assert not done.faults
    assert any("$(" in text for text in done.trial.taken.values())


# No XML holds the others.
_IN_XML = {name: text for name, text in PAYLOADS.items() if "\0" not in text and text.isprintable()}


@pytest.mark.parametrize("payload", list(_IN_XML.values()), ids=list(_IN_XML))
def test_names_of_nodes_and_their_topics_are_text_in_launch_files_whatever_readers_refuse(payload: str) -> None:
    text = f"tq0001q{payload}"
    harmless = twin_of(text)
    assert not list(differences(_launched_with(text), _launched_with(harmless), {harmless: text}))


def _launched_with(name: str) -> dict[str, str]:
    """Return the launch files of a cell whose nodes, topics and addresses have a name that no reader lets in."""
    graph = graph_of(spec_of("ur5e_pick"))
    nodes = tuple(
        replace(node, name=name, namespace=f"/{name}", remaps={name: name}) if node.path[0] == "nodes" else node
        for node in graph.cell.nodes
    )
    devices = tuple(
        replace(
            device,
            site=replace(
                device.site, connection=device.site.connection and replace(device.site.connection, address=name)
            ),
        )
        for device in graph.cell.devices
    )
    changed: CellGraph = replace(graph, cell=replace(graph.cell, nodes=nodes, devices=devices))
    made = {artifact.path: artifact.text for artifact in emit(changed, plan_deployment(graph))}
    return {path: text for path, text in made.items() if path.endswith(".launch.xml")}


def test_every_generated_file_has_a_foreign_reader() -> None:
    files = [path for path in (ROOT / "generated").rglob("*") if path.is_file()]
    assert len(files) > 90
    for path in files:
        assert readings(path.as_posix(), path.read_text(encoding="utf-8"))


@pytest.mark.parametrize(
    ("path", "hostile"),
    [
        ("a.urdf", '<robot name="a"><link name="{}"/></robot>'),
        ("launch/a.launch.xml", '<launch><node exec="{}"/></launch>'),
        ("a.yaml", "a: {}\n"),
        ("a.json", '{{"a": "{}"}}'),
        ("a.bash", "echo {}\n"),
        ("README.md", "# a\n\nb {} c\n"),
        ("graph/a.svg", '<svg xmlns="http://www.w3.org/2000/svg"><text>{}</text></svg>'),
    ],
)
def test_a_text_that_is_written_as_it_is_would_be_seen(path: str, hostile: str) -> None:
    texts = {twin_of(f"tq0001q {payload}"): f"tq0001q {payload}" for payload in PAYLOADS.values()}
    seen = [
        payload
        for twin, payload in texts.items()
        if list(differences({path: hostile.format(payload)}, {path: hostile.format(twin)}, {twin: payload}))
    ]
    assert len(seen) >= 2, path
    assert readings(path, hostile.format("a"))


def test_the_name_of_the_file_is_one_word_on_one_line(tmp_path: Path) -> None:
    spec = tmp_path / "a\ntouch b; $(touch c) --> d.yaml"
    shutil.copy(spec_of("minimal"), spec)
    header = header_of(linked(spec))
    assert shlex.split(header.command)[2:] == ["cells/minimal/a touch b; $(touch c) --> d.yaml"]
    assert len(header.text.splitlines()) == 2
    assert markdown_comment(header.text).count("-->") == 1
