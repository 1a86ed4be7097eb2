"""What is a comment is what the YAML scanner says."""

from __future__ import annotations

import re

import pytest

from cellc.compiler.source.events import comments

MARKER = re.compile(r"# mark")


@pytest.mark.parametrize("pure", [False, True])
@pytest.mark.parametrize(
    ("text", "places"),
    [
        ("a: 1  # mark x\n", [(1, 7)]),
        ("# mark alone\na: 1\n", [(1, 1)]),
        ('a: "text # mark"\n', []),
        ("a: 'text # mark'  # mark\n", [(1, 19)]),
        ("a: |\n  text # mark\nb: 1  # mark\n", [(3, 7)]),
        ("a: |  # mark\n  text\n", [(1, 7)]),
        ("a: >-\n  # mark\n  text\nb: 1\n", []),
        ("a: |\n  text\n# mark\nb: 1\n", [(3, 1)]),
        ("a: [1,  # mark\n    2]\n", [(1, 9)]),
        ('a: "two\n  lines # mark"\nb: 2\n', []),
        ("a: plain words  # mark\nb: 2\n", [(1, 17)]),
        ("a:  # mark\n  b: 1\n", [(1, 5)]),
    ],
)
def test_hash_counts_only_outside_of_values(text: str, places: list[tuple[int, int]], pure: bool) -> None:
    assert [(one.line, one.column) for one in comments(text, MARKER, pure=pure)] == places


def test_comment_is_given_from_its_marker_to_the_end_of_the_line() -> None:
    (comment,) = comments("a: 1  # first # mark the rest  \n", MARKER)
    assert comment.text == "# mark the rest"
    assert comment.column == 15
