"""Leaves of two folders: what they are in words, and where two of them are one value."""

from __future__ import annotations

import pytest

from cellc.contract.base import Json
from cellc.contract.transforms import Pose
from cellc.tools.review.leaves import Leaf, differences, flatten, said, same
from cellc.tools.review.revisions import _leads_out


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        ({"a": "x", "b": 2, "c": None, "d": "", "e": 0}, "x b 2 e 0"),
        ({"outer": {"inner": "x", "n": 1.5}}, "outer x n 1.5"),
        ([1.0, "y", [2, 3]], "1, y, 2, 3"),
        (0.1234567891, "0.123456789"),
        (True, "True"),
    ],
)
def test_an_entry_in_words(entry: Json, words: str) -> None:
    assert said(entry) == words


def test_nothing_is_no_difference_from_an_empty_list() -> None:
    assert differences({("a",): (), ("b",): ("x",)}, {("b",): ("x",), ("c",): ""}) == ()


def test_entries_with_names_of_their_own_are_told_by_them() -> None:
    named: Json = {"list": [{"name": "a", "x": 1}, {"name": "b", "x": None}], "none": None}
    assert dict(flatten(named)) == {("list", "a", "x"): 1}
    alike: Json = [{"name": "a", "x": 1}, {"name": "a", "x": 2}]
    assert dict(flatten(alike)) == {(): ("a x 1", "a x 2")}
    assert dict(flatten({"p": {"xyz": [1, 2, 3], "quaternion": [0, 0, 0, 1]}})) == {
        ("p",): Pose((1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 1.0))
    }


@pytest.mark.parametrize(
    ("before", "after", "ordered", "expected"),
    [
        (1.0, 1.0 + 1e-10, True, True),
        (1.0, 1.0 + 1e-8, True, False),
        (1, True, True, False),
        (("a", "b"), ("b", "a"), True, False),
        (("a", "b"), ("b", "a"), False, True),
        (("a",), ("a", "b"), True, False),
        ("1", 1, True, False),
    ],
)
def test_one_value_is_one_but_for_rounding(before: Leaf, after: Leaf, ordered: bool, expected: bool) -> None:
    assert same(before, after, ordered=ordered) is expected


@pytest.mark.parametrize(
    ("name", "content", "expected"),
    [
        ("cell.yaml", b"include: ../parts.yaml", True),
        ("cell.yml", b"a: 1\nb: ../x # why", True),
        ("arm.urdf", b"<mesh filename='../a.stl'/>", True),
        ("cell.yaml", b"# schema: ../x", False),
        ("cell.yaml", b"include: parts.yaml", False),
        ("notes.txt", b"../x", False),
    ],
)
def test_a_file_of_a_spec_leads_out_where_it_names_a_folder_above(name: str, content: bytes, expected: bool) -> None:
    assert _leads_out(name, content) is expected
