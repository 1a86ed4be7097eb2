"""The tutorial says what happens."""

from __future__ import annotations

import re
from pathlib import Path

from tests.docs.tutorial import PAGE, rerun


def test_every_command_of_the_tutorial_prints_what_the_page_shows(tmp_path: Path) -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert rerun(page, tmp_path) == page


def test_tutorial_has_ten_steps() -> None:
    steps = re.findall(r"^## (\d+)\. ", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert steps == [str(number) for number in range(1, 11)]
