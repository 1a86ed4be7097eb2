"""Values of an attribute are changed where they stand, and all else stays to the letter."""

from __future__ import annotations

import pytest

from cellc.robot.description.xml_tree import with_values


@pytest.mark.parametrize(
    ("text", "changed"),
    [
        ('<r><mesh filename="a"/></r>', '<r><mesh filename="A"/></r>'),
        (
            "<r><mesh a='1'\n filename='a' /><mesh  filename = 'b'/></r>",
            '<r><mesh a=\'1\'\n filename="A" /><mesh  filename = "B"/></r>',
        ),
        ('<r filename="a"><box/><mesh name="a"/></r>', '<r filename="a"><box/><mesh name="a"/></r>'),
        (
            '<!-- <mesh filename="a"/> --><mesh filename="a&amp;b"/>',
            '<!-- <mesh filename="a"/> --><mesh filename="A&amp;B"/>',
        ),
        ("<mesh filename='A'>é</mesh>", "<mesh filename='A'>é</mesh>"),  # nothing to change, not even the quotes
        ('<r>é<mesh filename="é"/>ü</r>', '<r>é<mesh filename="É"/>ü</r>'),
    ],
)
def test_values_are_changed_in_their_places(text: str, changed: str) -> None:
    assert with_values(text, "mesh", "filename", str.upper) == changed
