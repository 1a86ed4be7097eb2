"""What is told of a place, asked without the protocol: texts that are being written above all."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cellc.compiler.catalog.compiled import device_file
from cellc.compiler.source.compose import compose
from cellc.contract.steps import StepKind
from cellc.tools.lsp.answers import Known, completions, definition, hover
from cellc.tools.lsp.cells import Cells
from cellc.tools.lsp.cursor import Here, here
from cellc.tools.lsp.parts import place_of_part
from tests.cells import CORPUS, spec_of

_BROKEN = {
    "a key on a line of its own": ("devices:\n  arm:\n    model: ur5e\n    mou^\n    tcp: x\n", "mount"),
    "a key in braces that are open": ("frames:\n  a: {parent: world, ^\nhosts: {}\n", "xyz"),
    "a value in brackets that are open": ("control:\n  controllers:\n    a: {type: [^\n", "joint_trajectory"),
    "a value before text": ("network: {discovery: ^localhost, domain_id: 4}\n", "unicast"),
    "a key of an item": ("rehearsals:\n  a:\n    steps:\n      - ^\n", "move"),
    "the kind of a fault": ("rehearsals:\n  a:\n    inject: {^}\n", "protective_stop"),
    "a section in an empty file": ("^", "devices"),
    "true or false": ("frames: {a: {dynamic: ^}}\n", "true"),
}


@pytest.mark.parametrize("place", _BROKEN)
def test_completion_in_a_text_that_is_being_written(place: str) -> None:
    text, expected = _BROKEN[place]
    before, _, after = text.partition("^")
    line, column = before.count("\n") + 1, len(before.split("\n")[-1]) + 1
    assert expected in [completion.word for completion in completions(before + after, line, column, Known())]


_HIT = {
    "freeze": "camera",
    "scale_speed": "arm",
    "silent_sensor": "gripper",
    "jog": "arm/elbow_joint",
    "drop_frame": "object",
    "mismatch_qos": "/object_pose",
    "unreachable": "pick",
    "second_commander": "arm_trajectory",
    "unresponsive": "move_group",
    "jump_clock": "control_pc",
    "cancel": "grip",
}


@pytest.mark.parametrize("kind", _HIT)
def test_completion_offers_what_a_fault_hits(kind: str) -> None:
    spec = spec_of("ur5e_pick").as_posix()
    cells = Cells()
    cells.check(spec, {})
    text = f"rehearsals:\n  a:\n    inject: {{{kind}: }}\n"
    proposed = completions(text, 3, len(f"    inject: {{{kind}: ") + 1, cells.known(spec))
    assert _HIT[kind] in [proposal.word for proposal in proposed]
    assert "world" not in [proposal.word for proposal in proposed] or kind == "drop_frame"


_NAMED = {
    "move": {"home", "pick"},
    "detect": {"object"},
    "set": {"gripper"},
    "sense": {"gripper"},
    "call": {"/object_pose"},
}


@pytest.mark.parametrize("kind", StepKind)
def test_completion_offers_what_a_step_names(kind: StepKind) -> None:
    spec = spec_of("ur5e_pick").as_posix()
    cells = Cells()
    cells.check(spec, {})
    text = f"rehearsals:\n  a:\n    steps: [{kind}: ]\n"
    proposed = {
        completion.word for completion in completions(text, 3, len(f"    steps: [{kind}: ") + 1, cells.known(spec))
    }
    assert _NAMED.get(kind, set()) <= proposed
    assert "home" not in proposed or kind is StepKind.MOVE


_WRITTEN = [
    ("parent: arm/too^l0", 'child="tool0"'),  # a macro makes the link, and its call has the name
    ("tip: arm/wrist_3^_link", '<link name="wrist_3_link"'),
    ("joint: arm/elbow^_joint", 'name="elbow_joint"'),
]


@pytest.mark.parametrize(("asked", "written"), _WRITTEN)
def test_a_link_or_joint_is_defined_where_its_description_writes_it(asked: str, written: str) -> None:
    spec = spec_of("ur5e_pick").as_posix()
    cells = Cells()
    cells.check(spec, {})
    place = definition(
        f"frames:\n  a: {{{asked.replace('^', '')}}}\n", 2, asked.index("^") + 7, cells.known(spec), Path(spec)
    )
    assert place is not None
    lines = Path(place.file).read_text(encoding="utf-8").split("\n")
    assert written in lines[place.line - 1]
    assert Path(place.file).parent == device_file("ur5e").parent


def test_keys_of_a_device_are_explained_by_what_their_models_say() -> None:
    text = "format: 1\nmodel: my_arm\nvendor: me\ncommissioning:\n  - {gate: G5, does: it is pushed, run: []}\n\n"
    meant = {completion.word: completion.meaning for completion in completions(text, 6, 1, Known())}
    assert meant["base"].startswith("Link that a mount places")
    assert "versions" in meant
    assert "vendor" not in meant  # it stands there
    shown = [hover(text, line, column, Known()) for line, column in ((3, 2), (5, 37))]
    assert [one[0].partition("\n\n")[2] for one in shown if one is not None] == [
        "Who makes the device.",
        "Commands that only read; `{address}` in them becomes a word of the shell.",
    ]


def test_yaml_of_others_is_none_of_ours() -> None:
    found, gone = Cells().check("/home/me/compose.yaml", {"/home/me/compose.yaml": "services: {web: {model: x}}\n"})
    assert (found, gone) == ((), {"/home/me/compose.yaml"})


def test_file_of_a_device_is_checked_by_itself() -> None:
    file = "/home/me/arm/device.yaml"
    found, _ = Cells().check(file, {file: "format: 1\nmodel: my_arm\nkind: arn\n"})
    kinds = [finding for finding in found if finding.yaml_path == ("kind",)]
    assert [(finding.code, finding.span.line) for finding in kinds] == [("catalog-entry-invalid", 3)]


_SPOTS = """\
cell: line
devices:
  arm: {model: ur5e}
