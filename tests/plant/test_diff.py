"""What `cellc diff` tells of a plant: its own lines, and which cells changed."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest

from tests.cli.run import run
from tests.plant.hall import hall

PLANT, LINE_2 = "plant.yaml", "line_2/cell.yaml"
MOVED = (PLANT, "xyz: 5 0 0 m", "xyz: 5.0005 0 0 m")


def changes(folder: Path, *edits: tuple[str, str, str]) -> list[tuple[str, str, str, bool]]:
    """Return subject, what changed, grade and whether it breaks consumers, of the plant and a changed copy."""
    before, after = hall(folder / "before").as_posix(), hall(folder / "after", *edits).as_posix()
    ran = run("diff", before, after, "--format", "json")
    assert ran.code == (1 if edits else 0), ran.err
    review: dict[str, Any] = json.loads(ran.out)
    assert (review["before"]["configuration_id"] == review["after"]["configuration_id"]) is (review["files"] == [])
    return [(each["subjects"][0], each["quantity"], each["grade"], each["breaking"]) for each in review["changes"]]


def test_the_same_plant_has_no_changes(tmp_path: Path) -> None:
    assert changes(tmp_path) == []


@pytest.mark.parametrize(
    ("edits", "expected"),
    [
        ([MOVED], [("line_2", "mount", "dangerous", False)]),
        ([(PLANT, "xyz: 5 0 0 m", "xyz: 5000 0 0 mm")], None),
        ([(PLANT, "owner: team_2", "owner: team_3")], [("line_2", "owner", "review", False)]),
        ([(PLANT, "owner: logistics", "owner: plc")], [("/line_1/part_ready", "owner", "review", False)]),
        ([(PLANT, "summary: Two lines that hand parts over at a fixture between them\n", "")],
         [("hall", "summary", "safe", False)]),
        ([(LINE_2, "team_2}\n  line", "team_3}\n  line")], [("line_2", "cell itself", "review", False)]),
        ([(LINE_2, "format: 1", "format: 1  # a comment")], None),
        ([(LINE_2, "max_age: 1 s", "max_age: 900 ms")], [("line_2", "cell itself", "review", False)]),
        ([(PLANT, "\ninterfaces:",
           "areas: {a: {parent: world, box: 1 1 1 m, granted_by: safety_plc}}\ninterfaces:")],
         [("a", "shared area", "dangerous", False)]),
    ],
    ids=lambda value: value[0][2][:30] if value and len(value[0]) == 3 else "",
)  # fmt: skip
def test_a_change_is_listed_with_its_grade(
    edits: list[tuple[str, str, str]], expected: list[tuple[str, str, str, bool]] | None, tmp_path: Path
) -> None:
    if expected is None:  # the same in other words
        before, after = hall(tmp_path / "before").as_posix(), hall(tmp_path / "after", *edits).as_posix()
        assert run("diff", before, after).code == 0
    else:
        assert changes(tmp_path, *edits) == expected


def test_a_topic_that_no_longer_crosses_breaks_who_hears_it(tmp_path: Path) -> None:
    before, after = hall(tmp_path / "before"), hall(tmp_path / "after")
    after.write_text(after.read_text(encoding="utf-8").partition("interfaces:")[0], encoding="utf-8")
    ran = run("diff", before.as_posix(), after.as_posix(), "--breaking", "--format", "json")
    assert ran.code == 1
    (change,) = json.loads(ran.out)["changes"]
    assert (change["subjects"], change["grade"], change["breaking"], change["owner"]) == (
        ["/line_1/part_ready"], "dangerous", True, "logistics",
    )  # fmt: skip


def test_the_work_tree_is_compared_with_a_revision_and_printed(tmp_path: Path) -> None:
    spec = hall(tmp_path)
    git = ["git", "-C", tmp_path.as_posix(), "-c", "user.name=a", "-c", "user.email=a@example.org"]
    for command in (["init", "-q"], ["add", "."], ["commit", "-qm", "one"]):
        subprocess.run([*git, *command], check=True)
    assert run("diff", spec.as_posix()).code == 0
    file = spec.parent / "line_2" / "cell.yaml"
    file.write_text(file.read_text(encoding="utf-8").replace("max_age: 1 s", "max_age: 900 ms"), encoding="utf-8")
    ran = run("diff", spec.as_posix())
    assert ran.code == 1
    assert "line_2" in ran.out
    assert "line_1 " not in ran.out
    assert run("diff", spec.as_posix(), "--format", "markdown").code == 1


def test_a_plant_is_not_compared_with_a_cell_nor_rehearsed(tmp_path: Path) -> None:
    spec = hall(tmp_path)
    cell = (spec.parent / "line_2" / "cell.yaml").as_posix()
    assert (run("diff", cell, spec.as_posix()).code, run("diff", spec.as_posix(), cell).code) == (2, 2)
    ran = run("diff", spec.as_posix(), spec.as_posix(), "--rehearse")
    assert (ran.code, "not supported in a plant yet" in ran.err) == (2, True)


def test_a_plant_with_errors_is_not_compared(tmp_path: Path) -> None:
    before, after = hall(tmp_path / "before"), hall(tmp_path / "after", (LINE_2, "rate: 2 Hz", "rate: 4 Hz"))
    ran = run("diff", before.as_posix(), after.as_posix())
    assert (ran.code, "see `cellc check`" in ran.err) == (2, True)
