"""Comments and long texts of strangers cost what they are long, not its square."""

from __future__ import annotations

import re

from cellc.compiler.source.events import comments
from cellc.robot.description.xml_tree import read_xml

_MARK = re.compile(r"# cellc:")


def test_many_comments_beside_many_scalars_are_told_apart() -> None:
    text = "".join(f'a{number}: "# cellc: not {number}"  # cellc: ignore x {number}\n' for number in range(4000))
    found = comments(text, _MARK)
    assert [one.text for one in found] == [f"# cellc: ignore x {number}" for number in range(4000)]


def test_text_of_many_lines_is_read() -> None:
    read = read_xml("<robot name='a'>" + "a\n" * 400_000 + "</robot>", "a.urdf")
    assert read.value is not None
    assert len(read.value.text) == 800_000
