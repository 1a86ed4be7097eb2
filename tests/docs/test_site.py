"""The documentation is a whole site: every page in its place, every link with a target."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

from tests.cells import ROOT
from tests.docs import limits
from tests.docs.import_graph import PICTURE, picture
from tests.installed.install import first_command


def test_site_is_built_without_a_warning(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(tmp_path / "site")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_first_page_has_the_first_command_of_readme_and_the_picture_of_its_cell() -> None:
    page = (ROOT / "docs/index.md").read_text(encoding="utf-8")
    assert f"```sh\n{first_command()}\n```" in page
    (shown,) = re.findall(r"!\[.+\]\((.+)\)", page)
    assert (ROOT / "docs" / shown).read_bytes() == (ROOT / "generated/ur5e_pick/graph/cell.svg").read_bytes()


def test_page_of_the_limits_is_their_table() -> None:
    # Written by `python -m tests.docs.limits`.
    assert limits.PAGE.read_text(encoding="utf-8") == limits.page()


def test_picture_of_the_imports_is_that_of_the_code() -> None:
    # Drawn by `python -m tests.docs.import_graph`.
    assert PICTURE.read_text(encoding="utf-8") == picture()
