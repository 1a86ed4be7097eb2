"""The report in a real browser: nothing to complain of, and nothing wider than a phone."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.mock.conftest import Written

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
PHONE_PX, DESKTOP_PX = 390, 1280
FRAME = """<!DOCTYPE html><title>frame</title>
<iframe id="page" width="{width}" height="900" src="{name}" style="border:0"></iframe><output id="told"></output>
<script>
page.onload = () => {{
  const inside = page.contentDocument, root = inside.documentElement;
  const wide = [...inside.querySelectorAll("body *")].filter(
    each => each.getBoundingClientRect().right > {width} + 0.5 && !each.closest(".wide"));
  told.textContent = [root.scrollWidth, root.scrollHeight > 2000, wide.map(each => each.tagName).join(" ")].join("|");
}};
</script>
"""

pytestmark = pytest.mark.skipif(BROWSER is None, reason="no chromium here")


def run(page: Path, *options: str) -> subprocess.CompletedProcess[str]:
    assert BROWSER is not None
    profile = page.parent / "profile"
    command = [
        BROWSER,
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--hide-scrollbars",
        f"--user-data-dir={profile}",
    ]
    command += ["--enable-logging=stderr", "--allow-file-access-from-files", "--virtual-time-budget=5000", *options]
    return subprocess.run([*command, page.as_uri()], capture_output=True, text=True, timeout=120, check=True)


@pytest.mark.parametrize("width", [PHONE_PX, DESKTOP_PX])
def test_nothing_is_wider_than_the_window(width: int, written: Written, tmp_path: Path) -> None:
    shutil.copy(written.folder / "report.html", tmp_path / "report.html")
    frame = tmp_path / "frame.html"
    frame.write_text(FRAME.format(width=width, name="report.html"), encoding="utf-8")
    told = re.search(r'id="told">([^<]*)<', run(frame, "--dump-dom").stdout)
    assert told is not None
    scroll_width, is_long, too_wide = told[1].split("|")
    assert (int(scroll_width), is_long, too_wide) == (width, "true", "")


def test_console_stays_empty_and_the_picture_is_not(written: Written, tmp_path: Path) -> None:
    page = Path(shutil.copy(written.folder / "report.html", tmp_path / "report.html"))
    picture = tmp_path / "report.png"
    ran = run(page, f"--screenshot={picture}", "--window-size=1280,2400")
    assert "CONSOLE" not in ran.stderr
    assert picture.stat().st_size > 50_000
