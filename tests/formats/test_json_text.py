"""JSON files for review: what fits into a line stands in one, and what is at its default is left out."""

from __future__ import annotations

import json

import pytest
from pydantic import BaseModel, Field

from cellc.compiler.formats.json_text import render
from tests.cells import CELLS, built


class Part(BaseModel):
    """A part of a file."""

    name: str
    values: tuple[float, ...] = ()
    note: str | None = None


class Whole(BaseModel):
    """A file."""

    parts: dict[str, Part]
    words: tuple[str, ...] = Field(default=())


def test_short_parts_stand_in_a_line_and_defaults_are_left_out() -> None:
    whole = Whole(parts={"a": Part(name="x", values=(0.5, -0.0)), "b": Part(name="y", note="z")})
    assert render(whole) == (
        "{\n"
        '  "parts": {"a": {"name": "x", "values": [0.5, 0.0]}, "b": {"name": "y", "note": "z"}}\n'
        "}\n"
    )  # fmt: skip


def test_a_list_that_does_not_fit_fills_its_lines() -> None:
    text = render(Whole(parts={}, words=tuple("long" * 10 + str(number) for number in range(4))))
    first, second = (", ".join(f'"{"long" * 10}{number}"' for number in pair) for pair in ((0, 1), (2, 3)))
    assert text.splitlines()[2:6] == ['  "words": [', f"    {first},", f"    {second}", "  ]"]


def test_an_entry_of_a_table_fills_its_lines_and_another_mapping_has_one_item_a_line() -> None:
    class Tables(BaseModel):
        table: dict[str, dict[str, int]]
        alone: dict[str, int]
        name: str = "tables"

    row = {"long" * 10 + str(number): number for number in range(3)}
    lines = render(Tables(table={"one": row, "other": {"a": 1}}, alone=row, name="x")).splitlines()
    first, second, third = (f'"{name}": {value}' for name, value in row.items())
    assert lines[1:7] == [
        '  "table": {',
        '    "one": {',
        f"      {first}, {second},",
        f"      {third}",
        "    },",
        '    "other": {"a": 1}',
    ]
    assert lines[8:13] == ['  "alone": {', f"    {first},", f"    {second},", f"    {third}", "  },"]


@pytest.mark.parametrize(("indent", "length"), [("  ", 119), ("    ", 119), ("      ", 119)])
def test_line_that_fits_with_a_comma_behind_it_is_not_broken(indent: str, length: int) -> None:
    """A line has at most 120 characters, and one that another follows ends in a comma."""

    class Inner(BaseModel):
        words: tuple[str, ...]

    class Deep(BaseModel):
        inner: Inner | None = None
        deep: Deep | None = None

    def rendered(letters: int) -> list[str]:
        part = Deep(inner=Inner(words=("x" * letters, "")))
        for _ in range(len(indent) // 2 - 1):
            part = Deep(deep=part, inner=Inner(words=("x" * 200, "")))
        return render(part).splitlines()

    taken = len(f'{indent}"inner": {{"words": ["", ""]}}')
    whole = [line for line in rendered(length - taken) if line.startswith(f'{indent}"inner": {{"words"')]
    assert [len(line.rstrip(",")) for line in whole] == [length]
    assert not any(line.startswith(f'{indent}"inner": {{"words"') for line in rendered(length - taken + 1))


def test_only_item_of_a_list_shares_the_lines_of_its_brackets() -> None:
    class Outer(BaseModel):
        wholes: tuple[Whole, ...]

    words = tuple("long" * 10 + str(number) for number in range(3))
    lines = render(Outer(wholes=(Whole(parts={}, words=words),))).splitlines()
    assert lines[:4] == ["{", '  "wholes": [{', '    "parts": {},', '    "words": [']
    assert lines[-3:] == ["    ]", "  }]", "}"]


@pytest.mark.parametrize("cell", CELLS)
def test_no_line_is_longer_than_a_screen_unless_one_value_is(cell: str) -> None:
    for file in ("contract.json", "rehearsals.json", "manifest.json"):
        text = built(cell).texts[file]
        json.loads(text)
        for line in text.splitlines():
            assert len(line) <= 120 or line.count('"') <= 4, line


@pytest.mark.parametrize("cell", CELLS)
def test_contract_is_read_in_a_sitting(cell: str) -> None:
    assert len(built(cell).texts["contract.json"].splitlines()) < 1000
