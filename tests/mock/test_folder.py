"""A folder that cannot be executed is refused with its file and reason, never with a traceback."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from functools import reduce
from operator import getitem
from pathlib import Path
from typing import Any

import pytest

from cellc.contract.manifest import Manifest
from cellc.mock import MockCell, MockError, load
from cellc.mock.folder import differences
from cellc.mock.gates import sign_gates
from cellc.mock.gates.gate import gate_lines
from tests.cells import CELLS, ROOT, generated
from tests.cli.run import run
from tests.end_to_end.test_mock_runs import copy_the_mock
from tests.mock.conftest import LoadWith, fault

Edit = Callable[[Callable[[Any], None]], MockCell]


def refusal(folder: Path) -> MockError:
    with pytest.raises(MockError) as caught:
        load(folder, edited=True)
    assert "\n" not in caught.value.reason
    return caught.value


def test_folder_that_does_not_exist(tmp_path: Path) -> None:
    assert refusal(tmp_path / "absent").reason == "no such folder; name one that `cellc build` wrote"


def test_file_in_place_of_a_folder(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    assert refusal(tmp_path / "file").reason == "is not a folder; name one that `cellc build` wrote"


@pytest.mark.parametrize("name", ["rehearsals.json", "manifest.json", "config/controllers.yaml"])
def test_missing_file_is_named(folder: Path, name: str) -> None:
    (folder / name).unlink()
    error = refusal(folder)
    assert (error.file, error.reason) == (name, "is missing from the generated folder")


@pytest.mark.parametrize("content", [b"", b"{", b"[]", b"\xff\xfe", b"null", b'{"format": 2}', b"\x00" * 100])
@pytest.mark.parametrize("name", ["contract.json", "rehearsals.json", "manifest.json"])
def test_spoilt_json_is_refused(folder: Path, name: str, content: bytes) -> None:
    (folder / name).write_bytes(content)
    assert refusal(folder).file == name


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"name": "a\nb"}, "of the name 'a\\nb'"),
        ({"timeout_s": 1e300}, "`rehearsals.0.timeout_s`: must be from 1e-09 to 86400 s, got 1e+300"),
        (
            {"steps": [{"kind": "wait", "target": "", "duration_s": 1e10}]},
            "`rehearsals.0.steps.0.duration_s`: must be from 0 to 86400 s, got 1e+10",
        ),
    ],
)
def test_rehearsal_that_no_spec_makes_is_refused(load_with: LoadWith, changes: dict[str, Any], reason: str) -> None:
    with pytest.raises(MockError, match=re.escape(reason)):
        load_with(**changes)


@pytest.mark.parametrize(
    ("character", "as_it_is"),
    [("\x1b", False)]  # JSON forbids it as it is
    + [(character, way) for character in ("\x9b", "\u202e", "\u200b", "\U000e0041") for way in (True, False)],
)
def test_hidden_character_of_a_json_file_is_named_with_its_line(folder: Path, character: str, as_it_is: bool) -> None:
    file = folder / "contract.json"
    told = json.loads(file.read_text())
    told["summary"] = f"a{character}b"
    file.write_text(json.dumps(told, ensure_ascii=not as_it_is, indent=1))
    line = next(number for number, line in enumerate(file.read_text().split("\n"), 1) if "summary" in line)
    assert refusal(folder).reason == f"line {line}: the text holds the character U+{ord(character):04X}"


def test_hidden_character_of_other_files_is_refused_too(folder: Path) -> None:
    for name in ("config/controllers.yaml", "urdf/ur5e_pick.mock.urdf"):
        file = folder / name
        text = file.read_text()
        file.write_text(f"{text}<!-- \u202e -->\n" if name.endswith("urdf") else f"{text}# \u202e\n")
        assert refusal(folder).reason == f"line {text.count(chr(10)) + 1}: the text holds the character U+202E"
        file.write_text(text)
    file.write_text(text.replace("<link name=", '<link name="a&#x202E;"/><link name=', 1))
    assert "the text holds the character U+202E" in refusal(folder).reason


def test_two_rehearsals_of_one_name_are_refused(folder: Path) -> None:
    file = folder / "rehearsals.json"
    told = json.loads(file.read_text())
    told["rehearsals"].append(told["rehearsals"][0])
    file.write_text(json.dumps(told))
    assert "two rehearsals" in refusal(folder).reason


@pytest.mark.parametrize("content", ["", "<robot", "<sdf/>", "<robot name='empty'/>"])
def test_spoilt_urdf_is_refused(folder: Path, content: str) -> None:
    (folder / "urdf" / "ur5e_pick.mock.urdf").write_text(content)
    assert refusal(folder).file == "urdf/ur5e_pick.mock.urdf"


def test_wrong_type_is_named_with_its_place(edit_contract: Edit) -> None:
    with pytest.raises(MockError, match=r"contract\.json: `groups\.manipulator\.joints`"):
        edit_contract(lambda contract: contract["groups"]["manipulator"].update(joints=5))


def test_path_out_of_the_folder_is_refused(edit_contract: Edit) -> None:
    with pytest.raises(MockError, match=r"`files\.urdf_mock`: must be a path inside the folder"):
        edit_contract(lambda contract: contract["files"].update(urdf_mock="../../etc/passwd"))


def test_group_with_a_joint_that_the_urdf_lacks_is_refused(edit_contract: Edit) -> None:
    def rename(contract: Any) -> None:
        contract["groups"]["manipulator"]["joints"][0] = "missing"
        contract["joint_limits"]["missing"] = contract["joint_limits"]["arm_elbow_joint"]

    with pytest.raises(MockError, match=r"group `manipulator`.*`missing`"):
        edit_contract(rename)


@pytest.mark.parametrize(
    "path",
    ["groups.manipulator.controller", "devices.gripper.gripper.controller", "devices.arm.speed_scaling_interface"],
)
def test_controller_or_interface_that_nothing_has_is_refused(edit_contract: Edit, path: str) -> None:
    def rename(contract: Any) -> None:
        *above, last = path.split(".")
        reduce(getitem, above, contract)[last] = "nobody"

    with pytest.raises(MockError, match=r"must .*`nobody`"):
        edit_contract(rename)


def test_fault_on_something_unknown_is_refused(load_with: LoadWith) -> None:
    with pytest.raises(MockError, match="fault `protective_stop` names `robot`"):
        load_with(fault("protective_stop", "robot", 1.0)).run("faulty")


def test_unknown_rehearsal_lists_those_that_exist(cell: MockCell) -> None:
    with pytest.raises(MockError, match=r"it has `pick_and_place`, `stale_camera`, .*`canceled`"):
        cell.run("pick")


def test_folder_as_generated_has_no_notes(cell: MockCell) -> None:
    assert cell.notes == ()


@pytest.mark.parametrize("name", ["config/controllers.yaml", "gates/promotion.md"])
def test_edit_by_hand_is_refused_with_the_file_and_what_to_do(folder: Path, name: str) -> None:
    path = folder / name
    path.write_text(path.read_text() + "# by hand\n")
    edit = f"`{name}` differs from the manifest: it was edited after it was generated"
    with pytest.raises(MockError) as caught:
        load(folder)
    assert caught.value.reason.startswith(f"{edit}; build it again, or take `--edited`")
    assert load(folder, edited=True).notes == (edit,)


@pytest.mark.parametrize("name", CELLS)
def test_one_digit_more_or_less_in_any_file_of_a_cell_is_seen_and_its_file_named(name: str, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(generated(name), tmp_path / name))
    contract = load(folder).contract
    manifest = Manifest.model_validate_json((folder / "manifest.json").read_text())
    untouched = differences(folder, contract, manifest)
    assert untouched[0] == ()
    for path in manifest.files:
        text = (folder / path).read_text()
        last = [place for place, letter in enumerate(text) if letter.isalnum()][-1]
        (folder / path).write_text(text[:last] + text[last + 1 :])
        notes, edits, own_id = differences(folder, contract, manifest)
        assert edits == (path,)
        assert notes == (f"`{path}` differs from the manifest: it was edited after it was generated",)
        assert own_id != untouched[2]
        (folder / path).write_text(text)


def test_several_edits_are_counted(folder: Path) -> None:
    for name in ("config/controllers.yaml", "config/joint_limits.yaml"):
        (folder / name).write_text((folder / name).read_text() + "# by hand\n")
    with pytest.raises(
        MockError, match=r"`config/controllers\.yaml` differs from the manifest.*, and 1 more; build it"
    ):
        load(folder)


def test_file_that_is_executed_and_stands_in_no_manifest_is_an_edit(folder: Path) -> None:
    path = folder / "manifest.json"
    manifest = json.loads(path.read_text())
    del manifest["files"]["config/controllers.yaml"]
    path.write_text(json.dumps(manifest))
    with pytest.raises(MockError, match=r"`config/controllers\.yaml` is executed and not listed in the manifest"):
        load(folder)


def test_manifest_of_another_configuration_is_refused(folder: Path) -> None:
    path = folder / "manifest.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | {"configuration_id": "cfg-other"}))
    with pytest.raises(MockError, match="belongs to configuration `cfg-other`"):
        load(folder)
    assert any("belongs to configuration `cfg-other`" in note for note in load(folder, edited=True).notes)


def test_edited_folder_has_an_id_of_its_own_in_every_result(folder: Path, cell: MockCell) -> None:
    path = folder / "config" / "controllers.yaml"
    path.write_text(path.read_text() + "# by hand\n")
    edited = load(folder, edited=True)
    result = edited.run("canceled")
    ids = {record.configuration_id for record in result.attempts}
    assert result.edited
    assert ids == {edited.contract.configuration_id}
    assert edited.contract.configuration_id.startswith("edited-")
    path.write_text(path.read_text() + "# more\n")
    assert load(folder, edited=True).contract.configuration_id not in ids
    assert not cell.run("canceled").edited


def test_no_gate_of_an_edited_folder_is_signed(folder: Path, cell: MockCell) -> None:
    path = folder / "config" / "controllers.yaml"
    path.write_text(path.read_text() + "# by hand\n")
    edited = load(folder, edited=True)
    gates = sign_gates(edited.folder, (), 0)
    assert {gate.signature for gate in gates} == {None}
    lines = [line for line in gate_lines(gates) if "signed" in line]
    assert lines == [f"  not signed: {edited.contract.configuration_id}, the folder differs from its manifest"] * 4
    assert cell.contract.configuration_id not in "".join(lines)
    assert all(gate.signature for gate in sign_gates(cell.folder, (), 0))


def test_edited_folder_is_refused_and_run_by_the_command(folder: Path, tmp_path: Path) -> None:
    path = folder / "config" / "controllers.yaml"
    path.write_text(path.read_text() + "# by hand\n")
    refused = run("mock", str(folder), "--rehearsal", "canceled")
    assert (refused.code, "differs from the manifest" in refused.err) == (2, True)
    told = run("mock", str(folder), "--rehearsal", "canceled", "--edited", "--records", str(tmp_path / "records"))
    assert told.out.startswith("note: `config/controllers.yaml` differs from the manifest")
    assert "passed  canceled of an edited folder: canceled" in told.out
    assert '"configuration_id":"edited-' in (tmp_path / "records").read_text()
    as_json = json.loads(run("mock", str(folder), "--rehearsal", "canceled", "--edited", "--json").out)
    assert as_json["rehearsals"][0]["edited"] is True
    assert as_json["configuration_id"].startswith("edited-")


def test_command_says_what_is_wrong_and_ends_with_two(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "cellc.mock", str(tmp_path)], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    reason = "holds no contract.json; name a folder that `cellc build` wrote"
    assert done.stderr == f"error: {tmp_path.as_posix()}: {reason}\n"


def test_mock_runs_without_the_rest_of_the_compiler(built_folder: Path, tmp_path: Path) -> None:
    copy_the_mock(tmp_path / "cellc")
    done = subprocess.run(
        [sys.executable, "-P", "-m", "cellc.mock", str(built_folder), "--json"]
        if sys.version_info >= (3, 11)
        else [sys.executable, "-m", "cellc.mock", str(built_folder), "--json"],
        cwd=tmp_path,
        env={"PYTHONPATH": str(tmp_path), "PATH": ""},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    summary = json.loads(done.stdout)
    assert {entry["name"]: entry["outcome"] for entry in summary["rehearsals"]} == {
        "pick_and_place": "succeeded",
        "stale_camera": "stale_state",
        "program_stopped": "claim_failure",
        "jogged_and_restarted": "succeeded",
        "stopped_and_resumed": "succeeded",
        "gripper_activated": "succeeded",
        "canceled": "canceled",
        **dict.fromkeys(("no_part", "wrong_part", "lost_part", "slipped"), "grip_failure"),
    }
    assert all(entry["passed"] for entry in summary["rehearsals"])


@pytest.mark.parametrize("name", ["config/controllers.yaml", "urdf", "contract.json"])
def test_link_out_of_the_folder_is_not_followed(name: str, folder: Path, tmp_path: Path) -> None:
    away = tmp_path / "away"
    away.mkdir()
    (folder / name).rename(away / "target")
    (folder / name).symlink_to(away / "target")
    assert refusal(folder).reason == "is a link that leads out of the folder"


def test_link_within_the_folder_is_followed(folder: Path) -> None:
    (folder / "config").rename(folder / "settings")
    (folder / "config").symlink_to("settings")
    assert load(folder, edited=True).contract.cell
