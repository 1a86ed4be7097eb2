"""Long lines that a few keys make: each costs what its length costs, where its square would take hours."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.hostile_cell import SPEC, make, new_cell
from tests.cli.run import run

_LONG = 400_000


@pytest.fixture(name="cell")
def cell_fixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a cell, which is the current one."""
    folder = new_cell(tmp_path / "cell")
    monkeypatch.chdir(folder)
    return folder


_NODE = "nodes:\n  seer: {{run: a/b, parameters: {{text: '{}'}}}}\n"


@pytest.mark.parametrize("text", ["a" * _LONG, "a://" + "b" * _LONG, "a" + "_" * _LONG + "b", "1" * _LONG + "x"])
def test_a_long_text_is_searched_for_credentials_in_one_pass(text: str, cell: Path) -> None:
    make(cell, {"cell.yaml": SPEC + _NODE.format(text)})
    ran = run("check", "cell.yaml")
    assert "credential-in-text" not in ran.out
    make(cell, {"cell.yaml": SPEC + _NODE.format(f"{text} https://me:mine@example.com")})
    ran = run("check", "cell.yaml")
    assert "the text holds an address with a password" in ran.out


@pytest.mark.parametrize(
    ("comment", "found"),
    [
        ("# cellc: ignore " * (_LONG // 16) + "b", "the comment names no code to ignore"),
        ("# cellc: ignore " + "a," * (_LONG // 2) + "b", "`a`, `b` is ignored without a reason"),
        ("# cellc: ignore " + ",".join(f"missing-{n}" for n in range(_LONG // 12)), "there is no code `missing-0`"),
        ("# cellc: ignore a\n" * (_LONG // 18), "there is no code `a`"),
    ],
    ids=["markers", "one code", "many codes", "many comments"],
)
def test_comments_that_excuse_are_read_in_one_pass(comment: str, found: str, cell: Path) -> None:
    make(cell, {"cell.yaml": SPEC + comment + "\n"})
    ran = run("check", "cell.yaml")
    assert (ran.code, found in ran.out) == (1, True)
    assert ran.out.count("ignored-code]") <= 100


def test_a_line_of_hashes_is_one_comment_to_the_formatter(cell: Path) -> None:
    make(cell, {"cell.yaml": SPEC + "#" * _LONG + "\n"})
    assert run("format", "cell.yaml").code == 0
    assert (cell / "cell.yaml").read_text().count("#" * _LONG) == 1


_DECLARING = f"""\
controllers:
  lamp:
    behavior: broadcaster
    source: made up
    plugins: {{jazzy: {{type: stage/Lamp, package: stage}}}}
    parameters:
      "<a>{"x<b>" * 20}y": {{type: bool, default: false}}
"""


def test_a_parameter_is_compared_with_its_declaration_in_one_pass(cell: Path) -> None:
    # Of a pattern with 20 gaps, each place of each gap would be tried.
    facts = (cell / "stage/device.yaml").read_text(encoding="utf-8")
    given = f"lamp: {{type: lamp, device: stage, parameters: {{{'x' * 100}: true}}}}\n    joint_states:"
    make(cell, {"stage/device.yaml": facts + _DECLARING, "cell.yaml": SPEC.replace("joint_states:", given)})
    ran = run("check", "cell.yaml")
    assert (ran.code, "error[unknown-controller-parameter]" in ran.out) == (1, True), ran.out
