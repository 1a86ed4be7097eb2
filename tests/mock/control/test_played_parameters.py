"""Each parameter that the catalog declares is played by the mock, or its entry says what the mock does instead.

Whether the mock plays one is asked of its source: it reads the value by its name, in its own file of controllers.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cellc.compiler.catalog.load import controller_kinds, load_controller_kind
from tests.cells import ROOT, there

_SOURCES = [path.read_text(encoding="utf-8") for path in sorted(Path(ROOT, "cellc/mock/control").rglob("*.py"))]
_READ = re.compile(r"""(?:text|number|flag|texts|period_ns|given)\(\s*f?"([^"]*)\"""")
_PLACES = re.compile(r"<[a-z_]+>|\{[a-z_]+\}")


def _last(name: str) -> str:
    """Return what is left of a name behind its last part that varies: a joint, or an axis."""
    return _PLACES.split(name)[-1].lstrip(".")


_NAMES_READ = {name for source in _SOURCES for name in _READ.findall(source)}
_BY_PARTS = {"interface_names", "offset", "multiplier", "map_interface_to_joint_state"}
"""Groups that the mock reads axis by axis, or field by field, in a loop."""


_FOR_THE_CHECK = {
    "frame_id": "a name in the header, which `frame-of-another-stamp` compares with the frame of the topic"
}


def _is_read(name: str) -> bool:
    group = name.partition(".")[0]
    if group in _BY_PARTS:
        return any(_PLACES.split(read)[0] == f"{group}." for read in _NAMES_READ)
    if "<" not in name:
        return name in _NAMES_READ
    return any(_PLACES.search(read) and _last(read) == _last(name) for read in _NAMES_READ)


@pytest.mark.parametrize("kind", controller_kinds())
def test_parameter_is_read_by_the_mock_or_said_not_to_be_played(kind: str) -> None:
    parameters = there(load_controller_kind(kind).value).parameters
    played = {name for name, facts in parameters.items() if facts.not_played is None}
    assert played == {name for name in parameters if _is_read(name) or name in _FOR_THE_CHECK}
