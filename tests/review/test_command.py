"""What a user of ``cellc diff`` sees: arguments as those of `git diff`, exit codes, and each format."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest

from cellc.compiler.spec.schema import schema_files
from tests.cells import ROOT, generated
from tests.cli.run import run
from tests.review.revisions import SMALL, Repository, edited, new_repository

LONGER = ("goal_time: 1 s", "goal_time: 2 s")
RENAMED = ("cell: minimal", "cell: bench")


@pytest.fixture(scope="module")
def repository(tmp_path_factory: pytest.TempPathFactory) -> Repository:
    """Return a repository of these tests alone, with two branches and an edit in the work tree."""
    repository = new_repository(tmp_path_factory.mktemp("command"), SMALL)
    for branch, edit in (("longer", LONGER), ("renamed", RENAMED)):
        repository.git("branch", branch, repository.commit(edited(edit, cell="minimal"), SMALL))
    repository.git("checkout", "-q", "main")
    return repository


@pytest.fixture
def _inside(repository: Repository, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(repository.folder)


@pytest.mark.usefixtures("_inside")
def test_a_diff_ends_with_one_and_begins_with_its_sum() -> None:
    ran = run("diff", "main..longer", SMALL)
    assert (ran.code, ran.err) == (1, "")
    lines = ran.out.splitlines()
    assert lines[0] == f"longer:{SMALL}: 1 cause (1 dangerous), 1 change"
    assert lines[1].startswith(f"before  main:{SMALL}, cfg-")
    cause = "control.controllers.arm_trajectory.goal_time: 1 s -> 2 s (+100 %)"
    # Tolerances are looked at by G2 and L6, and everything after them rests on that.
    assert lines[3:] == [
        f"dangerous  {cause}",
        "  (cell.yaml:16)",
        "  because a failure is noticed later",
        "  asks controller (UNKNOWN)",
        "gates to repeat: G2, G3, G4, G5, G6, G7, L6",
        "--all prints every value, finding and gate",
    ]


@pytest.mark.usefixtures("_inside")
def test_all_of_a_diff_has_every_value_with_its_reason_and_every_gate() -> None:
    lines = run("diff", "main..longer", SMALL, "--all").out.splitlines()
    assert lines[4].startswith("dangerous  control.controllers.arm_trajectory.goal_time")
    assert lines[5:8] == [
        "  dangerous control  arm_trajectory: time past the end",
        "      1 s -> 2 s (+100 %)",
        "      a failure is noticed later; approval controller: UNKNOWN",
    ]
    again = lines[lines.index("gates to repeat (their evidence is no longer valid)") + 1 :]
    assert [line.split()[0] for line in again] == ["G2", "G3", "G4", "G5", "G6", "G7", "L6"]


def test_a_spec_that_was_moved_makes_the_same_cell(tmp_path: Path) -> None:
    moved = tmp_path / "moved here" / "line.yaml"
    moved.parent.mkdir()
    moved.write_text((ROOT / SMALL).read_text(encoding="utf-8"), encoding="utf-8")
    ran = run("diff", generated("minimal").as_posix(), moved.as_posix())
    assert (ran.code, ran.out.partition(";")[0]) == (0, f"{moved.as_posix()}: no change")


@pytest.mark.usefixtures("_inside")
def test_one_path_is_head_against_the_work_tree(repository: Repository) -> None:
    ran = run("diff", SMALL)
    assert (ran.code, ran.out.splitlines()[0]) == (0, f"{SMALL}: no change")
    repository.write(edited(LONGER, cell="minimal"), SMALL)
    try:
        assert run("diff", SMALL).out.splitlines()[0] == f"{SMALL}: 1 cause (1 dangerous), 1 change"
        assert run("diff", "longer", SMALL).code == 0
        assert run("diff", f"longer:{SMALL}", SMALL).code == 0
    finally:
        repository.git("checkout", "-q", SMALL)


@pytest.mark.usefixtures("_inside")
def test_three_dots_are_what_a_branch_did_since_it_left_the_other() -> None:
    assert "1 cause (1 dangerous), 1 change" in run("diff", "renamed...longer", SMALL).out.splitlines()[0]
    assert "2 changes" in run("diff", "renamed..longer", SMALL).out.splitlines()[0]


@pytest.mark.usefixtures("_inside")
def test_breaking_fails_only_where_a_consumer_outside_breaks() -> None:
    assert run("diff", "main..longer", SMALL, "--breaking").code == 0
    ran = run("diff", "main..renamed", SMALL, "--breaking")
    assert ran.code == 1
    assert ran.out.splitlines()[0].endswith("1 change;")
    assert ran.out.splitlines()[1] == "  1 may break consumers outside the cell"


@pytest.mark.usefixtures("_inside")
def test_json_is_what_its_schema_says() -> None:
    ran = run("diff", "main..renamed", SMALL, "--format", "json")
    assert ran.code == 1
    found = json.loads(ran.out)
    jsonschema.validate(found, json.loads(schema_files()["review.schema.json"]))
    (change,) = found["changes"]
    assert (change["before"], change["after"], change["grade"], change["breaking"]) == (
        "minimal",
        "bench",
        "review",
        True,
    )


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("nowhere.yaml",), "there is no file or folder `nowhere.yaml`"),
        (("main..longer",), "expected a spec or a folder after `main..longer`"),
        (("nosuch..main", SMALL), "there is no revision `nosuch`"),
        (("--", "-x..main", SMALL), "`-x` is not a revision"),
        (("main:nowhere.yaml", SMALL), "revision `main` has no `nowhere.yaml`"),
        (("main", SMALL, SMALL), "expected one or two of spec, folder and revision, got 3"),
        (("/dev/null", SMALL), "/dev/null"),
        (("cells", SMALL), "has no `manifest.json`: it is not a generated folder"),
    ],
)
@pytest.mark.usefixtures("_inside")
def test_what_cannot_be_read_ends_with_two_and_one_line(arguments: tuple[str, ...], said: str) -> None:
    ran = run("diff", *arguments)
    assert ran.code == 2
    assert said in ran.err
    assert "Traceback" not in ran.err


def test_a_spec_with_errors_is_compared_and_one_that_cannot_be_linked_is_refused(tmp_path: Path) -> None:
    spec = tmp_path / "cell.yaml"
    spec.write_text(edited(("update_rate: 500 Hz", "update_rate: 250 Hz"), cell="minimal"), encoding="utf-8")
    ran = run("diff", generated("minimal").as_posix(), spec.as_posix())
    assert ran.code == 1
    assert f"note: {spec.as_posix()}: 1 error; `cellc check` lists them" in ran.out
    spec.write_text(edited(("parent: arm/tool0", "parent: arm/tool9"), cell="minimal"), encoding="utf-8")
    ran = run("diff", generated("minimal").as_posix(), spec.as_posix())
    assert ran.code == 2
    assert ran.err.endswith("see `cellc check`\n")


def test_outside_of_a_repository_a_revision_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", "")
    ran = run("diff", "main..HEAD", "cell.yaml")
    assert ran.code == 2
    assert "not in a readable Git repository" in ran.err
