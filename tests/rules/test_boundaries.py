"""Rules turn at their bound: figures on it, just inside it and just outside it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rules.boundaries import BOUNDARIES
from tests.rules.examples import Example, diagnose_example


@pytest.mark.parametrize(
    ("code", "fragment", "reported"),
    BOUNDARIES,
    ids=[f"{code}-{number}" for number, (code, *_) in enumerate(BOUNDARIES)],
)
def test_rule_turns_at_its_bound(code: str, fragment: Example, reported: bool, folder: Path) -> None:
    found = {diagnostic.code for diagnostic in diagnose_example(fragment, folder)}
    assert (code in found) is reported, found
