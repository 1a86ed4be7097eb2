"""Every name that the installed xacro exposes is known here, and answers as it does there."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from itertools import product
from pathlib import Path
from typing import Any

import pytest
import xacro

from cellc.robot.description.xacro_confinement import Confinement
from cellc.robot.description.xacro_expansion import expand_here
from cellc.robot.description.xacro_expression import ExpressionError, evaluate
from cellc.robot.description.xacro_names import known_names, names_of_eval

_NAMESPACES = ("math", "python", "xacro")
_REFUSED = {"python.hash", "python.vars"}
"""Their answers depend on the run."""
_TOLD = {"abs_filename", "arg", "error", "fatal", "load_yaml", "message", "print_location", "warning"}
"""Of the namespace `xacro`: they read files, or write to the terminal."""
_SAMPLES: tuple[Any, ...] = (
    0, 2, -3, 0.5, -1.0, 1e300, "", "4", "a,b c", [], [3, 1, 2], (1.0, 2.0), True, [[1, 2], [3, 4]], {"k": 1}, str,
)  # fmt: skip
_HEAD = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">'


def _real() -> dict[str, Any]:
    found: dict[str, Any] = xacro.create_global_symbols()
    return found


def _ours() -> dict[str, Any]:
    return known_names(Confinement(".")._xacro_functions())


def _names(known: Mapping[str, Any]) -> set[str]:
    inside = {f"{space}.{name}" for space in _NAMESPACES for name in known[space]}
    return inside | set(known) - set(_NAMESPACES) - {"__builtins__"}


def _at(known: Mapping[str, Any], name: str) -> Any:
    space, _, inner = name.rpartition(".")
    return known[space][inner] if space else known[name]


def _asked() -> list[str]:
    told = {f"xacro.{name}" for name in _TOLD} | _TOLD
    return sorted(name for name in _names(_real()) - _REFUSED - told if callable(_at(_real(), name)))


def test_the_names_are_those_of_the_real_xacro() -> None:
    assert _names(_ours()) == _names(_real())


def test_constants_are_those_of_the_real_xacro() -> None:
    for name in sorted(_names(_real())):
        real, ours = (_at(known, name) for known in (_real(), _ours()))
        assert callable(real) == callable(ours), name
        assert callable(real) or _plain(real) == _plain(ours), name


@pytest.mark.parametrize("name", _asked())
def test_a_function_answers_as_that_of_the_real_xacro(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(xacro, "warning", lambda *_texts: None)  # that a plain name is deprecated
    real, ours = _at(_real(), name), _at(_ours(), name)
    answers = 0
    for count in range(4 if name.endswith(("range", "isclose", "slice")) else 3):
        for arguments in product(_SAMPLES, repeat=count):
            expected = _answer(real, arguments)
            assert _answer(ours, arguments) == expected, (name, arguments)
            answers += not str(expected).startswith("raises")
    assert answers or name in ("math.sumprod", "sumprod"), name


@pytest.mark.parametrize("name", sorted(_REFUSED))
def test_a_name_whose_answer_depends_on_the_run_is_refused(name: str) -> None:
    with pytest.raises(ExpressionError, match="depends on the run"):
        evaluate(f"{name}('a')", _ours())


@pytest.mark.parametrize("of", ["", "xacro."])
def test_functions_of_files_and_of_messages_answer_with_and_without_their_namespace(of: str, tmp_path: Path) -> None:
    (tmp_path / "p.yaml").write_text("a: {b: [1, !degrees 180]}\n", encoding="utf-8")
    body = (
        f"<p a=\"${{{of}load_yaml('p.yaml')['a'].b[1]}}\" b=\"${{{of}abs_filename('p.yaml')}}\" "
        f'c="${{{of}dotify(dict(x=3)).x}}"/>'
    )
    if of:
        body += (
            "<q a=\"${xacro.message('m')}${xacro.warning('w')}${xacro.error('e')}${xacro.print_location()}\" "
            "b=\"${xacro.arg('side')}\" c=\"${xacro.tokenize('a;b')[1]}\"/>"
        )
    text = f'{_HEAD}<xacro:arg name="side" default="left"/>{body}</robot>'
    (tmp_path / "r.xacro").write_text(text, encoding="utf-8")
    expanded = expand_here(f"{tmp_path}/r.xacro", {}, str(tmp_path))
    assert expanded.value is not None, expanded.diagnostics
    real = xacro.process_file(f"{tmp_path}/r.xacro", mappings={}).documentElement.toprettyxml(indent="  ")
    assert real.strip() in expanded.value.text


def test_eval_knows_what_python_and_roslaunch_do() -> None:
    from xacro.substitution_args import _eval_dict

    calls = {"env", "find", "optenv"}  # a call cannot stand in `$(eval …)`: xacro ends it at the first parenthesis
    assert {name for name in _eval_dict if not name.startswith("_")} - calls <= set(names_of_eval())


def _answer(function: Callable[..., Any], arguments: Iterable[Any]) -> Any:
    """Return what a function answers; of an error its kind alone."""
    try:
        return _plain(function(*arguments))
    except Exception as error:
        return f"raises {type(error).__name__}"


def _plain(value: Any) -> Any:
    """Return a value that can be compared: the items of what yields them, and not-a-number as a text."""
    if isinstance(value, float) and math.isnan(value):
        return "not a number"
    if isinstance(value, (map, filter, zip, enumerate, range, reversed, type(reversed([])), type(reversed({})))):
        return _plain(list(value))
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return value
