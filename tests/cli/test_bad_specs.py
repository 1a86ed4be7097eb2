"""No file, a wrong file, or a hostile one in place of a spec: a code, exit code 1, and nothing written."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from tests.cli.refused import assert_refused, everything_below
from tests.cli.run import MINIMAL, run

_TEXT = Path(MINIMAL).read_text(encoding="utf-8")
_BOMB = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1]\n" + "".join(
    f"a{level}: &a{level} [{', '.join([f'*a{level - 1}'] * 9)}]\n" for level in range(1, 10)
)
BAD = {
    "empty": (b"", "empty-file"),
    "only a comment": (b"# nothing\n", "empty-file"),
    "binary": (b"\x7fELF\x02\x01" + random.Random(1).randbytes(500), "not-utf8"),
    "a zero byte": (b"cell: a\0b\n", "not-utf8"),
    "latin 1": ("cell: caf\xe9\n".encode("latin-1"), "not-utf8"),
    "utf 16": (_TEXT.encode("utf-16"), "not-utf8"),
    "50 MB": (b"key: 12345678\n" * 3_600_000, "file-too-large"),
    "alias bomb": (_BOMB.encode(), "alias-bomb"),
    "deep brackets": (b"[" * 100_000, "too-deep"),
    "deep braces": (b"{a: " * 5_000 + b"1" + b"}" * 5_000, "too-deep"),
    "tabs": (_TEXT.replace("  ", "\t").encode(), "tab-indentation"),
    "a urdf": (b'<?xml version="1.0"?>\n<robot name="r"><link name="l"/></robot>\n', "looks like XML/URDF"),
    "a list": (b"- 1\n- 2\n", "root-not-mapping"),
    "one word": (b"hello\n", "root-not-mapping"),
    "half a mapping": (b'{"a": 1', "not-yaml"),
    "two documents": (b"cell: a\n---\ncell: b\n", "several-documents"),
    "unknown model": (_TEXT.replace("model: ur5e", "model: ur5").encode(), "did you mean `ur5e` or `ur15`?"),
    "missing device folder": (_TEXT.replace("model: ur5e", "model: ./my_robot").encode(), "my_robot` is not a folder"),
}


@pytest.mark.parametrize("command", ["check", "build", "show", "audit"])
@pytest.mark.parametrize("name", BAD)
def test_bad_spec_is_refused_and_nothing_is_written(
    command: str, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    content, words = BAD[name]
    (tmp_path / "cell.yaml").write_bytes(content)
    monkeypatch.chdir(tmp_path)
    ran = run(command, "cell.yaml")
    assert_refused(ran, words)
    assert ran.code == 1
    assert everything_below(tmp_path) == ["cell.yaml"]


@pytest.mark.parametrize("command", ["check", "build", "show", "audit"])
@pytest.mark.parametrize(
    ("named", "words"),
    [("none.yaml", "there is no file `none.yaml`"), (".", "is a folder"), ("", "is a folder")],
)
def test_name_of_no_file_is_refused(
    command: str, named: str, words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert_refused(run(command, named), words)


def test_finding_in_one_of_two_files_does_not_hide_the_other(tmp_path: Path) -> None:
    empty = tmp_path / "empty.yaml"
    empty.touch()
    ran = run("check", empty.as_posix(), MINIMAL)
    assert_refused(ran, "empty-file")
    assert f"in {MINIMAL}" in ran.out


def test_unknown_model_is_marked_on_its_line(tmp_path: Path) -> None:
    file = tmp_path / "cell.yaml"
    file.write_bytes(BAD["missing device folder"][0])
    line = next(number for number, text in enumerate(file.read_text().splitlines(), 1) if "my_robot" in text)
    assert f"{file.as_posix()}:{line}:12" in run("check", file.as_posix()).out
