"""Everything that is refused before it can mean something else than it seems to."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from cellc.compiler.source import read
from cellc.contract.limits import DEFAULTS, in_force
from tests.source.reading import codes, places, read_bytes

BOMB = "a: &a [x,x,x,x,x,x,x,x,x]\n" + "".join(
    f"{name}: &{name} [{','.join([f'*{before}'] * 9)}]\n" for before, name in zip("abcdefgh", "bcdefghi", strict=True)
)

REFUSED = [
    ("a: 1\nb:\n  c: 1\n  c: 2\n", [("duplicate-key", 4, 3)]),
    ('"a": 1\na: 2\na: 3\n', [("duplicate-key", 2, 1), ("duplicate-key", 3, 1)]),
    ("1: x\ntrue: y\nnull: z\n", [("non-string-key", 1, 1), ("non-string-key", 2, 1), ("non-string-key", 3, 1)]),
    ("? [a]\n: 1\n", [("non-string-key", 1, 3)]),
    ("a: &x {k: 1}\nb:\n  <<: *x\n", [("merge-key", 3, 3)]),
    ("a: !!python/object:os.system x\n", [("yaml-tag", 1, 4)]),
    ("a: !secret {b: 1}\n", [("yaml-tag", 1, 4)]),
    ("a: 1\n---\nb: 2\n", [("several-documents", 2, 1)]),
    ("a: *nothing\n", [("unknown-alias", 1, 4)]),
    ("a: &x [*x]\n", [("recursive-alias", 1, 8)]),
    ("a:\n\tb: 1\n", [("tab-indentation", 2, 1)]),
    ("a:\n  b: 1\n\tc: 2\n", [("tab-indentation", 3, 1)]),
    ("a: b: c\n", [("not-yaml", 1, 5)]),
    ("a: 'open\n", [("not-yaml", 1, 9)]),
    ("- a\n- b\n", [("root-not-mapping", 1, 1)]),
    ("just text\n", [("root-not-mapping", 1, 1)]),
    ("", [("empty-file", 1, 1)]),
    ("# only a comment\n", [("empty-file", 1, 1)]),
    ("{}", [("empty-file", 1, 1)]),
    ("[]", [("empty-file", 1, 1)]),
    ("\n<?xml version='1.0'?><robot/>", [("not-yaml", 2, 1)]),
    ("a: 1\nb: x\x1b[2J\n", [("control-character", 2, 5)]),
    ("a: \u202ehidden\n", [("control-character", 1, 4)]),
    ('a: "\\u202ehidden"\n', [("control-character", 1, 4)]),
    ('"\\e[2J": 1\n', [("control-character", 1, 1)]),
    ("a: ${1+1}\n", [("substitution-in-text", 1, 4)]),
    ("a: [x, 'y $(env HOME)']\n", [("substitution-in-text", 1, 8)]),
    ('a: {"$(arg x)": "\\x24{1+1}"}\n', [("substitution-in-text", 1, 5), ("substitution-in-text", 1, 17)]),
    ("a: costs $$ 5\n", [("substitution-in-text", 1, 4)]),
    ("<<: x\n", [("merge-key", 1, 1)]),
    (BOMB, [("alias-bomb", 6, 4)]),
]


@pytest.mark.parametrize(("text", "expected"), REFUSED)
def test_it_is_reported_at_its_place(tmp_path: Path, text: str, expected: list[tuple[str, int, int]]) -> None:
    outcome = read_bytes(tmp_path, text)
    assert places(outcome) == expected
    assert not outcome.ok
    assert all(found.help for found in outcome.diagnostics)


def test_first_place_of_a_duplicate_key_is_told(tmp_path: Path) -> None:
    (found,) = read_bytes(tmp_path, "a: 1\nb: 2\na: 3\n").diagnostics
    assert [related.span.line for related in found.related] == [1]
    assert found.yaml_path == ("a",)


@pytest.mark.parametrize(
    ("text", "place"), [("a:\n  b: c\n   d: e\n", (3, 4)), ("a:\n  - x\n   y: 2\n", (3, 4)), ("a: x\n b:\n", (2, 2))]
)
def test_line_that_is_indented_too_far_is_told_by_its_indentation(
    tmp_path: Path, text: str, place: tuple[int, int]
) -> None:
    (found,) = read_bytes(tmp_path, text).diagnostics
    assert (found.code, found.span.line, found.span.column) == ("not-yaml", *place)
    assert "the line is indented deeper than the one above" in found.message
    assert found.help == "align the line with its siblings"


@pytest.mark.parametrize("opening", ["[", "{a: ", "- ", "? "])
def test_ten_thousand_levels_are_refused(tmp_path: Path, opening: str) -> None:
    assert codes(read_bytes(tmp_path, opening * 10_000)) == ["too-deep"]


def test_sixty_four_levels_are_read_and_one_more_is_not(tmp_path: Path) -> None:
    # The root mapping is the first level; a scalar inside the brackets is none.
    assert codes(read_bytes(tmp_path, "a: " + "[" * 63 + "]" * 63)) == []
    assert codes(read_bytes(tmp_path, "a: " + "[" * 64 + "]" * 64)) == ["too-deep"]


def test_aliases_cannot_nest_deeper_than_the_limit(tmp_path: Path) -> None:
    text = "a: &a " + "[" * 40 + "]" * 40 + "\nb: " + "[" * 40 + "*a" + "]" * 40
    assert codes(read_bytes(tmp_path, text)) == ["too-deep"]


def test_many_values_without_aliases_are_refused(tmp_path: Path) -> None:
    with in_force(replace(DEFAULTS, spec_values=2_000)):
        assert codes(read_bytes(tmp_path, "a: [" + "1," * 2_001 + "]")) == ["too-many-values"]


def test_reading_stops_after_a_hundred_findings(tmp_path: Path) -> None:
    assert len(read_bytes(tmp_path, "a: 1\n" * 5000).diagnostics) == 100


@pytest.mark.parametrize(
    ("text", "words"),
    [("tcp: {xyz: 0,0,11mm}\n", "put spaces between the numbers"), ("tcp: {0: a}\n", "put the key in double quotes")],
)
def test_numbers_with_commas_in_braces_are_told_as_what_they_were_meant_as(
    text: str, words: str, tmp_path: Path
) -> None:
    (tmp_path / "cell.yaml").write_text(text)
    found = [
        diagnostic for diagnostic in read(tmp_path / "cell.yaml").diagnostics if diagnostic.code == "non-string-key"
    ]
    assert [words in finding.help for finding in found] == [True]
