"""The evidence folder: all of it or nothing, and nothing of anybody else is touched."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader

from cellc.mock import MockCell
from cellc.mock.errors import MockError
from cellc.mock.evidence.folder import file_names
from tests.mock.conftest import Written, write_evidence


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_index_names_every_file_with_its_hash(written: Written) -> None:
    index = json.loads((written.folder / "evidence.json").read_text(encoding="utf-8"))
    files = contents(written.folder)
    del files["evidence.json"]
    assert index["files"] == {name: hashlib.sha256(data).hexdigest() for name, data in files.items()}
    assert sorted(files) == sorted(
        [f"{name}.{kind}" for name in written.results for kind in ("mcap", "records.jsonl", "kpis.json")]
        + ["report.html", "layout.json"]
    )


def test_folder_is_replaced_and_files_of_others_stay(cell: MockCell, tmp_path: Path) -> None:
    folder = tmp_path / "evidence"
    write_evidence(cell, folder, "canceled", "stale_camera")
    (folder / "signed.md").write_text("by hand")
    write_evidence(cell, folder, "canceled", seed=1)
    assert sorted(contents(folder)) == [
        "canceled.kpis.json",
        "canceled.mcap",
        "canceled.records.jsonl",
        "evidence.json",
        "layout.json",
        "report.html",
        "signed.md",
    ]
    assert json.loads((folder / "evidence.json").read_text(encoding="utf-8"))["seed"] == 1
    assert [path.name for path in tmp_path.iterdir()] == ["evidence"]


@pytest.mark.parametrize("name", ["report.html", "canceled.records.jsonl"])
def test_file_edited_by_hand_is_not_overwritten(name: str, cell: MockCell, tmp_path: Path) -> None:
    write_evidence(cell, tmp_path / "evidence", "canceled")
    (tmp_path / "evidence" / name).write_text("mine")
    before = contents(tmp_path / "evidence")
    with pytest.raises(MockError, match=f"{name}: is not as cellc wrote it"):
        write_evidence(cell, tmp_path / "evidence", "canceled")
    assert contents(tmp_path / "evidence") == before
    assert [path.name for path in tmp_path.iterdir()] == ["evidence"]


def test_foreign_file_of_the_same_name_is_not_overwritten(cell: MockCell, tmp_path: Path) -> None:
    (tmp_path / "report.html").write_text("somebody else's")
    with pytest.raises(MockError, match="is not as cellc wrote it"):
        write_evidence(cell, tmp_path, "canceled")
    assert (tmp_path / "report.html").read_text() == "somebody else's"


def _interrupt(content: object) -> str:
    raise KeyboardInterrupt


def test_interrupted_call_leaves_the_folder_as_it_was(
    cell: MockCell, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "evidence"
    write_evidence(cell, folder, "canceled")
    before = contents(folder)
    monkeypatch.setattr("cellc.mock.command.evidence.to_report", _interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_evidence(cell, folder, "canceled", seed=3)
    assert contents(folder) == before
    assert [path.name for path in tmp_path.iterdir()] == ["evidence"]


def test_swap_that_fails_puts_every_file_back(cell: MockCell, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "evidence"
    write_evidence(cell, folder, "canceled")
    before = contents(folder)
    put = []

    def fail(swap: object, path: str) -> None:
        put.append(path)
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("cellc.contract.store.swap.Swap.settle", lambda swap: fail(swap, ""))
    with pytest.raises(MockError, match="no space left on device"):
        write_evidence(cell, folder, "canceled", seed=9)
    assert put
    assert contents(folder) == before
    assert [path.name for path in tmp_path.iterdir()] == ["evidence"]


def test_file_in_place_of_the_folder_is_refused(cell: MockCell, tmp_path: Path) -> None:
    (tmp_path / "evidence").write_text("a file")
    with pytest.raises(MockError, match="is not a folder"):
        write_evidence(cell, tmp_path / "evidence", "canceled")


def test_index_of_a_stranger_makes_nothing_else_disappear(cell: MockCell, tmp_path: Path) -> None:
    folder = tmp_path / "evidence"
    folder.mkdir()
    (tmp_path / "precious").write_text("x")
    digest = hashlib.sha256(b"x").hexdigest()
    (folder / "evidence.json").write_text(json.dumps({"files": {"../precious": digest}}))
    write_evidence(cell, folder, "canceled")
    assert (tmp_path / "precious").read_text() == "x"


def test_names_of_rehearsals_become_names_of_files_on_every_file_system() -> None:
    names = ["pick", "Pick", "../up", "a/b", ".hidden", "", "ü", "report", "x" * 300, "con|aux", "NUL", "aux.1"]
    stems = file_names(names)
    assert stems["pick"] == "pick"
    assert len({stem.casefold() for stem in stems.values()}) == len(names)
    for stem in stems.values():
        assert stem not in ("report", "evidence")
        assert not stem.startswith(".")
        assert stem.partition(".")[0].casefold() not in ("aux", "nul")
        assert all(char.isascii() and (char.isalnum() or char in "_.-% ") for char in stem)
        assert len(f"{stem}.records.jsonl") < 255


def test_layout_for_foxglove_names_topics_of_the_bags_and_panels_that_it_places(written: Written) -> None:
    layout = json.loads((written.folder / "layout.json").read_text(encoding="utf-8"))
    with written.bag("canceled").open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    types = {each.topic: summary.schemas[each.schema_id].name for each in summary.channels.values()}
    panels = layout["configById"]
    (scene,) = panels["3D!cell"]["topics"]
    positions, errors = (panels[f"Plot!{name}"]["paths"][0]["value"] for name in ("positions", "errors"))
    diagnostics, attempts = (
        panels["DiagnosticSummary!all"]["topicToRender"],
        panels["RawMessages!attempts"]["topicPath"],
    )
    shown = (scene, positions, errors, diagnostics, attempts)
    assert [types[topic.split(".")[0]] for topic in shown] == [
        "std_msgs/msg/String",
        "sensor_msgs/msg/JointState",
        "control_msgs/msg/JointTrajectoryControllerState",
        "diagnostic_msgs/msg/DiagnosticArray",
        "std_msgs/msg/String",
    ]
    assert positions.endswith(".position[:]")
    assert errors.endswith(".error.positions[:]")
    assert sorted(_leaves(layout["layout"])) == sorted(panels)


def _leaves(node: Any) -> list[str]:
    return [node] if isinstance(node, str) else [*_leaves(node["first"]), *_leaves(node["second"])]
