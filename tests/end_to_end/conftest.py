"""The pick-and-place cell, built once."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.run import PICK, run


@pytest.fixture(scope="session")
def pick(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The generated folder; tests that change it take a copy."""
    output = tmp_path_factory.mktemp("generated")
    assert run("build", PICK, "-o", output.as_posix()).code == 0
    return output / "ur5e_pick"
