"""Names in the boxes of pictures."""

from __future__ import annotations

import pytest

from cellc.compiler.formats.svg import name_lines


@pytest.mark.parametrize(
    ("name", "lines"),
    [
        ("/loading/description_publisher", ["/loading/description_", "publisher"]),
        ("unloader_dashboard_client", ["unloader_dashboard_", "client"]),
        ("arm", ["arm"]),
        ("", [""]),
        ("a" * 30, ["a" * 24, "a" * 6]),
    ],
)
def test_a_name_breaks_between_its_words(name: str, lines: list[str]) -> None:
    assert name_lines(name, 24) == lines
