"""One repository for all tests of diffs, and what the cell is on its main branch, made once."""

from __future__ import annotations

import pytest

from cellc.tools.review.sides import Package
from tests.review.revisions import Repository, new_repository, package_of


@pytest.fixture(scope="session")
def repository(tmp_path_factory: pytest.TempPathFactory) -> Repository:
    """Return a repository with the cell."""
    return new_repository(tmp_path_factory.mktemp("repository"))


@pytest.fixture(scope="session")
def main(repository: Repository) -> Package:
    """Return the cell on the main branch."""
    return package_of(repository, "main")
