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

CONTRAST = """<!DOCTYPE html><title>frame</title>
<iframe id="page" width="1280" height="900" src="spec.html" style="border:0"></iframe><output id="told"></output>
<script>
const numbers = (color) => color.match(/[\\d.]+/g).map(Number);
const light = (color) => {
  const [r, g, b] = color.map((each) => (each / 255 > 0.04045 ? ((each / 255 + 0.055) / 1.055) ** 2.4 : each / 3294.6));
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};
page.onload = () => {
  const inside = page.contentWindow, root = inside.document;
  root.head.append(Object.assign(root.createElement("style"), {textContent: "* { transition: none !important }"}));
  root.documentElement.dataset.bsTheme = "MODE";
  const behind = (each) => {
    for (let at = each; at; at = at.parentElement) {
      const color = numbers(inside.getComputedStyle(at).backgroundColor);
      if (color.length === 3 || color[3] > 0.5) return color.slice(0, 3);
    }
  };
  const texts = [...root.querySelectorAll("[role=main] *, .bs-sidebar *, footer *")].filter(
    (each) => [...each.childNodes].some((node) => node.nodeType === 3 && node.data.trim()));
  const faint = texts.filter((each) => {
    const [a, b] = [numbers(inside.getComputedStyle(each).color).slice(0, 3), behind(each)].map(light);
    return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05) < 4.5;
  });
  told.textContent = `${texts.length} texts on ${behind(root.body)}:${faint.map((each) => each.tagName).join(" ")}`;
};
</script>
"""
in_a_browser = pytest.mark.skipif(BROWSER is None, reason="no chromium here")


def test_site_is_built_without_a_warning(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(tmp_path / "site")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("built") / "site"
    command = [sys.executable, "-m", "mkdocs", "build", "--quiet", "--site-dir", str(folder)]
    subprocess.run(command, cwd=ROOT, capture_output=True, check=True)
    return folder


@in_a_browser
def test_a_table_of_the_site_fits_a_phone(site: Path) -> None:
    frame = site / "catalog" / "frame.html"
    frame.write_text(FRAME.format(width=PHONE_PX, name="index.html"), encoding="utf-8")
    told = re.search(r'id="told">([^<]*)<', browse(frame, "--dump-dom").stdout)
    assert told is not None
    scroll_width, _, too_wide = told[1].split("|")
    assert (int(scroll_width), set(too_wide.split()) & {"TABLE", "TD", "A"}) == (PHONE_PX, set())


@in_a_browser
@pytest.mark.parametrize("mode", ["light", "dark"])
def test_text_of_the_site_has_the_contrast_of_wcag_aa(mode: str, site: Path) -> None:
    frame = site / f"contrast_{mode}.html"
    frame.write_text(CONTRAST.replace("MODE", mode), encoding="utf-8")
    told = re.search(r'id="told">(\d+) texts on (\S+):([^<]*)<', browse(frame, "--dump-dom").stdout)
    assert told is not None
    assert int(told[1]) > 500
    assert (told[2], told[3]) == ({"light": "255,255,255", "dark": "33,37,41"}[mode], "")


def test_no_heading_begins_with_a_digit() -> None:
    # The theme looks a heading up by its anchor as a CSS selector, and throws at `#1-install`.
    pages = [*(ROOT / "docs").rglob("*.md")]
    assert [page.name for page in pages if re.search(r"^#+ \d", page.read_text(encoding="utf-8"), re.M)] == []


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
