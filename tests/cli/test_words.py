"""What a shell completes, asked as its script asks."""

from __future__ import annotations

from pathlib import Path

import click
import pytest
from click.shell_completion import ShellComplete

from cellc.catalog.load import device_names
from cellc.cli.main import cellc
from cellc.report.pages import all_pages
from tests.cells import generated


def _completed(arguments: list[str], incomplete: str) -> list[str]:
    command: click.Command = cellc
    return [
        item.value
        for item in ShellComplete(command, {}, "cellc", "_CELLC_COMPLETE").get_completions(arguments, incomplete)
    ]


def test_codes_are_completed() -> None:
    assert _completed(["explain"], "unread-") == [code for code in all_pages() if code.startswith("unread-")]


def test_the_last_code_of_several_is_completed() -> None:
    assert "missing-unit,unread-topic" in _completed(["check", "--select"], "missing-unit,unread-t")


@pytest.mark.parametrize(("command", "begun"), [(["init", "bench"], "arm="), (["catalog"], "")])
def test_models_are_completed(command: list[str], begun: str) -> None:
    assert set(_completed(command, begun)) == {f"{begun}{name}" for name in device_names()}


def test_rehearsals_of_the_folder_are_completed() -> None:
    assert _completed(["mock", generated("minimal").as_posix(), "--rehearsal"], "") == ["ready"]


def test_folder_that_cannot_be_read_has_nothing_to_complete(tmp_path: Path) -> None:
    (tmp_path / "rehearsals.json").write_text("[", encoding="utf-8")
    assert _completed(["mock", tmp_path.as_posix(), "--rehearsal"], "") == []
    assert _completed(["mock", (tmp_path / "nowhere").as_posix(), "--rehearsal"], "") == []
