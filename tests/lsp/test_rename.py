"""Where a cell speaks of a name, another name for it, and what is refused with its reason."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.source import SourceDocument, read
from cellc.contract.diagnostics import YamlPath
from cellc.tools.lsp.rename import Name, RenameRefusedError, name_at, renamed
from cellc.tools.review.renames import SECTIONS
from tests.cells import spec_of, there
from tests.lsp.renames import edited, faults_of_a_rename, names


def _first_of_each_kind() -> list[YamlPath]:
    kinds = {
        tuple("*" if part == path[-2] and len(path) > 3 else part for part in path[:-1]): path
        for path in names(there(read(spec_of("dual_ur")).value))
    }
    return list(kinds.values())


@pytest.mark.parametrize("path", _first_of_each_kind(), ids=lambda path: ".".join(map(str, path)))
def test_a_name_of_each_kind_can_become_another_one(path: YamlPath) -> None:
    assert list(faults_of_a_rename(there(read(spec_of("dual_ur")).value), path)) == []


def test_every_section_that_a_review_compares_is_tried() -> None:
    tried = {path[0] for cell in ("dual_ur", "minimal") for path in names(there(read(spec_of(cell)).value))}
    assert tried >= {section[0] for section in SECTIONS}


_ASKED = [
    # device and group have one name here: each keeps its own places
    ("hybrid_sdk", "groups: {a^rm:", ("motion", "groups", "arm"), 2),
    ("hybrid_sdk", "parent: a^rm/flange", ("devices", "arm"), 8),
    ("fr3_hand", "expect: ca^nceled", None, 0),
    ("ur5e_pick", "tc^p: tcp ", None, 0),
    ("ur5e_pick", "tcp: tc^p ", ("frames", "tcp"), 3),
    ("ur5e_pick", "detect: obj^ect", ("frames", "object"), 7),
    ("ur5e_pick", "{use: pick_^and_place, inject: {freeze", ("rehearsals", "pick_and_place"), 8),
    ("ur5e_pick", "tolerances: {pi^ck", ("motion", "goals", "pick"), 4),
    ("ur5e_pick", "independent_of: [control^_pc]", ("hosts", "control_pc"), 9),
    ("ur5e_pick", "mod^el: ur5e", None, 0),
    ("ur5e_pick", "joint: arm/wrist^_3_joint", None, 0),
    ("ur5e_pick", "from: cam^era", ("devices", "camera"), 6),
]


@pytest.mark.parametrize(("cell", "asked", "path", "count"), _ASKED)
def test_what_is_spoken_of_at_a_place(cell: str, asked: str, path: YamlPath | None, count: int) -> None:
    document = there(read(spec_of(cell)).value)
    found = _named(document, asked)
    assert (None if found is None else found.path) == path
    assert found is None or len(found.spans) == count


def _named(document: SourceDocument, asked: str) -> Name | None:
    text = document.texts[document.file]
    before = text[: text.index(asked.replace("^", "")) + asked.index("^")]
    found = name_at(document, document.file, before.count("\n") + 1, len(before.rpartition("\n")[2]) + 1)
    return None if found is None else found[0]


def test_a_device_takes_the_topics_along_that_its_driver_names_after_it() -> None:
    document = there(read(spec_of("ur5e_pick")).value)
    edits = renamed(document, there(_named(document, "from: cam^era")), "eye", {})
    text = edited(document, edits)[document.file]
    assert "\n  /eye/color/image_raw:\n" in text
    assert "model: realsense_d435i" in text
    assert "carries: [camera, bag]" in text


def test_a_device_may_have_the_name_of_a_frame() -> None:
    document = there(read(spec_of("ur5e_pick")).value)
    assert len(renamed(document, there(_named(document, "from: cam^era")), "world", {})) == 6


_REFUSED = [
    ("gripper", "there is a device `gripper` already, in line 40"),
    ("2arm", "`2arm` cannot be used in `devices`; use letters, digits and `_`, beginning with a letter"),
    ("my arm", "`my arm` cannot be used in `devices`; use letters, digits and `_`, beginning with a letter, such as"),
    ("task", "`task`"),
    ("", "a name has at least one character"),
]


@pytest.mark.parametrize(("new", "reason"), _REFUSED)
def test_a_name_that_cannot_be_is_refused_with_its_reason(new: str, reason: str) -> None:
    document = there(read(spec_of("ur5e_pick")).value)
    with pytest.raises(RenameRefusedError) as refused:
        renamed(document, there(_named(document, "from: cam^era")), new, {})
    assert reason in str(refused.value)


def test_a_cell_with_errors_is_not_renamed(tmp_path: Path) -> None:
    spec = tmp_path / "cell.yaml"
    spec.write_text(spec_of("ur5e_pick").read_text(encoding="utf-8").replace("nic: bulk", "nic: bluk"))
    document = there(read(spec).value)
    with pytest.raises(RenameRefusedError, match=r"correct the errors first: .*there is no network card `bluk`"):
        renamed(document, there(_named(document, "from: cam^era")), "eye", {})


_PART = "hosts: {control_pc: {scheduling: generic}}\n"
_CELL = """\
format: 1
cell: line
summary: two cells of one computer
include: hosts.yaml
versions: {ros: jazzy}
control: {update_rate: 100 Hz, host: control_pc, controllers: {joint_states: {type: joint_state_broadcaster}}}
devices: {arm: {model: ur5e, mount: {parent: world}}}
"""


def test_a_file_of_two_cells_keeps_its_names(tmp_path: Path) -> None:
    (tmp_path / "hosts.yaml").write_text(_PART)
    for file in ("cell.yaml", "two.yaml"):
        (tmp_path / file).write_text(_CELL)
    one, two = (there(read(tmp_path / file).value) for file in ("cell.yaml", "two.yaml"))
    name = there(_named(one, "host: control^_pc"))
    assert [span.file.rpartition("/")[2] for span in name.spans] == ["hosts.yaml", "cell.yaml"]
    assert len(renamed(one, name, "computer", {})) == 2
    with pytest.raises(RenameRefusedError, match=r"two.yaml` includes the same file, and would have: there is no"):
        renamed(one, name, "computer", {two.file: two})


def test_an_anchor_that_says_two_things_is_left_alone(tmp_path: Path) -> None:
    spec = tmp_path / "cell.yaml"
    text = _CELL.replace("include: hosts.yaml\n", _PART).replace("cell: line", "cell: &name control_pc")
    spec.write_text(text.replace("host: control_pc", "host: *name"))
    document = there(read(spec).value)
    with pytest.raises(RenameRefusedError, match="an anchor"):
        renamed(document, there(_named(document, "hosts: {control^_pc")), "computer", {})