empty: {}
"""


@pytest.mark.parametrize(
    ("line", "column", "path", "is_key", "text"),
    [
        (1, 1, ("cell",), True, "cell"),
        (1, 5, ("cell",), True, "cell"),  # behind its last letter, where a cursor stands that has written it
        (1, 7, ("cell",), False, "line"),
        (1, 11, ("cell",), False, "line"),
        (2, 3, ("devices",), True, "devices"),
        (3, 4, ("devices", "arm"), True, "arm"),
        (3, 10, ("devices", "arm", "model"), True, "model"),
        (3, 17, ("devices", "arm", "model"), False, "ur5e"),
    ],
)
def test_what_is_at_a_place(line: int, column: int, path: tuple[str, ...], is_key: bool, text: str) -> None:
    found = _here(line, column)
    assert found is not None
    assert (found.path, found.is_key, found.text) == (path, is_key, text)


@pytest.mark.parametrize(("line", "column"), [(1, 6), (1, 12), (3, 2), (3, 8), (4, 8), (9, 1)])
def test_nothing_is_between_keys_and_values(line: int, column: int) -> None:
    assert _here(line, column) is None


def _here(line: int, column: int) -> Here | None:
    root = compose("cell.yaml", _SPOTS).value
    assert root is not None
    return here(root, line, column)


_STAGE = """\
format: 1
cell: line
summary: a stage alone
hosts: {control_pc: {scheduling: generic}}
versions: {ros: jazzy}
devices:
  stage: {model: ./stage, mount: {parent: world, xyz: 0 0 250 mm}}
control:
  update_rate: 100 Hz
  controllers:
    joint_states: {type: joint_state_broadcaster}
"""


@pytest.mark.parametrize(
    ("kinds", "written"), [(("frame",), '<link name="carriage"/>'), (("joint",), '<joint name="carriage" ')]
)
def test_of_a_link_and_a_joint_of_one_name_the_one_that_is_meant_is_found(
    kinds: tuple[str, ...], written: str, tmp_path: Path
) -> None:
    shutil.copytree(CORPUS / "invalid/base/stage", tmp_path / "stage")
    urdf = tmp_path / "stage" / "stage.urdf"
    for file in (urdf, tmp_path / "stage" / "device.yaml"):
        file.write_text(file.read_text(encoding="utf-8").replace("slide", "carriage"), encoding="utf-8")
    spec = tmp_path / "cell.yaml"
    spec.write_text(_STAGE, encoding="utf-8")
    cells = Cells()
    cells.check(spec.as_posix(), {})
    known = cells.known(spec.as_posix())
    assert known.cell is not None
    place = place_of_part(known.cell, "stage/carriage", kinds)
    assert place is not None
    assert Path(place.file) == urdf
    assert written in urdf.read_text(encoding="utf-8").split("\n")[place.line - 1]
