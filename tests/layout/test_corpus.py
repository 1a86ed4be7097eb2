"""The canonical form of every cell and device there is: nothing is lost, and it is the form of itself."""

from __future__ import annotations

import random
import re
import shutil
from collections import Counter
from pathlib import Path

import pytest

from cellc.compiler.link.link import link
from cellc.compiler.source import read
from cellc.compiler.source.compose import compose
from cellc.compiler.source.text import read_text
from cellc.compiler.spec.parse import parse
from cellc.contract.diagnostics import Span
from cellc.tools.layout import layout
from cellc.tools.report.resolved import flatten, resolved_tree
from tests.cells import CORPUS, EVERY_CELL, ROOT, spec_of
from tests.cli.run import run
from tests.foreign_yaml import safe_load

_FILES = tuple(sorted(CORPUS.rglob("*.yaml"))) + tuple(spec_of(cell) for cell in EVERY_CELL)
_DEVICES = tuple(sorted(ROOT.glob("cellc/compiler/catalog/devices/*/*.yaml")))


def _texts(files: tuple[Path, ...]) -> dict[str, str]:
    read = {str(file.relative_to(ROOT)): read_text(file, "x", Span("x", 1, 1, 1, 1)) for file in files}
    return {name: one.value for name, one in read.items() if one.value is not None and not one.diagnostics}


def _comments(text: str) -> Counter[str]:
    """Count what follows a `#` that begins a line or stands behind a space: comments, and texts that look like them."""
    return Counter(found.strip() for found in re.findall(r"(?m)(?:^|[ \t])(#.*)$", text))


def _words(text: str) -> Counter[str]:
    """Count what is neither space nor a separator: of every value, key and comment."""
    return Counter(re.sub(r"[\s,{}\[\]]+", "", text))


@pytest.mark.parametrize("files", [_FILES, _DEVICES], ids=("corpus", "devices"))
def test_nothing_is_lost_and_the_form_is_that_of_itself(
    files: tuple[Path, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    # A text that the writer would spoil stays as it is: a mistake of its must not pass for a form.
    spoilt = list[bool]()
    says_the_same = layout.says_the_same
    monkeypatch.setattr(layout, "says_the_same", lambda *told: _noted(says_the_same(*told), spoilt))
    texts = _texts(files)
    changed = 0
    for name, text in texts.items():
        made = layout.formatted(name, text).value
        if made is not None and made != text:
            changed += 1
            assert _comments(made) == _comments(text), name
            assert _words(made) == _words(text), name
            assert layout.formatted(name, made).value == made, name
    assert not spoilt
    assert changed > len(texts) // 40, "the property was held against files that are in order"


def _noted(same: bool, spoilt: list[bool]) -> bool:
    spoilt += [] if same else [True]
    return same


def test_comments_at_any_place_stay() -> None:
    drawn = random.Random(14)
    texts = [spec_of(cell).read_text() for cell in EVERY_CELL]
    tried = 0
    for _ in range(80):
        lines = drawn.choice(texts).split("\n")
        begin = drawn.randrange(len(lines))
        text = _disturbed(lines[begin : begin + drawn.randrange(3, 20)], drawn)
        read = compose("x", text)
        if read.diagnostics or read.value is None:
            continue
        tried += 1
        made = layout.formatted("x", text).value
        assert made is not None
        assert _comments(made) == _comments(text), text
        assert layout.formatted("x", made).value == made, text
    assert tried > 20


def _disturbed(lines: list[str], drawn: random.Random) -> str:
    """Put comments and empty lines between lines, behind them and within braces."""
    for number in range(4):
        place, kind = drawn.randrange(len(lines)), drawn.randrange(4)
        breaks = list(re.finditer(r", |\{|\[|: ", lines[place]))
        if kind == 0 and "#" not in lines[place]:
            lines[place] += f" # behind {number}"
        elif kind == 1:
            lines.insert(place, f"{' ' * drawn.randrange(9)}# above {number}")
        elif kind == 2:
            lines.insert(place, "")
        elif breaks:
            end = drawn.choice(breaks).end()
            lines[place] = f"{lines[place][:end]} # within {number}\n{' ' * drawn.randrange(6, 14)}{lines[place][end:]}"
    return "\n".join(lines) + "\n"


def test_resolved_cells_are_what_they_were(tmp_path: Path) -> None:
    shutil.copytree(CORPUS / "valid", tmp_path / "before")
    shutil.copytree(CORPUS / "valid", tmp_path / "after")
    specs = sorted(
        file.name for file in (tmp_path / "before").glob("*.yaml") if "include" in safe_load(file.read_text())
    )
    files = [*(tmp_path / "after").glob("*.yaml"), *(tmp_path / "after" / "parts").rglob("*.yaml")]
    assert run("format", *map(str, files)).code == 0
    changed = [
        name for name in specs if (tmp_path / "after" / name).read_bytes() != (tmp_path / "before" / name).read_bytes()
    ]
    assert len(changed) > 5
    for name in changed[::10]:
        assert _resolved(tmp_path / "after" / name) == _resolved(tmp_path / "before" / name), name


def _resolved(spec: Path) -> dict[str, str]:
    document = read(spec).value
    assert document is not None
    parsed = parse(document).value
    assert parsed is not None
    cell = link(parsed, document).value
    assert cell is not None
    return {name: re.sub(r"[\s,]+", " ", leaf.text) for name, leaf in flatten(resolved_tree(cell))}


def test_cells_of_the_repository_are_in_their_form() -> None:
    assert run("format", "--check", str(ROOT / "cells")).code == 0


def test_first_cell_of_a_user_is_in_its_form(tmp_path: Path) -> None:
    spec = tmp_path / "cell.yaml"
    assert (
        run("init", "bench", "arm=ur5e", "gripper=robotiq_2f_85", "camera=realsense_d435i", "-o", str(spec)).code == 0
    )
    assert run("format", "--check", "--diff", str(spec)).out == ""
