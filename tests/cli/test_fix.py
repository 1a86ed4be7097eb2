"""``cellc check --fix`` mends what has one safe answer, and nothing else of the file."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from cellc.tools.edit.rewrite import Edit, apply_edits, rewrite
from tests.cells import ROOT
from tests.cli.run import PICK, run

PICK_TEXT = Path(PICK).read_text(encoding="utf-8")


def write(folder: Path, text: str) -> Path:
    """Write a spec that lies as deep under the schemas as those of the repository."""
    (folder / "schemas").mkdir(exist_ok=True)
    (folder / "schemas/cell.schema.json").write_text("{}")
    file = folder / "cells/pick/cell.yaml"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(text.encode("utf-8"))
    return file


def fixed(folder: Path, text: str) -> str:
    file = write(folder, text)
    run("check", file.as_posix(), "--fix")
    return file.read_bytes().decode("utf-8")


def test_misspelt_key_is_mended_and_everything_else_stays(tmp_path: Path) -> None:
    assert "    firmware: polyscope 5.21.0\n" in PICK_TEXT
    broken = PICK_TEXT.replace("    firmware: polyscope", "    firmwre: polyscope")
    assert fixed(tmp_path, broken) == PICK_TEXT


def test_key_in_quotes_is_mended_between_them(tmp_path: Path) -> None:
    broken = PICK_TEXT.replace("    firmware: polyscope", '    "firmwre": polyscope')
    assert fixed(tmp_path, broken) == PICK_TEXT.replace("    firmware: polyscope", '    "firmware": polyscope')


def test_reference_is_left_to_a_person_who_sees_the_fix_in_the_report(tmp_path: Path) -> None:
    broken = PICK_TEXT.replace("frame: fixture_A", "frame: fixtre_A")
    assert fixed(tmp_path, broken) == broken
    ran = run("check", (tmp_path / "cells/pick/cell.yaml").as_posix(), "--format", "json")
    (fix,) = [found["fix"] for found in json.loads(ran.out)["diagnostics"] if found["fix"] is not None]
    line = broken.split("\n")[fix["line"] - 1]
    assert line[fix["column"] - 1 : fix["end_column"] - 1] == "fixtre_A"
    assert (fix["text"], fix["sure"]) == ("fixture_A", False)


def test_several_keys_and_one_below_another_are_mended_in_one_call(tmp_path: Path) -> None:
    broken = PICK_TEXT.replace("recovery: {states", "recovry: {states").replace(
        "observer: operator", "observr: operator"
    )
    broken = broken.replace("kpis: {", "kpi: {")
    assert fixed(tmp_path, broken) == PICK_TEXT


def test_what_was_done_is_told_on_standard_error(tmp_path: Path) -> None:
    file = write(tmp_path, PICK_TEXT.replace("    firmware: polyscope", "    firmwre: polyscope"))
    ran = run("check", file.as_posix(), "--fix", "--format", "json")
    line = PICK_TEXT.split("    firmware: polyscope")[0].count("\n") + 1
    assert f"{file.as_posix()}:{line}: `firmwre` becomes `firmware`" in ran.err
    assert ran.out.startswith("{")


def test_fixing_twice_changes_nothing_more(tmp_path: Path) -> None:
    once = fixed(tmp_path, PICK_TEXT.replace("motion:", "motoin:").split("\n", 1)[1])
    assert fixed(tmp_path, once) == once


def test_line_breaks_and_byte_order_mark_stay(tmp_path: Path) -> None:
    windows = "\ufeff" + PICK_TEXT.replace("\n", "\r\n")
    assert fixed(tmp_path, windows.replace("kpis:", "kpsi:")) == windows


def test_missing_modeline_is_put_first_with_the_way_to_the_schema(tmp_path: Path) -> None:
    without = PICK_TEXT.split("\n", 1)[1]
    assert fixed(tmp_path, without) == PICK_TEXT


def test_modeline_of_another_schema_stays(tmp_path: Path) -> None:
    other = PICK_TEXT.replace("../../schemas/", "https://example.org/")
    assert fixed(tmp_path, other) == other


def test_no_modeline_is_written_where_no_schema_is_near(tmp_path: Path) -> None:
    file = tmp_path / "cell.yaml"
    file.write_text(PICK_TEXT.split("\n", 1)[1], encoding="utf-8")
    run("check", file.as_posix(), "--fix")
    assert file.read_text(encoding="utf-8") == PICK_TEXT.split("\n", 1)[1]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("cell: ur5e_pick", "cell: ur5e_pick\nsumary: again"),  # the right key stands there already
        ("kpis: {", "zzz: {"),  # nothing is near
        ("rehearsals:", "rehearse:"),  # near, but not near enough to change unread
        ("    max_age: 100 ms", "    max_rate: 100 ms"),  # near, and something else
    ],
)
def test_key_without_one_safe_answer_stays(tmp_path: Path, old: str, new: str) -> None:
    assert old in PICK_TEXT
    text = PICK_TEXT.replace(old, new, 1)
    assert fixed(tmp_path, text) == text


def test_key_in_an_included_file_is_mended_there(tmp_path: Path) -> None:
    start, end = PICK_TEXT.index("kpis: {"), len(PICK_TEXT)
    root = PICK_TEXT[:start] + "include: kpis.yaml\n"
    file = write(tmp_path, root)
    (file.parent / "kpis.yaml").write_text(
        "# ours\n" + PICK_TEXT[start:end].replace("cancel:", "cancl:"), encoding="utf-8"
    )
    run("check", file.as_posix(), "--fix")
    assert (file.parent / "kpis.yaml").read_text(encoding="utf-8") == "# ours\n" + PICK_TEXT[start:end]
    assert file.read_text(encoding="utf-8") == root


def test_file_that_is_no_yaml_stays(tmp_path: Path) -> None:
    assert fixed(tmp_path, "cell: [\n") == "cell: [\n"


def test_permissions_stay_and_a_link_stays_a_link(tmp_path: Path) -> None:
    file = write(tmp_path, PICK_TEXT.replace("kpis:", "kpsi:"))
    file.chmod(0o640)
    link = file.with_name("linked.yaml")
    link.symlink_to(file)
    run("check", link.as_posix(), "--fix")
    assert file.read_text(encoding="utf-8") == PICK_TEXT
    assert link.is_symlink()
    assert file.stat().st_mode & 0o777 == 0o640
    assert sorted(os.listdir(file.parent)) == ["cell.yaml", "linked.yaml"]


def test_check_without_fix_writes_nothing(tmp_path: Path) -> None:
    broken = PICK_TEXT.replace("kpis:", "kpsi:")
    file = write(tmp_path, broken)
    run("check", file.as_posix())
    assert file.read_text(encoding="utf-8") == broken


@pytest.mark.parametrize("cell", ["minimal", "ur5e_pick"])
def test_cells_of_the_repository_need_no_fix(cell: str, tmp_path: Path) -> None:
    text = (ROOT / "cells" / cell / "cell.yaml").read_text(encoding="utf-8")
    assert fixed(tmp_path, text) == text


def test_edits_of_one_line_do_not_move_each_other() -> None:
    edits = [Edit("f", 1, 1, 3, "long", ""), Edit("f", 1, 4, 5, "x", "")]
    assert apply_edits("ab c\r\nd", edits) == "long x\r\nd"


@pytest.mark.parametrize("key", ["max-age", "maxAge", "max_ag", "max_agee", "max_aeg", "mix_age"])
def test_one_slip_is_mended(key: str, tmp_path: Path) -> None:
    assert fixed(tmp_path, PICK_TEXT.replace("    max_age: 100 ms", f"    {key}: 100 ms")) == PICK_TEXT


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("update_rate: 500 Hz", "update_rate: 500 hz"),
        ("update_rate: 500 Hz", 'update_rate: "500 hertz"'),
        ("goal_time: 1 s", "goal_time: 1 sec"),
        ("xyz: 0 0 162 mm", "xyz: 0 0 162 millimetres"),
        ("rpy: 0 0 90 deg", "rpy: 0 0 90°"),
        ("limits: {velocity: 50 %", "limits: {velocity: 50 percent"),
    ],
)
def test_unit_in_another_spelling_is_mended(right: str, wrong: str, tmp_path: Path) -> None:
    assert right in PICK_TEXT
    mended = fixed(tmp_path, PICK_TEXT.replace(right, wrong, 1))
    # Only the unit is replaced: quotes and spaces stay as they were.
    assert mended.replace('"500 Hz"', "500 Hz").replace("90deg", "90 deg") == PICK_TEXT


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("update_rate: 500 Hz", "update_rate: 500"),  # no unit: 500 Hz or 500 kHz
        ("update_rate: 500 Hz", "update_rate: 500 mhz"),  # milli or mega
        ("update_rate: 500 Hz", "update_rate: 500 sec"),  # a duration in place of a frequency
        ("goal_time: 1 s", "goal_time: 1 fortnight"),
    ],
)
def test_unit_that_may_mean_something_else_stays(right: str, wrong: str, tmp_path: Path) -> None:
    text = PICK_TEXT.replace(right, wrong, 1)
    assert fixed(tmp_path, text) == text


def test_key_that_an_alias_brings_to_several_places_stays(tmp_path: Path) -> None:
    tcp = "  tcp: {parent: gripper/base, xyz: 0 0 162 mm, calibration: tcp_2f}\n"
    assert tcp in PICK_TEXT
    shared = "  tcp: &shared {parnt: gripper/base, xyz: 0 0 162 mm, calibration: tcp_2f}\n  other: *shared\n"
    text = PICK_TEXT.replace(tcp, shared)
    assert fixed(tmp_path, text) == text


def test_file_that_changed_meanwhile_is_left_alone(tmp_path: Path) -> None:
    file = tmp_path / "cell.yaml"
    file.write_text("new: 1\n", encoding="utf-8")
    assert not rewrite(file, [Edit("cell.yaml", 1, 1, 4, "old", "")], "was: 1\n")
    assert file.read_text(encoding="utf-8") == "new: 1\n"


def test_modeline_in_a_value_is_none(tmp_path: Path) -> None:
    text = (
        PICK_TEXT.split("\n", 1)[1]
        .replace("summary: UR5e", 'summary: "yaml-language-server: UR5e')
        .replace("wrist camera\n", 'wrist camera"\n', 1)
    )
    assert fixed(tmp_path, text).split("\n", 1) == [PICK_TEXT.split("\n", 1)[0], text]
