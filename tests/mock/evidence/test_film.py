"""A film of a rehearsal: as long as it was, of what moves, and refused in one line where it cannot be made."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from cellc.mock import load
from cellc.mock.command import film as command
from cellc.mock.evidence.images import film as pictures
from tests.cells import generated
from tests.cli.run import run

_SMALL = (96, 72)


@pytest.fixture(autouse=True)
def _small(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (command, pictures):
        monkeypatch.setattr(module, "SIZE", _SMALL)


def _frames(path: Path) -> list[np.ndarray]:
    with Image.open(path) as image:
        found = []
        for number in range(getattr(image, "n_frames", 1)):
            image.seek(number)
            found.append(np.asarray(image.convert("RGB")).astype(int))
        return found


def test_a_gif_has_ten_pictures_a_second_of_an_arm_that_moves(tmp_path: Path) -> None:
    path = tmp_path / "ready.gif"
    ended = run("mock", generated("minimal").as_posix(), "--film", path.as_posix())
    assert ended.code == 0, ended.err
    result = load(generated("minimal")).run("ready")
    frames = _frames(path)
    with Image.open(path) as image:
        assert (image.size, image.info["duration"]) == (_SMALL, 100)
    # Pictures that are alike are one that is shown for longer.
    assert 0.5 * 10.0 * result.sim_time_s < len(frames) <= 10.0 * result.sim_time_s + 1.0
    below = slice(_SMALL[1] // 4, None)  # the text stands above
    assert np.abs(frames[0][below] - frames[-1][below]).max() > 50
    assert all(len(np.unique(frame.reshape(-1, 3), axis=0)) > 5 for frame in frames)


def test_an_mp4_is_what_the_encoder_makes_of_all_pictures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The stand-in of ffmpeg answers how many bytes it was given."""
    program = tmp_path / "bin" / "ffmpeg"
    program.parent.mkdir()
    program.write_text(f"#!{sys.executable}\nimport sys\nprint(len(sys.stdin.buffer.read()))\n", encoding="utf-8")
    program.chmod(0o755)
    path, folder = tmp_path / "ready.mp4", generated("minimal").as_posix()
    monkeypatch.setenv("PATH", program.parent.as_posix())
    assert run("mock", folder, "--film", path.as_posix()).code == 0
    pixels = _SMALL[0] * _SMALL[1] * 3
    count = int(path.read_bytes())
    assert count % pixels == 0
    assert count / pixels == pytest.approx(10.0 * load(generated("minimal")).run("ready").sim_time_s, abs=1.0)
    program.write_text(f"#!{sys.executable}\nimport sys\nsys.exit('no such codec')\n", encoding="utf-8")
    ended = run("mock", folder, "--film", path.as_posix())
    assert (ended.code, "is not written: ffmpeg ended with 1: no such codec" in ended.err) == (2, True)
    assert int(path.read_bytes()) == count, "what was there stays"


@pytest.mark.parametrize(
    ("cell", "file", "said"),
    [
        ("minimal", "ready.txt", "must end with .gif or .mp4, got `.txt`"),
        ("minimal", "ready.mp4", "needs the program `ffmpeg`, which is not installed; name a file that ends with .gif"),
        ("ur5e_pick", "all.gif", "is a film of one rehearsal, got 11; name it with --rehearsal"),
    ],
)
def test_what_cannot_be_made_is_refused_in_one_line(
    cell: str, file: str, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", tmp_path.as_posix())
    ended = run("mock", generated(cell).as_posix(), "--film", (tmp_path / file).as_posix())
    assert (ended.code, ended.out, ended.err.count("\n"), said in ended.err) == (2, "", 1, True), ended.err
    assert list(tmp_path.iterdir()) == []


def test_what_does_not_go_together_is_refused() -> None:
    ended = run("mock", generated("minimal").as_posix(), "--film", "a.gif", "--evidence", "evidence")
    assert (ended.code, "--film cannot be combined with" in ended.err) == (2, True)
