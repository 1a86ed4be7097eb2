"""Parameter files are read by the rules of rcl_yaml_param_parser, not by those of YAML 1.2 or of PyYAML."""

from __future__ import annotations

import math

import pytest
import yaml

from cellc.mock.control.manager.settings import read_file
from cellc.mock.control.parameters import Parameter, ParameterError, ParameterFile, ParameterFileError, ParameterSet


def _node(values: str) -> dict[str, object]:
    return dict(ParameterFile(f"n:\n  ros__parameters: {{{values}}}").of_node("n", ""))


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("yes", True),
        ("on", True),
        ("n", False),
        ("Off", False),
        ("1", 1),
        ("0x1F", 31),
        ("010", 8),
        ("1.0", 1.0),
        ("1e3", 1000.0),
        (".5", 0.5),
        (".inf", math.inf),
        ("-.inf", -math.inf),
        ("'1'", "1"),
        ('"true"', "true"),
        ("tRUE", "tRUE"),
        ("12:30:00", "12:30:00"),
        ("1.2.3", "1.2.3"),
        ("[1.0, 2.0]", [1.0, 2.0]),
        ("[]", []),
    ],
)
def test_scalar_has_the_type_that_rcl_gives_it(text: str, value: object) -> None:
    read = _node(f"x: {text}")["x"]
    assert read == value
    assert type(read) is type(value)


def test_nested_maps_are_joined_by_dots() -> None:
    assert _node("a: {b: {c: 1}}, d: 2") == {"a.b.c": 1, "d": 2}


@pytest.mark.parametrize(
    ("key", "namespace", "matches"),
    [
        ("n", "", True),
        ("/n", "", True),
        ("n", "/cell", False),
        ("/cell/n", "/cell", True),
        ("cell/n", "/cell", True),
        ("/**", "/cell", True),
        ("/**/n", "/cell", True),
        ("/**/n", "", True),
        ("/*/n", "/cell", True),
        ("/*/n", "", False),
        ("/*/n", "/a/b", False),
        ("/other/n", "/cell", False),
    ],
)
def test_section_reaches_the_nodes_that_its_key_matches(key: str, namespace: str, matches: bool) -> None:
    file = ParameterFile(f"{key}:\n  ros__parameters: {{x: 1}}")
    assert (file.of_node("n", namespace) == {"x": 1}) is matches


def test_later_section_wins() -> None:
    file = ParameterFile("/**:\n  ros__parameters: {x: 1, y: 1}\nn:\n  ros__parameters: {x: 2}")
    assert file.of_node("n", "") == {"x": 2, "y": 1}


@pytest.mark.parametrize(
    "text",
    [
        "n:\n  ros__parameters:\n\tx: 1",
        "n:\n  ros__parameters: {x: [1, 2.0]}",
        "n:\n  ros__parameters: {x: [[1]]}",
        "n:\n  ros__parameters: {x: }",
        "n:\n  parameters: {x: [1]}",
        "n: 3",
        "n: [",
        "- 1",
    ],
)
def test_file_that_rcl_refuses_is_refused(text: str) -> None:
    with pytest.raises(ParameterFileError):
        ParameterFile(text)


def test_integer_for_a_double_is_refused_with_the_message_of_rclcpp() -> None:
    with pytest.raises(ParameterError) as refused:
        ParameterSet({"x": 1}).declare([Parameter("x", "double", 0.0)])
    assert "is of type {double}, setting it to {integer} is not allowed" in refused.value.reason


def test_empty_list_counts_as_not_set() -> None:
    with pytest.raises(ParameterError) as refused:
        ParameterSet({"x": []}).declare([Parameter("x", "string_array", [])])
    assert "No parameter value set" in refused.value.reason


_STYLES = (
    'n:\n  ros__parameters: {plain: 1, single: \'1\', double: "1", list: [1.0, .5], "quoted key": true, block: {a: x}}'
)
_BROKEN = ("n: [", "n:\n  ros__parameters: {x: *y}", "n: {x: 1, x}: 2]", "\x01", "a: b: c")


@pytest.mark.parametrize("text", [_STYLES, *_BROKEN])
def test_file_is_read_alike_with_and_without_libyaml(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def read() -> object:
        try:
            return ParameterFile(text).of_node("n", "")
        except ParameterFileError as error:
            return error.reason

    with_libyaml = read()
    monkeypatch.delattr(yaml, "CSafeLoader")
    assert read() == with_libyaml


def test_parameter_that_is_set_stays_with_its_node() -> None:
    text = "n:\n  ros__parameters: {names: [a, b], rate: 2.0}"
    for _ in range(2):
        parameters = ParameterSet(read_file(text).of_node("n", ""))
        parameters.declare(
            (Parameter("names", "string_array", [], (), False), Parameter("rate", "double", 1.0, (), False))
        )
        assert (parameters.texts("names"), parameters.number("rate")) == (("a", "b"), 2.0)
        parameters.set("names", ["c"])
        parameters.set("rate", 3.0)
