"""What computes the figures here, and what is said of another place that computes with other programs."""

from __future__ import annotations

import re
from importlib.metadata import version

import numpy as np
import pytest

from cellc.contract.compute.versions import difference, versions


def test_versions_are_those_that_are_installed() -> None:
    found = versions()
    assert list(found) == ["cellc", "numpy", "pin"]
    assert (found["numpy"], found["pin"]) == (np.__version__, version("pin"))
    assert re.fullmatch(r"\S+ \([0-9a-f]{12}\)", found["cellc"])
    assert found["cellc"].startswith(version("cellc"))


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({}, ""),
        ({"another": "1"}, ""),
        ({"numpy": "0.1"}, "numpy 0.1, here is {numpy}"),
        ({"pin": "0.2"}, "pin 0.2, here is {pin}"),
        ({"pin": "0.2", "numpy": "0.1"}, "numpy 0.1, here is {numpy}"),  # the first of both
    ],
)
def test_first_difference_is_said(changes: dict[str, str], said: str) -> None:
    assert difference({**versions(), **changes}) == said.format_map(versions())


def test_what_is_not_told_is_unknown() -> None:
    there = {name: one for name, one in versions().items() if name != "numpy"}
    assert difference(there) == f"numpy UNKNOWN, here is {np.__version__}"
