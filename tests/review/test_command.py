"""What a user of ``cellc diff`` sees: arguments as those of `git diff`, exit codes, and each format."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest

from cellc.spec.schema import schema_files
from tests.cells import generated
from tests.cli.run import run
from tests.review.revisions import SPEC, Repository, edited, new_repository

FASTER = ("limits: {velocity: 50 %", "limits: {velocity: 60 %")
RENAMED = ("  /object_pose:", "  /part_pose:")


@pytest.fixture(scope="module")
def repository(tmp_path_factory: pytest.TempPathFactory) -> Repository:
    """Return a repository of these tests alone, with two branches and an edit in the work tree."""
    repository = new_repository(tmp_path_factory.mktemp("command"))
    for branch, edit in (("faster", FASTER), ("renamed", RENAMED)):
        repository.git("branch", branch, repository.commit(edited(edit)))
    repository.git("checkout", "-q", "main")
    return repository


@pytest.fixture
def _inside(repository: Repository, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(repository.folder)


@pytest.mark.usefixtures("_inside")
def test_a_diff_ends_with_one_and_begins_with_its_sum() -> None:
    ran = run("diff", "main..faster", SPEC)
    assert (ran.code, ran.err) == (1, "")
    lines = ran.out.splitlines()
    assert lines[0] == f"faster:{SPEC}: 1 change: 1 dangerous"
    assert lines[1].startswith(f"before  main:{SPEC}, cfg-")
    assert "      90 deg/s -> 108 deg/s (+20 %)" in lines
    assert (
        "      the joint may go further or faster than people at the cell know it; approval controller: controls"
        in lines
    )
    # A limit is looked at by G1, and everything after it rests on that.
    assert [
        line.split()[0] for line in lines[lines.index("to be passed again, for their evidence counts no longer") + 1 :]
    ] == [f"G{number}" for number in range(1, 8)]


@pytest.mark.usefixtures("_inside")
def test_one_path_is_head_against_the_work_tree(repository: Repository) -> None:
    ran = run("diff", SPEC)
    assert (ran.code, ran.out.splitlines()[0]) == (0, f"{SPEC}: no change")
    repository.write(edited(FASTER))
    try:
        assert run("diff", SPEC).out.splitlines()[0] == f"{SPEC}: 1 change: 1 dangerous"
        assert run("diff", "faster", SPEC).code == 0
        assert run("diff", f"faster:{SPEC}", SPEC).code == 0
    finally:
        repository.git("checkout", "-q", SPEC)


@pytest.mark.usefixtures("_inside")
def test_three_dots_are_what_a_branch_did_since_it_left_the_other() -> None:
    assert "1 change: 1 dangerous" in run("diff", "renamed...faster", SPEC).out.splitlines()[0]
    assert "3 changes" in run("diff", "renamed..faster", SPEC).out.splitlines()[0]


@pytest.mark.usefixtures("_inside")
def test_breaking_fails_only_where_a_consumer_outside_breaks() -> None:
    assert run("diff", "main..faster", SPEC, "--breaking").code == 0
    ran = run("diff", "main..renamed", SPEC, "--breaking")
    assert ran.code == 1
    assert ran.out.splitlines()[0].endswith("; 1 breaks consumers outside of the cell")


@pytest.mark.usefixtures("_inside")
def test_json_is_what_its_schema_says() -> None:
    ran = run("diff", "main..renamed", SPEC, "--format", "json")
    assert ran.code == 1
    found = json.loads(ran.out)
    jsonschema.validate(found, json.loads(schema_files()["review.schema.json"]))
    assert [change["subjects"] for change in found["changes"]] == [["/part_pose"], ["/object_pose"]]
    assert {change["owner"] for change in found["changes"]} == {"integration"}


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("nowhere.yaml",), "nowhere.yaml` is not in revision"),
        (("nosuch..main", SPEC), "there is no revision `nosuch`"),
        (("--", "-x..main", SPEC), "`-x` is no revision"),
        (("main:nowhere.yaml", SPEC), "`nowhere.yaml` is not in revision"),
        (("main", SPEC, SPEC), "expected one or two of spec, folder and revision, got 3"),
        (("/dev/null", SPEC), "/dev/null"),
        (("cells", SPEC), "manifest.json: is missing from the generated folder"),
    ],
)
@pytest.mark.usefixtures("_inside")
def test_what_cannot_be_read_ends_with_two_and_one_line(arguments: tuple[str, ...], said: str) -> None:
    ran = run("diff", *arguments)
    assert ran.code == 2
    assert said in ran.err
    assert "Traceback" not in ran.err


def test_a_spec_with_errors_is_not_compared(tmp_path: Path) -> None:
    spec = tmp_path / "cell.yaml"
    spec.write_text(edited(("update_rate: 500 Hz", "update_rate: 250 Hz")), encoding="utf-8")
    ran = run("diff", generated("ur5e_pick").as_posix(), spec.as_posix())
    assert ran.code == 2
    assert "`update_rate` for `arm` must be 500 Hz, got 250 Hz; see `cellc check`" in ran.err


def test_outside_of_a_repository_a_revision_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", "")
    ran = run("diff", "main..HEAD", "cell.yaml")
    assert ran.code == 2
    assert "in no git repository that may be read" in ran.err
