"""Descriptions from a stranger end in a diagnostic, fast, whatever they try."""

from __future__ import annotations

import os
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from cellc.compiler.pipeline import check
from cellc.contract.diagnostics import Diagnostic
from cellc.contract.limits import DEFAULTS, Budget, children_seconds, in_force, limits
from cellc.robot.description.mesh_numbers import read_meshes
from cellc.robot.description.meshes import MeshError, identify
from cellc.robot.description.xacro_expansion import expand_here, expand_xacro
from tests.cells import CORPUS

_HEAD = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="stranger">'

# Body of the description, and the code that it must end in.
ATTACKS = {
    "include_outside": ('<xacro:include filename="../../secret.xacro"/>', "xacro-outside-root"),
    "include_absolute": ('<xacro:include filename="/etc/passwd"/>', "xacro-outside-root"),
    "include_wildcard_outside": ('<xacro:include filename="../*.xacro"/>', "xacro-outside-root"),
    "include_optional_outside": ('<xacro:include filename="/etc/passwd" optional="true"/>', "xacro-outside-root"),
    "yaml_outside": ("<a b=\"${xacro.load_yaml('/etc/passwd')}\"/>", "xacro-outside-root"),
    "abs_filename_outside": ("<a b=\"${xacro.abs_filename('../secret.xacro')}\"/>", "xacro-outside-root"),
    "environment": ('<a b="$(env HOME)"/>', "xacro-refused-substitution"),
    "optional_environment_of_nothing": ('<a b="$(optenv)"/>', "xacro-refused-substitution"),
    "substitution_eval": ("<a b=\"$(eval ''.__class__)\"/>", "xacro-refused-expression"),
    "substitution_eval_of_environment": ('<a b="$(eval env[0])"/>', "xacro-failed"),
    "substitution_eval_power": ('<a b="$(eval 9**9**9)"/>', "xacro-refused-expression"),
    "current_folder": ('<a b="$(cwd)"/>', "xacro-refused-substitution"),
    "package_outside": ('<xacro:include filename="$(find ../..)/secret.xacro"/>', "xacro-package-not-found"),
    "class_attribute": ("<a b=\"${''.__class__.__mro__}\"/>", "xacro-refused-expression"),
    "class_by_format": ("<a b=\"${'x'.format(1)}\"/>", "xacro-refused-expression"),
    "made_class": ("<a b=\"${python.type('X', (), dict())}\"/>", "xacro-failed"),
    "subclasses": ("<a b=\"${python.type('').__subclasses__()}\"/>", "xacro-refused-expression"),
    "order_of_bases": ("<a b=\"${python.type('').mro()}\"/>", "xacro-refused-expression"),
    "unbound_format": ("<a b=\"${str.format('x', 1)}\"/>", "xacro-refused-expression"),
    "vars_function": ('<a b="${vars()}"/>', "xacro-failed"),
    "vars_of_python": ('<a b="${python.vars()}"/>', "xacro-refused-expression"),
    "huge_factorial": ('<a b="${factorial(10**9)}"/>', "xacro-refused-expression"),
    "star_format": ("<a b=\"${'%*d' % (10**9, 1)}\"/>", "xacro-refused-expression"),
    "huge_justified": ("<a b=\"${'a'.ljust(10**12)}\"/>", "xacro-too-large"),
    "huge_replaced": (
        "<a b=\"${('a' * 9999).replace('a', 'b' * 9999).replace('b', 'c' * 9999)}\"/>",
        "xacro-refused-expression",
    ),
    "loops_in_a_list": (
        '<a b="${[1 for i in range(99) for j in range(99) for k in range(99)]}"/>',
        "xacro-refused-expression",
    ),
    "place_in_a_comprehension": ('<a b="${[1 for pi.x in [1]]}"/>', "xacro-refused-expression"),
    "import_function": ("<a b=\"${__import__('os')}\"/>", "xacro-refused-expression"),
    "lambda": ('<a b="${(lambda: 1)()}"/>', "xacro-refused-expression"),
    "comprehension": ('<a b="${[i for i in range(9999) for j in range(9999)]}"/>', "xacro-refused-expression"),
    "huge_power": ('<a b="${9**9**9}"/>', "xacro-refused-expression"),
    "power_of_power": ('<a b="${((9.0**99)**99)**99}"/>', "xacro-failed"),
    "huge_text": ("<a b=\"${'a' * 10**12}\"/>", "xacro-refused-expression"),
    "huge_range": ('<a b="${len(python.range(10**12))}"/>', "xacro-refused-expression"),
    "padded_format": ("<a b=\"${'%999999999d' % 1}\"/>", "xacro-refused-expression"),
    "huge_shift": ('<a b="${1 &lt;&lt; 10**9}"/>', "xacro-refused-expression"),
    "includes_itself": ('<xacro:include filename="robot.urdf.xacro"/>', "xacro-too-large"),
    "macro_calls_itself": ('<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>', "xacro-too-large"),
    "property_needs_itself": ('<xacro:property name="p" value="${p}"/><a b="${p}"/>', "xacro-failed"),
    "unknown_macro": ("<xacro:no_such_macro/>", "xacro-failed"),
    "deep_nesting": ("<a>" * 5000 + "</a>" * 5000, "xml-too-deep"),
    "not_closed": ("<a>", "xml-not-well-formed"),
}


