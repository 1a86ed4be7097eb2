"""What a well-meant xacro file may do, and where its mistakes are reported."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cellc.contract.diagnostics import Diagnostic
from cellc.robot.description.read_description import read_description
from cellc.robot.description.xacro_expansion import expand_here, expand_xacro
from tests.cells import there
from tests.properties import given, settings, st

HEAD = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="mine">'


def _write(folder: Path, body: str, name: str = "robot.urdf.xacro") -> Path:
    file = folder / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(f"{HEAD}\n{body}\n</robot>\n", encoding="utf-8")
    return file


def _failure(file: Path, **arguments: str) -> Diagnostic:
    (found,) = expand_here(str(file), arguments, str(file.parent)).diagnostics
    return found


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("1 + 2 * 3", "7"),
        ("2 ** 0.5", "1.4142135623730951"),
        ("radians(180)", "3.141592653589793"),
        ("-pi / 2", "-1.5707963267948966"),
        ("math.hypot(3, 4)", "5.0"),
        ("'left' if 1 > 2 else 'right'", "right"),
        ("not (1 &lt; 2 &lt;= 3) or 2 in [1, 2]", "True"),
        ("'a b c'.split()[-1].upper()", "C"),
        ("[10, 20, 30][1:]", "[20, 30]"),
        ("dict(a=1)['a'] + len([1, 2])", "3"),
        ("max(list(map(float, '1 5 3'.split())))", "5.0"),
        ("{'x': 4}.get('y', 9)", None),
        ("7 // 2 + 7 % 2", "4"),
        ("xacro.tokenize('a,b c')[2]", "c"),
    ],
)
def test_expression_has_the_value_that_python_gives_it(expression: str, value: str | None, tmp_path: Path) -> None:
    outcome = expand_here(str(_write(tmp_path, f'<a b="${{{expression}}}"/>')), {}, str(tmp_path))
    if value is None:  # xacro ends an expression at the first brace, so a dictionary cannot be written in one
        assert [found.code for found in outcome.diagnostics] == ["xacro-failed"]
    else:
        assert outcome.value is not None, outcome.diagnostics
        assert f'<a b="{value}"/>' in outcome.value.text


def test_parameters_from_yaml_keep_their_units(tmp_path: Path) -> None:
    (tmp_path / "p.yaml").write_text("limits: {elbow: !degrees 180, reach: !millimeters 850}\n", encoding="utf-8")
    body = (
        '<xacro:property name="p" value="${xacro.load_yaml(\'p.yaml\')}"/>'
        "<a b=\"${p['limits']['elbow']}\" c=\"${p.limits.reach}\"/>"
    )
    outcome = expand_here(str(_write(tmp_path, body)), {}, str(tmp_path))
    assert outcome.value is not None, outcome.diagnostics
    assert '<a b="3.141592653589793" c="0.85"/>' in outcome.value.text


def test_package_beside_the_spec_is_found(tmp_path: Path) -> None:
    _write(tmp_path, "<link name='there'/>", "my_description/urdf/part.xacro")
    file = _write(tmp_path, '<xacro:include filename="$(find my_description)/urdf/part.xacro"/>')
    outcome = expand_xacro(file, {}, tmp_path)
    assert outcome.value is not None, outcome.diagnostics
    assert outcome.value.origins[("link", "there")].file.endswith("my_description/urdf/part.xacro")


def test_absent_package_is_reported_with_the_folders_searched(tmp_path: Path) -> None:
    found = _failure(_write(tmp_path, '<xacro:include filename="$(find ur_description)/x.xacro"/>'))
    assert found.code == "xacro-package-not-found"
    assert f"`{tmp_path}/src/ur_description`" in found.help


def test_arguments_reach_the_description(tmp_path: Path) -> None:
    file = _write(tmp_path, '<xacro:arg name="side" default="left"/><link name="$(arg side)_tool"/>')
    names = []
    for arguments in ({}, {"side": "right"}):
        description = there(read_description(file, arguments, tmp_path).value)
        names.append(description.links[0].name)
    assert names == ["left_tool", "right_tool"]


def test_misspelt_argument_is_an_error_and_not_ignored(tmp_path: Path) -> None:
    found = _failure(_write(tmp_path, '<xacro:arg name="side" default="left"/>'), sde="right")
    assert (found.code, found.help) == ("xacro-unknown-argument", "did you mean `side`?")


def test_optional_include_may_be_absent(tmp_path: Path) -> None:
    file = _write(tmp_path, '<xacro:include filename="none.xacro" optional="true"/><link name="a"/>')
    assert expand_here(str(file), {}, str(tmp_path)).value is not None


@pytest.mark.parametrize(
    ("body", "line"),
    [
        ('<link name="a"/>\n<xacro:include filename="none.xacro"/>', 3),
        ('<link name="a"/>\n\n<link name="${1 / 0}"/>', 4),
        ('<xacro:macro name="m" params="x">\n<link\n name="${x / 0}"/>\n</xacro:macro>\n<xacro:m x="1"/>', 3),
        ('<xacro:if value="${1 == 1}">\n<xacro:nothing/>\n</xacro:if>', 3),
        ('<link name="a"/>\n<xacro:unless value="${nonsense}"/>', 3),
        ('<xacro:property name="p" value="1"/>\n<xacro:property value="2"/>', 3),
    ],
    ids=["include", "expression", "inside_macro", "unknown_macro", "condition", "property"],
)
def test_mistake_is_reported_on_its_line(body: str, line: int, tmp_path: Path) -> None:
    found = _failure(_write(tmp_path, body))
    assert found.span.line == line, found


def test_mistake_in_an_included_file_is_reported_there(tmp_path: Path) -> None:
    _write(tmp_path, "\n<a>", "part.xacro")
    found = _failure(_write(tmp_path, '<xacro:include filename="part.xacro"/>'))
    assert (found.code, found.span.file, found.span.line) == ("xml-not-well-formed", f"{tmp_path}/part.xacro", 4)


def test_a_file_that_is_not_there_is_told_with_those_that_look_like_it(tmp_path: Path) -> None:
    for name in ("arm_v2.urdf", "arm_v3.urdf.xacro", "readme.txt"):
        _write(tmp_path, "", f"urdf/{name}")
    found = _failure(_write(tmp_path, '<xacro:include filename="urdf/arm_v2.urdf.xacro"/>'))
    assert (found.code, found.help) == ("xacro-file-not-found", "did you mean `arm_v2.urdf`?")
    found = _failure(_write(tmp_path, '<xacro:include filename="xacro/arm.xacro"/>'))
    assert found.help == f"there is no folder `{tmp_path.as_posix()}/xacro`"


MACRO = '<xacro:macro name="finger"><a/></xacro:macro>'


@pytest.mark.parametrize(
    ("body", "advice"),
    [
        (f"<xacro:finger/>\n{MACRO}", "line 3 of `robot.urdf.xacro`"),
        (f"{MACRO}\n<xacro:fingers/>", "did you mean `finger`?"),
        (f"{MACRO}\n<xacro:thumb/>", "include the file that defines it"),
        ("<xacro:thumb/>", "include the file that defines it"),
        (f'{MACRO}\n<xacro:finger side="left"/>', "`params` of macro `finger`, line 2 of `robot.urdf.xacro`"),
        ('<xacro:macro name="finger" params="side"/>\n<xacro:finger/>', "line 2 of"),
        (
            '<macro name="finger" params="side"><link name="${side}"/></macro>',
            "write `<xacro:macro>` for the `<macro>`",
        ),
    ],
)
def test_a_call_that_fits_no_macro_is_told_with_the_way_on(body: str, advice: str, tmp_path: Path) -> None:
    found = _failure(_write(tmp_path, body))
    assert found.code == "xacro-failed"
    assert advice in found.help


def test_malformed_joint_is_reported_where_it_was_written(tmp_path: Path) -> None:
    body = '<xacro:macro name="m">\n<joint name="j" type="rotary"/>\n</xacro:macro>\n<xacro:m/>'
    (found,) = read_description(_write(tmp_path, body), {}, tmp_path).diagnostics
    assert (found.code, found.span.line) == ("urdf-unknown-joint-type", 3)


def test_expanding_twice_gives_the_same(tmp_path: Path) -> None:
    # xacro keeps state in its module: an expansion that failed must leave nothing behind.
    good = _write(tmp_path, '<xacro:macro name="m"><link name="a"/></xacro:macro><xacro:m/>')
    bad = _write(tmp_path, '<xacro:macro name="m"><link name="${1/0}"/></xacro:macro><xacro:m/>', "bad.xacro")
    first = expand_here(str(good), {}, str(tmp_path))
    assert expand_here(str(bad), {"x": "1"}, str(tmp_path)).value is None
    assert expand_here(str(good), {}, str(tmp_path)) == first


def test_plain_urdf_outside_the_root_is_refused(tmp_path: Path) -> None:
    (tmp_path / "out.urdf").write_text('<robot name="r"><link name="a"/></robot>', encoding="utf-8")
    (tmp_path / "cell").mkdir()
    (found,) = read_description(tmp_path / "cell" / ".." / "out.urdf", {}, tmp_path / "cell").diagnostics
    assert found.code == "xacro-outside-root"


def test_a_package_is_found_from_a_relative_root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "shapes").mkdir()
    (tmp_path / "shapes/shape.xacro").write_text('<robot><link name="found"/></robot>')
    (tmp_path / "arm").mkdir()
    _write(tmp_path / "arm", '<xacro:include filename="$(find shapes)/shape.xacro"/>')
    monkeypatch.chdir(tmp_path)
    (file,) = (tmp_path / "arm").iterdir()
    expanded = expand_here(f"arm/{file.name}", {}, ".")
    assert expanded.value is not None, expanded.diagnostics
    assert expanded.value.origins["link", "found"].file == "shapes/shape.xacro"


_PIECES = st.sampled_from(
    ["<xacro:macro name='m' params='a:=1 *b'>", "</xacro:macro>", "<xacro:m/>", "<xacro:m a='2'><x/></xacro:m>", "${",
     "}", "$(arg a)", "$(", ")", "<xacro:if value='${1}'>", "</xacro:if>", "<xacro:property name='p' value='${p+1}'/>",
     "<xacro:insert_block name='b'/>", "<link name='${m}'/>", "<xacro:include filename='*'/>", "<xacro:include/>",
     "<xacro:call macro='m'/>", "<xacro:arg name='a'/>", "<xacro:element/>", "<xacro:attribute name='q' value='1'/>",
     "$$"]
)  # fmt: skip


@settings(max_examples=200)
@given(body=st.lists(_PIECES, max_size=8).map("".join))
def test_expander_answers_any_text(body: str, tmp_path_factory: pytest.TempPathFactory) -> None:
    folder = tmp_path_factory.mktemp("fuzz")
    outcome = expand_here(str(_write(folder, body)), {}, str(folder))
    assert outcome.value is not None or outcome.diagnostics


def test_wildcard_takes_every_file_that_it_matches_in_order_of_names(tmp_path: Path) -> None:
    for name in ("parts/b.xacro", "parts/a.xacro", "parts/c.txt", "d.xacro"):
        _write(tmp_path, f'<link name="{Path(name).stem}"/>', name)
    file = _write(tmp_path, '<xacro:include filename="parts/*.xacro"/><xacro:include filename="parts/../?.xacro"/>')
    expanded = there(expand_here(str(file), {}, str(tmp_path)).value)
    assert re.findall(r'<link name="(\w)"', str(expanded)) == ["a", "b", "d"]
