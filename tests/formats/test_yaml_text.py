"""YAML that another reader takes with the same values and types."""

from __future__ import annotations

import math

import pytest
import yaml

from cellc.compiler.cell.interface import ParameterValue
from cellc.compiler.formats.yaml_text import nested, render, render_rows, scalar
from tests.properties import given, st

# YAML 1.1's readings, and the words that strtod takes for numbers in rcl_yaml_param_parser.
_MISREAD = ["on", "Off", "yes", "N", "true", "null", "~", "010", "1e3", "0x1F", "12:30:00", "1_000", "nan", "inf", ""]


@pytest.mark.parametrize("text", _MISREAD)
def test_texts_that_readers_misread_are_quoted(text: str) -> None:
    assert scalar(text) == f'"{text}"'
    assert yaml.safe_load(scalar(text)) == text


@given(st.text(st.characters(blacklist_categories=("Cs", "Cc"), blacklist_characters="\x85\u2028\u2029\ufeff")))
def test_any_text_reads_back(text: str) -> None:
    assert yaml.safe_load(render({"key": text})) == {"key": text}


@given(st.floats(allow_nan=False))
def test_doubles_stay_doubles(value: float) -> None:
    read = yaml.safe_load(scalar(value))
    assert isinstance(read, float)
    assert read == value


@pytest.mark.parametrize(
    ("value", "text"),
    [(1.0, "1.0"), (0.1, "0.1"), (-0.0, "0.0"), (1e-5, "1.0e-05"), (1e22, "1.0e+22"), (math.inf, ".inf"), (3, "3")],
)
def test_numbers_take_their_shortest_text(value: float, text: str) -> None:
    assert scalar(value) == text


def test_dots_nest() -> None:
    assert nested({"a.b": 1, "a.c.d": "x", "e": 2.0}) == {"a": {"b": 1, "c": {"d": "x"}}, "e": 2.0}


def test_name_that_begins_another_keeps_both() -> None:
    # rcl joins keys with dots, so that a dotted key means the same as nesting.
    assert nested({"a": 1, "a.b": 2, "a.b.c": 3}) == {"a": 1, "a.b": 2, "a.b.c": 3}


def test_lists_take_a_line_an_item_and_empty_ones_none() -> None:
    assert render({"joints": ("j1", "on"), "gains": (1.0, 2.5), "none": ()}) == (
        'joints:\n  - j1\n  - "on"\ngains: [1.0, 2.5]\n'
    )


def test_name_of_what_is_empty_is_left_out() -> None:
    """rcl refuses a parameter file with a name without a value (rcl_yaml_param_parser, `No value at line`)."""
    assert yaml.safe_load(render({"a": {"b": {"c": (), "d": {}}, "e": {"f": ()}}, "g": 1})) == {"g": 1}


def test_rows_are_in_flow_style_with_their_lists_below_where_one_line_is_too_short() -> None:
    row: dict[str, ParameterValue] = {"parent": "b" * 40, "kind": "link", "authority": "c" * 40}
    row |= {"xyz": (0.0, 1.5, 2.0), "note": "a: b"}
    text = render_rows({"short": {"kind": "y", "xyz": (0.0, 1.0)}, "long": row, "bare": {}}, 1)
    assert text.splitlines() == [
        '  short: {kind: "y", xyz: [0.0, 1.0]}',
        f'  long: {{parent: {"b" * 40}, kind: link, authority: {"c" * 40}, note: "a: b",',
        "    xyz: [0.0, 1.5, 2.0]}",
        "  bare: {}",
    ]
    read = yaml.safe_load(f"rows:\n{text}")["rows"]
    assert read["long"] == {**row, "xyz": [0.0, 1.5, 2.0]}