def _write(folder: Path, text: str) -> Path:
    file = folder / "robot.urdf.xacro"
    file.write_text(text, encoding="utf-8")
    return file


def _reported(file: Path, root: Path) -> tuple[Diagnostic, ...]:
    outcome = expand_xacro(
        file, {}, root, wall_seconds=120.0
    )  # beyond what the child may compute: a busy machine waits
    assert outcome.value is None
    assert not any("time" in found.message for found in outcome.diagnostics)  # neither limit of time was what ended it
    return outcome.diagnostics


@pytest.mark.parametrize("name", sorted(ATTACKS))
def test_hostile_description_ends_in_one_diagnostic(name: str, tmp_path: Path) -> None:
    body, code = ATTACKS[name]
    root = tmp_path / "cells" / "stranger"
    root.mkdir(parents=True)
    for place in (tmp_path, tmp_path / "cells"):
        (place / "secret.xacro").write_text(f"{_HEAD}<link name='secret'/></robot>", encoding="utf-8")
    (found,) = _reported(_write(root, f"{_HEAD}\n{body}</robot>"), root)
    assert found.code == code
    assert "\n" not in found.message
    assert found.span.file.endswith("robot.urdf.xacro")


def test_exponential_macros_are_counted(tmp_path: Path) -> None:
    # In this process and with a lower bound: fifty thousand elements take seconds.
    doubling = "".join(
        f'<xacro:macro name="m{i}"><xacro:m{i - 1}/><xacro:m{i - 1}/></xacro:macro>' for i in range(1, 40)
    )
    body = f'<xacro:macro name="m0"><a/></xacro:macro>{doubling}<xacro:m39/>'
    file = _write(tmp_path, f"{_HEAD}{body}</robot>")
    with in_force(replace(DEFAULTS, xacro_elements=1000)):
        outcome = expand_here(file.as_posix(), {}, tmp_path.as_posix())
    assert [found.message for found in outcome.diagnostics] == ["the expansion has more than 1000 elements"]
    assert outcome.diagnostics[0].code == "xacro-too-large"


def test_entity_bomb_is_refused(tmp_path: Path) -> None:
    entities = "".join(f'<!ENTITY e{i} "{f"&e{i - 1};" * 10}">' for i in range(1, 20))
    text = f'<!DOCTYPE robot [<!ENTITY e0 "x">{entities}]>{_HEAD}&e19;</robot>'
    (found,) = _reported(_write(tmp_path, text), tmp_path)
    assert found.code == "xml-entities"


def test_alias_bomb_in_parameters_is_refused(tmp_path: Path) -> None:
    lines = ["a0: &a0 x"] + [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]" for i in range(1, 20)]
    (tmp_path / "bomb.yaml").write_text("\n".join(lines), encoding="utf-8")
    text = f"{_HEAD}<a b=\"${{xacro.load_yaml('bomb.yaml')['a19']}}\"/></robot>"
    (found,) = _reported(_write(tmp_path, text), tmp_path)
    assert found.code == "xacro-bad-yaml"


def test_symbolic_link_out_of_the_root_is_refused(tmp_path: Path) -> None:
    root = tmp_path / "cell"
    root.mkdir()
    (tmp_path / "secret.xacro").write_text(f"{_HEAD}</robot>", encoding="utf-8")
    os.symlink(tmp_path / "secret.xacro", root / "innocent.xacro")
    file = _write(root, f'{_HEAD}<xacro:include filename="innocent.xacro"/></robot>')
    (found,) = _reported(file, root)
    assert found.code == "xacro-outside-root"


