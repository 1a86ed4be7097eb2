"""What is told of a place, asked without the protocol: texts that are being written above all."""

from __future__ import annotations

import pytest

from cellc.lsp.answers import Known, completions
from cellc.lsp.cells import Cells

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
    assert expected in [one.word for one in completions(before + after, line, column, Known())]


def test_yaml_of_others_is_none_of_ours() -> None:
    found, gone = Cells().check("/home/me/compose.yaml", {"/home/me/compose.yaml": "services: {web: {model: x}}\n"})
    assert (found, gone) == ((), {"/home/me/compose.yaml"})


def test_file_of_a_device_is_checked_by_itself() -> None:
    file = "/home/me/arm/device.yaml"
    found, _ = Cells().check(file, {file: "format: 1\nmodel: my_arm\nkind: arn\n"})
    kinds = [one for one in found if one.yaml_path == ("kind",)]
    assert [(one.code, one.span.line) for one in kinds] == [("catalogue-entry-invalid", 3)]
