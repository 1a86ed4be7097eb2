"""The page on one's own robot says what happens."""

from __future__ import annotations

from pathlib import Path

from tests.docs.tutorial import OWN_ROBOT, rerun_page


def test_every_command_of_the_page_prints_what_it_shows(tmp_path: Path) -> None:
    assert rerun_page(OWN_ROBOT, tmp_path) == OWN_ROBOT.read_text(encoding="utf-8")