def test_endless_expansion_is_ended_by_the_wall(tmp_path: Path) -> None:
    loops = "".join(f'<a{i} b="${{python.sorted(python.range(9999))[0]}}"/>' for i in range(5000))
    outcome = expand_xacro(_write(tmp_path, f"{_HEAD}{loops}</robot>"), {}, tmp_path, wall_seconds=0.5)
    assert [found.code for found in outcome.diagnostics] == ["xacro-too-large"]


def test_busy_machine_gives_the_answer_of_an_idle_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # On two cores with 25 busy processes, 8 s of a processor were 100 s by the clock, and good robots were refused.
    given: list[float] = []
    run = subprocess.run

    def watched(command: list[str], *, timeout: float, **options: Any) -> Any:
        given.append(timeout)
        return run(command, timeout=timeout, **options)

    monkeypatch.setattr("cellc.robot.description.confined_child.subprocess.run", watched)
    budget = Budget(limits().xacro_seconds_together, children_seconds)
    assert expand_xacro(_write(tmp_path, f"{_HEAD}<link name='a'/></robot>"), {}, tmp_path, budget=budget).value
    triangle = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    (tmp_path / "a.stl").write_text(f"solid a\n{triangle}endsolid a\n", encoding="utf-8")
    (read,) = read_meshes((identify(f"file://{tmp_path}/a.stl", (tmp_path,), ()),))
    assert not isinstance(read, MeshError)
    assert min(given) > 50 * max(limits().mesh_seconds, limits().xacro_seconds)


def test_after_an_expansion_that_took_its_time_no_other_of_the_spec_begins(tmp_path: Path) -> None:
    stage = CORPUS / "valid" / "parts" / "stage"
    loops = "".join(f'<a{i} b="${{python.sorted(python.range(9999))[0]}}"/>' for i in range(5000))
    for name in ("slow", "quick"):
        (tmp_path / name).mkdir()
        facts = (stage / "device.yaml").read_text(encoding="utf-8").replace("stage.urdf", "robot.urdf.xacro")
        (tmp_path / name / "device.yaml").write_text(facts.replace("model: stage", f"model: {name}"), encoding="utf-8")
        _write(tmp_path / name, f"{_HEAD}{loops if name == 'slow' else ''}</robot>")
    spec = "format: 1\ncell: demo\nversions: {ros: jazzy}\ndevices:\n  a: {model: ./slow}\n  b: {model: ./quick}\n"
    (tmp_path / "cell.yaml").write_text(spec, encoding="utf-8")
    with in_force(replace(DEFAULTS, xacro_seconds=1)):
        found = [
            diagnostic
            for diagnostic in check(tmp_path / "cell.yaml").diagnostics
            if diagnostic.code == "xacro-too-large"
        ]
    assert [Path(finding.span.file).parent.name for finding in found] == ["quick", "slow"]
    assert "was not started" in found[0].message


def test_import_path_is_not_the_strangers_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "xacro.py").write_text("raise SystemExit('the stranger runs')", encoding="utf-8")
    (tmp_path / "json.py").write_text("raise SystemExit('the stranger runs')", encoding="utf-8")
    _write(tmp_path, f"{_HEAD}<link name='a'/></robot>")
    monkeypatch.chdir(tmp_path)
    outcome = expand_xacro(Path("robot.urdf.xacro"), {}, Path())
    assert outcome.value is not None, outcome.diagnostics
    assert '<link name="a"/>' in outcome.value.text


@pytest.mark.parametrize(
    "pattern", ["../*.xacro", "../*/*.xacro", "parts/../../*", "*/../../*", "away/*", "*/s*", "/e*/p*"]
)
@pytest.mark.parametrize("exists", [True, False])
def test_wildcard_does_not_tell_what_lies_outside(pattern: str, exists: bool, tmp_path: Path) -> None:
    root = tmp_path / "cell"
    (root / "parts").mkdir(parents=True)
    (tmp_path / "away").mkdir()
    if exists:
        (tmp_path / "secret.xacro").write_text("", encoding="utf-8")
        (tmp_path / "away" / "secret.xacro").write_text("", encoding="utf-8")
    os.symlink(tmp_path / "away", root / "away")
    text = f'{_HEAD}<xacro:include filename="{pattern}"/></robot>'
    if pattern == "*/s*" and not exists:
        return  # nothing is matched through the link, and nothing told
    (found,) = _reported(_write(root, text), root)
    assert found.code == "xacro-outside-root"
    assert "secret" not in found.message
    assert "passwd" not in found.message
