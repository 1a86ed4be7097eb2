"""Node keys of a parameter file: whole tokens, stars, and no time that explodes (rcl: `*` one token, `**` any)."""

from __future__ import annotations

import pytest

from cellc.mock.control.parameters import ParameterFile


def _hits(key: str, namespace: str, name: str) -> bool:
    text = f'"{key}":\n  ros__parameters: {{a: 1}}\n'
    return bool(ParameterFile(text).of_node(name, namespace))


@pytest.mark.parametrize(
    ("key", "namespace", "name", "hit"),
    [
        ("/arm", "", "arm", True),
        ("arm", "", "arm", True),
        ("/arm", "/left", "arm", False),
        ("/*/arm", "/left", "arm", True),
        ("/*/arm", "", "arm", False),
        ("/**", "/left/low", "arm", True),
        ("/**/arm", "", "arm", True),
        ("/**/arm", "/left/low", "arm", True),
        ("/**/low/*", "/left/low", "arm", True),
        ("/**/arm", "/left", "hand", False),
        ("/ar*", "", "arm", True),
        ("/ar*", "", "ar", False),
        ("/*m", "", "arm", True),
    ],
)
def test_key_names_nodes(key: str, namespace: str, name: str, hit: bool) -> None:
    assert _hits(key, namespace, name) is hit


def test_stars_of_strangers_cost_no_time() -> None:
    # With a pattern that backtracks eight stars took a second and a half, and each more four times as long.
    assert not _hits("/" + "*" * 200 + "!", "", "arm_trajectory_controller_of_the_cell")
    assert not _hits("/" + "*a" * 200, "", "a" * 199)
    assert not _hits("/**" * 200 + "/x", "/a" * 50, "arm")
