"""Colour and progress on terminals, pipes and everything between."""

from __future__ import annotations

import io
import re
import sys
import threading

import pytest

from cellc.contract.printing import progress, show, stage, wants_color


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


class _Clock:
    def __init__(self) -> None:
        self.now_s = 0.0

    def __call__(self) -> float:
        return self.now_s


@pytest.mark.parametrize(
    ("environment", "on_terminal", "in_pipe"),
    [
        ({}, True, False),
        ({"NO_COLOR": "1"}, False, False),
        ({"NO_COLOR": ""}, True, False),
        ({"FORCE_COLOR": "1"}, True, True),
        ({"FORCE_COLOR": "0"}, True, False),
        ({"NO_COLOR": "1", "FORCE_COLOR": "1"}, False, False),
        ({"CLICOLOR_FORCE": "1"}, True, True),
        ({"CLICOLOR": "0"}, False, False),
        ({"CLICOLOR": "1"}, True, False),
        ({"TERM": "dumb"}, False, False),
        ({"TERM": "dumb", "FORCE_COLOR": "1"}, True, True),
    ],
)
def test_colour_follows_the_conventions(environment: dict[str, str], on_terminal: bool, in_pipe: bool) -> None:
    assert wants_color(True, environment) is on_terminal
    assert wants_color(False, environment) is in_pipe


def test_progress_is_silent_for_two_seconds_and_erased_at_the_end() -> None:
    terminal, clock = _Terminal(), _Clock()
    with progress("build", terminal, clock) as update:
        clock.now_s = 1.9
        update("reading")
        assert terminal.getvalue() == ""
        clock.now_s = 2.1
        update("frames")
        assert terminal.getvalue() == "\r\rbuild: frames"
    assert terminal.getvalue().endswith("\r" + " " * len("build: frames") + "\r")
    assert "\x1b" not in terminal.getvalue()


def test_progress_of_one_long_step_shows_without_another_call() -> None:
    clock, drawn = _Clock(), threading.Event()

    class Watched(_Terminal):
        def write(self, text: str) -> int:
            if "check: cell.yaml" in text:
                drawn.set()
            return super().write(text)

    terminal = Watched()
    with progress("check", terminal, clock) as update:
        update("cell.yaml")
        assert terminal.getvalue() == ""
        clock.now_s = 2.1
        assert drawn.wait(timeout=60)
    assert terminal.getvalue().endswith(" \r")


def test_progress_is_erased_when_the_work_fails() -> None:
    terminal, clock = _Terminal(), _Clock()

    def work() -> None:
        with progress("build", terminal, clock) as update:
            clock.now_s = 2.0
            update("frames")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        work()
    assert terminal.getvalue().endswith(" \r")


def test_progress_redraws_at_most_ten_times_a_second() -> None:
    terminal, clock = _Terminal(), _Clock()
    with progress("mock", terminal, clock) as update:
        for tick in range(2000):
            clock.now_s = 2.0 + tick * 1e-3
            update(str(tick))
    assert terminal.getvalue().count("mock") <= 20


def test_progress_stays_out_of_pipes() -> None:
    pipe, clock = io.StringIO(), _Clock()
    with progress("build", pipe, clock) as update:
        clock.now_s = 5.0
        update("frames")
    assert pipe.getvalue() == ""


def test_progress_fits_the_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "20")
    terminal, clock = _Terminal(), _Clock()
    with progress("build", terminal, clock) as update:
        clock.now_s = 2.0
        update("a very long name\x1b[2J" * 5)
        assert terminal.getvalue() == "\r\rbuild: a very long n"[:21]


def test_progress_inside_progress_takes_over_the_line_and_gives_it_back() -> None:
    terminal, clock = _Terminal(), _Clock()
    with progress("view", terminal, clock) as update:
        clock.now_s = 2.0
        update("the scene")
        with progress("mock") as inner:
            clock.now_s = 3.0
            inner("rehearsal 1 of 2")
            assert terminal.getvalue().endswith("\rmock: rehearsal 1 of 2")
            clock.now_s = 4.0
            stage("planning")
            assert terminal.getvalue().endswith("\rmock: rehearsal 1 of 2, planning")
        clock.now_s = 5.0
        stage("writing")
        assert terminal.getvalue().endswith("\rview: the scene, writing")
    assert terminal.getvalue().endswith(" \r")


def test_output_never_stands_behind_what_is_shown_of_progress(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal, clock = _Terminal(), _Clock()
    monkeypatch.setattr(sys, "stdout", terminal)
    with progress("check", terminal, clock) as update:
        clock.now_s = 2.0
        update("frames")
        show("no findings")
    assert seen(terminal.getvalue()) == "no findings"


def seen(written: str) -> str:
    """Return what stands on a terminal that knows carriage returns and nothing else."""
    lines = [""]
    for piece in re.split("([\r\n])", written):
        if piece == "\n":
            lines.append("")
        elif piece != "\r":
            lines[-1] = piece + lines[-1][len(piece) :]
    return "\n".join(line.rstrip() for line in lines).rstrip("\n")


def test_a_terminal_that_cannot_write_a_line_anew_gets_no_progress(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "dumb")
    terminal, clock = _Terminal(), _Clock()
    with progress("check", terminal, clock) as update:
        clock.now_s = 5.0
        update("frames")
    assert terminal.getvalue() == ""


def test_a_stage_outside_of_a_command_tells_nobody() -> None:
    stage("linking")
