"""Where the examples of rules are written."""

from __future__ import annotations

from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder that each example is written to: the devices beside the cells are read once."""
    return tmp_path_factory.mktemp("examples")
