"""The documentation is a whole site: every page in its place, every link with a target."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cells import ROOT
from tests.docs import limits
from tests.docs.import_graph import PICTURE, picture
from tests.installed.install import first_command
from tests.mock.report_page.test_browser import BROWSER, FRAME, PHONE_PX
from tests.mock.report_page.test_browser import run as browse


def test_site_is_built_without_a_warning(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(tmp_path / "site")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.skipif(BROWSER is None, reason="no chromium here")
def test_a_table_of_the_site_fits_a_phone(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "mkdocs", "build", "--quiet", "--site-dir", str(tmp_path / "site")]
    subprocess.run(command, cwd=ROOT, capture_output=True, check=True)
    frame = tmp_path / "site" / "catalog" / "frame.html"
    frame.write_text(FRAME.format(width=PHONE_PX, name="index.html"), encoding="utf-8")
    told = re.search(r'id="told">([^<]*)<', browse(frame, "--dump-dom").stdout)
    assert told is not None
    scroll_width, _, too_wide = told[1].split("|")
    assert (int(scroll_width), set(too_wide.split()) & {"TABLE", "TD", "A"}) == (PHONE_PX, set())


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
