"""Comments and long texts cost what they are long, suggestions are right among many."""

from __future__ import annotations

import difflib
import re
import sys

import pytest

from cellc.compiler.source.events import comments
from cellc.contract.diagnostics.nearest import nearest
from cellc.robot.description.xml_tree import read_xml
from tests.cells import there

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
    assert [(comment.line, comment.column) for comment in comments(text, MARKER, pure=pure)] == places


def test_comment_is_given_from_its_marker_to_the_end_of_the_line() -> None:
    (comment,) = comments("a: 1  # first # mark the rest  \n", MARKER)
    assert comment.text == "# mark the rest"
    assert comment.column == 15


_MARK = re.compile(r"# cellc:")


def test_many_comments_beside_many_scalars_are_told_apart() -> None:
    text = "".join(f'a{number}: "# cellc: not {number}"  # cellc: ignore x {number}\n' for number in range(4000))
    found = comments(text, _MARK)
    assert [finding.text for finding in found] == [f"# cellc: ignore x {number}" for number in range(4000)]


def test_text_of_many_lines_is_read() -> None:
    read = read_xml("<robot name='a'>" + "a\n" * 400_000 + "</robot>", "a.urdf")
    assert len(there(read.value).text) == 800_000


def test_misspelt_name_is_found_among_thousands() -> None:
    names = [f"frame_{number:05}" for number in range(3000)] + ["fixture_plate"]
    assert nearest("fixture_plaet", names) == ("fixture_plate",)


def test_a_name_is_compared_with_a_bounded_number_of_others(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[int] = []
    real = difflib.get_close_matches

    def counting(word: str, names: list[str], n: int, cutoff: float) -> list[str]:
        seen.append(len(names))
        return real(word, names, n=n, cutoff=cutoff)

    monkeypatch.setattr(sys.modules["cellc.contract.diagnostics.nearest"], "get_close_matches", counting)
    nearest("frame_nomber", [f"frame_number_{number}" for number in range(5000)])
    assert seen == [128]
    assert nearest("a" * 100_000, ["a" * 100_000]) == ()
