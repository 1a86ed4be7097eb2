"""Many cells in one call, each with several version tuples: one table, and files of the user that nobody touches."""

from __future__ import annotations

import json
from pathlib import Path
from shutil import copytree
from typing import Any

import jsonschema
import pytest

from cellc.compiler.spec.schema import schema_files
from cellc.contract.compute.work import ComputeError
from cellc.contract.limits import limits
from cellc.tools.cli.batch import _Asked, _on_shared_disk, _Unit, cell_files, compute, digest_of
from cellc.tools.cli.fleet import Task
from tests.cli.run import Ran, run

SPEC = """\
format: 1
cell: {name}
summary: a gripper
versions: {{ros: jazzy, os: ubuntu 24.04}}
devices:
  gripper:
    model: robotiq_2f_85
    mount: {{parent: world}}
control:
  update_rate: 100 Hz
  controllers:
    joint_states: {{type: joint_state_broadcaster}}
    gripper_action: {{type: {kind}, device: gripper}}
rehearsals:
  close: {{steps: [{{grip: close}}]}}
"""
TUPLES = ("--matrix", "ros=humble,jazzy")


@pytest.fixture(scope="module")
def cells(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("cells")
    for name, kind in (("first", "parallel_gripper"), ("second", "parallel_gripper"), ("wrong", "no_such_kind")):
        (folder / name).mkdir()
        (folder / name / "cell.yaml").write_text(SPEC.format(name=name, kind=kind), encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def built(cells: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    output = tmp_path_factory.mktemp("out")
    ran = run("build", (cells / "first").as_posix(), (cells / "second").as_posix(), *TUPLES, "-o", str(output))
    assert ran.code == 0, ran.out
    return output


def _rows(ran: Ran) -> list[dict[str, Any]]:
    told = json.loads(ran.out)
    jsonschema.validate(told, json.loads(schema_files()["fleet.schema.json"]))
    rows: list[dict[str, Any]] = told["rows"]
    assert told["passed"] == all(row["passed"] for row in rows)
    return rows


def _words(ran: Ran, of: str) -> list[str]:
    return next(line.split() for line in ran.out.splitlines() if line.split()[1:2] == [of])


def test_each_cell_is_checked_with_each_tuple_and_one_that_cannot_be_taken_is_a_row(cells: Path) -> None:
    ran = run("check", cells.as_posix(), *TUPLES, "--json")
    rows = _rows(ran)
    assert ran.code == 1
    assert [(row["cell"], row["versions"]["ros"], row["passed"]) for row in rows] == [
        ("first", "humble", True),
        ("first", "jazzy", True),
        ("second", "humble", True),
        ("second", "jazzy", True),
        ("", "humble", False),
        ("", "jazzy", False),
    ]
    assert [finding["code"] for finding in rows[-1]["findings"]] == ["unknown-controller-kind"]


def test_a_tuple_of_the_matrix_is_checked_as_if_it_were_written(cells: Path, tmp_path: Path) -> None:
    spec = cells / "first" / "cell.yaml"
    before = spec.read_bytes()
    (row,) = _rows(run("check", spec.as_posix(), "--matrix", "os=ubuntu 22.04", "--json"))
    by_hand = tmp_path / "cell.yaml"
    by_hand.write_text(before.decode().replace("ubuntu 24.04", "ubuntu 22.04"), encoding="utf-8")
    (written,) = _rows(run("check", by_hand.as_posix(), "--json"))
    assert [{**finding, "place": ""} for finding in row["findings"]] == [
        {**finding, "place": ""} for finding in written["findings"]
    ]
    assert "os-of-third-tier" in {finding["code"] for finding in row["findings"]}
    assert spec.read_bytes() == before


def test_findings_of_some_tuples_alone_stand_under_their_names(cells: Path) -> None:
    ran = run("check", (cells / "first").as_posix(), "--matrix", "os=ubuntu 22.04,ubuntu 24.04", "--select", "VER")
    heads = [line for line in ran.out.splitlines() if " with " in line]
    assert [head.rpartition(" with ")[2] for head in heads] == ["every tuple", "os=ubuntu 22.04"]
    assert ran.out.count("os-of-third-tier") == 1
    assert ran.out.endswith("2 of 2 passed\n")


def test_parts_are_combined_each_with_each_and_what_a_spec_does_not_write_is_told(cells: Path) -> None:
    spec = (cells / "first").as_posix()
    ran = run("check", spec, *TUPLES, "--matrix", "os=ubuntu 22.04", "--matrix", "moveit=2.5.9,2.12.4", "--json")
    tuples = [row["versions"] for row in _rows(ran)]
    assert [(one["ros"], one["os"], one["moveit"]) for one in tuples] == [
        ("humble", "ubuntu 22.04", "2.5.9"),
        ("humble", "ubuntu 22.04", "2.12.4"),
        ("jazzy", "ubuntu 22.04", "2.5.9"),
        ("jazzy", "ubuntu 22.04", "2.12.4"),
    ]
    assert {row["problem"].partition(": ")[2] for row in _rows(ran)} == {
        "`versions.moveit` must be in the spec to be replaced; UNKNOWN is enough"
    }


@pytest.mark.parametrize(
    ("matrix", "said"),
    [
        (("ros=foxy",), "`ros` must be one of humble, jazzy, kilted, lyrical, got `foxy`"),
        (("ros",), "got ``"),
        (("arm=ur5e",), "expected one of os, kernel, ros, rmw, ros2_control, moveit, got `arm`"),
        (("os=a", "os=b"), "names `os` twice"),
        (("rmw=",), "`rmw` cannot be ``"),
    ],
)
@pytest.mark.parametrize("command", ["check", "build", "mock"])
def test_a_part_or_a_text_that_no_tuple_has_is_refused(
    command: str, matrix: tuple[str, ...], said: str, cells: Path
) -> None:
    ran = run(command, cells.as_posix(), *(word for versions in matrix for word in ("--matrix", versions)))
    assert ran.code == 2
    assert said in ran.err


def test_build_writes_each_tuple_into_a_folder_of_its_own(cells: Path, built: Path) -> None:
    places = sorted(path.relative_to(built).parent.as_posix() for path in built.rglob("contract.json"))
    assert places == ["ros-humble/first", "ros-humble/second", "ros-jazzy/first", "ros-jazzy/second"]
    distros = {
        place: json.loads((built / place / "contract.json").read_text(encoding="utf-8"))["distro"] for place in places
    }
    assert all(place.startswith(f"ros-{distro}/") for place, distro in distros.items())
    up_to_date = run("build", (cells / "first").as_posix(), *TUPLES, "-o", str(built), "--check")
    assert (up_to_date.code, "2 of 2 passed" in up_to_date.out) == (0, True)


def test_the_mock_rehearses_every_generated_folder_below_one(built: Path) -> None:
    ran = run("mock", built.as_posix(), "--jobs", "1")
    assert ran.code == 0
    assert [line.split()[1:] for line in ran.out.splitlines()[1:-1]] == [
        [name, distro, "1", "of", "1"] for distro in ("humble", "jazzy") for name in ("first", "second")
    ]


def test_one_generated_folder_below_another_or_named_twice_is_a_row_too(built: Path, tmp_path: Path) -> None:
    one = (built / "ros-jazzy/first").as_posix()
    copytree(one, tmp_path / "one/first")
    for named in ((tmp_path / "one").as_posix(),), (one, one):
        ran = run("mock", *named)
        assert (ran.code, _words(ran, "first")) == (0, ["passed", "first", "jazzy", "1", "of", "1"])
    (tmp_path / "one/first/contract.json").write_text("{", encoding="utf-8")
    ran = run("mock", (tmp_path / "one").as_posix())
    assert ran.code == 2
    assert "contract.json: is not JSON" in ran.out


def test_a_pattern_that_matches_one_folder_stands_for_it(built: Path) -> None:
    ran = run("mock", (built / "ros-jazzy/fir*").as_posix())
    assert (ran.code, ran.err) == (0, "")
    assert ran.out.startswith("passed  close: succeeded (expected succeeded)")


def test_a_folder_that_cannot_be_executed_is_a_row_and_the_worst_code_counts(built: Path, tmp_path: Path) -> None:
    ran = run("mock", (built / "ros-jazzy/first").as_posix(), tmp_path.as_posix(), "--json", "--jobs", "1")
    assert ran.code == 2
    assert [row["passed"] for row in _rows(ran)] == [True, False]
    assert "holds no contract.json" in _rows(ran)[1]["problem"]


@pytest.mark.parametrize(("command", "told"), [("mock", ["1", "of", "1"]), ("sweep", [])])
def test_the_mock_builds_cells_with_a_matrix_for_the_time_of_the_call(
    command: str, told: list[str], cells: Path
) -> None:
    before = sorted(cells.rglob("*"))
    ran = run(command, (cells / "*").as_posix(), "--matrix", "ros=jazzy", "--jobs", "1")
    assert ran.code == 1
    assert _words(ran, "first") == ["passed", "first", "jazzy", "0", "9", "1", *told]
    assert "there is no kind of controller `no_such_kind`" in ran.out
    assert sorted(cells.rglob("*")) == before


@pytest.mark.parametrize(
    ("command", "option"),
    [
        ("mock", "--live"),
        ("mock", "--records=x"),
        ("mock", "--evidence=x"),
        ("mock", "--rehearsal=close"),
        ("sweep", "--evidence=x"),
        ("sweep", "--journal=x"),
        ("sweep", "--rehearsal=close"),
    ],
)
def test_what_is_about_one_folder_is_refused_for_many(command: str, option: str, built: Path) -> None:
    ran = run(command, built.as_posix(), option)
    assert ran.code == 2
    assert f"{option.partition('=')[0]} needs exactly one folder" in ran.err


def test_a_pattern_that_no_shell_has_replaced_stands_for_what_it_matches(cells: Path) -> None:
    found = [Path(file).parent.name for file in cell_files([(cells / "*" / "cell.yaml").as_posix()])]
    assert found == ["first", "second", "wrong"]
    assert cell_files([(cells / "none*").as_posix()]) == ((cells / "none*").as_posix(),)


def test_a_worker_elsewhere_checks_a_cell_only_where_it_has_the_same_files(cells: Path) -> None:
    asked = _Asked("check", limits(), (), cells.as_posix())
    task = Task("first/cell.yaml", {"os": "ubuntu 22.04"})
    there = _on_shared_disk(asked, _Unit(task, digest_of((cells / task.file).as_posix())))
    here = compute("check", Task((cells / task.file).as_posix(), task.versions))
    assert [diagnostic.code for diagnostic in there.findings.diagnostics] == [
        diagnostic.code for diagnostic in here.findings.diagnostics
    ]
    assert {diagnostic.span.file for diagnostic in there.findings.diagnostics} == {task.file}
    with pytest.raises(ComputeError, match=r"a worker does not have `first/cell\.yaml` in `.*` as it is here"):
        _on_shared_disk(asked, _Unit(task, "another"))
