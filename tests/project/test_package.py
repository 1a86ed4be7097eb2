"""What a program calls: ``cellc.check``, ``cellc.build``, ``cellc.load_mock``."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

import cellc
from cellc.compiler.output.write import WriteReport
from cellc.compiler.pipeline import Checked
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, Span
from cellc.contract.diagnostics.diagnostic import Findings
from cellc.contract.diagnostics.unsafe_text import escaped
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock import AttemptRecord, MockError, RehearsalResult
from tests.cells import ROOT
from tests.cli.run import MINIMAL, run

INVALID = ROOT / "tests/corpus/invalid/circular-mimic-of-two.yaml"


def test_check_returns_the_linked_cell_and_its_findings() -> None:
    checked = cellc.check(MINIMAL)
    assert checked.ok
    assert checked.graph is not None
    assert checked.graph.cell.name == "minimal"
    assert {found.severity for found in checked.diagnostics} <= {Severity.BLOCKER, Severity.WARNING, Severity.AUDIT}


def test_check_tells_of_a_file_that_is_not_there(tmp_path: Path) -> None:
    (found,) = cellc.check(tmp_path / "nothing.yaml").diagnostics
    assert found.code == "file-not-found"


def test_build_writes_what_the_command_writes(tmp_path: Path) -> None:
    report = cellc.build(MINIMAL, tmp_path / "ours")
    assert report.value is not None
    assert run("build", MINIMAL, "-o", (tmp_path / "theirs").as_posix()).code == 0
    theirs = {
        file.relative_to(tmp_path / "theirs/minimal") for file in (tmp_path / "theirs").rglob("*") if file.is_file()
    }
    assert {Path(path) for path in report.value.written} == theirs
    for path in theirs:
        assert (tmp_path / "ours/minimal" / path).read_bytes() == (tmp_path / "theirs/minimal" / path).read_bytes()


def test_build_of_a_cell_with_errors_writes_nothing(tmp_path: Path) -> None:
    report = cellc.build(INVALID, tmp_path / "out")
    assert report.value is None
    assert any(found.severity is Severity.ERROR for found in report.diagnostics)
    assert not (tmp_path / "out").exists()


def test_build_keeps_an_edit_unless_it_is_forced(tmp_path: Path) -> None:
    cellc.build(MINIMAL, tmp_path)
    readme = tmp_path / "minimal/README.md"
    readme.write_text("mine\n")
    refused = cellc.build(MINIMAL, tmp_path)
    assert refused.value is None
    assert "edited-by-hand" in {found.code for found in refused.diagnostics}
    forced = cellc.build(MINIMAL, tmp_path, force=True)
    assert forced.value is not None
    assert forced.value.written == ("README.md",)


def test_loaded_mock_runs_a_rehearsal(tmp_path: Path) -> None:
    assert cellc.build(MINIMAL, tmp_path).value is not None
    mock = cellc.load_mock(tmp_path / "minimal")
    result = mock.run(mock.rehearsals[0])
    assert result.outcome == result.expected


def test_mock_of_no_generated_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MockError):
        cellc.load_mock(tmp_path)


def test_importing_the_package_loads_no_stage() -> None:
    program = "import sys, cellc; print(sorted(name for name in sys.modules if name.startswith('cellc.')))"
    ran = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True)
    assert ran.stdout.strip() == "['cellc.version']"


@pytest.mark.parametrize("name", cellc.__all__)
def test_every_name_that_is_exported_is_there(name: str) -> None:
    assert name in dir(cellc)
    assert getattr(cellc, name).__doc__


def test_a_name_that_is_not_exported_is_an_attribute_error() -> None:
    name = "nothing"
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        getattr(cellc, name)


_OTHERS = {
    "XacroError": "stands for the one of xacro while types are checked",
    "XacroRefusedError": "must be one of xacro's",
    "MotionError": "of a program that runs in a generated folder, without cellc",
    "UnansweredError": "of a program that runs in a generated folder, without cellc",
    "Stopped": "a signal, which nobody catches by mistake",
    "FileTooLargeError": "answers of the system: who opens files catches OSError",
    "NotRegularError": "answers of the system: who opens files catches OSError",
    "CellcError": "the base",
}


def test_every_exception_of_cellc_has_one_base() -> None:
    bases: dict[str, set[str]] = {}
    for file in (ROOT / "cellc").rglob("*.py"):
        for name, of in re.findall(r"^ *class ([A-Z]\w*)\(([\w, ]+)\):$", file.read_text(encoding="utf-8"), re.M):
            bases.setdefault(name, set()).update(of.split(", "))
    raised = {"Exception", "BaseException", "OSError", "ValueError", "XacroError"}
    ours = {"CellcError"} | {name for name, of in bases.items() if "CellcError" in of}
    odd = {name for name, of in bases.items() if of & raised and not of & ours} - _OTHERS.keys()
    assert len(ours) > 20
    assert odd == set()


def _hostile() -> Diagnostic:
    text = "<script>alert(1)</script>\n::error::\x1b[31m\u202e & co"
    return Diagnostic("some-code", Severity.ERROR, text, Span(f"{text}.yaml", 1, 2, 1, 3), help=text)


def _reprs() -> list[object]:
    found = _hostile()
    checked = Checked(Findings(found.span.file, {}, (found,)), None)
    attempt = AttemptRecord(
        attempt_id=found.message,
        rehearsal="a",
        step="b",
        outcome=AttemptOutcome.SUCCEEDED,
        configuration_id="",
        version_tuple={},
        safety_state="",
        fault_code=found.message,
        operator_intervention="none",
        started_ns=0,
        ended_ns=1,
    )
    result = RehearsalResult(
        found.message, AttemptOutcome.SUCCEEDED, AttemptOutcome.SUCCEEDED, 1.0, None, None, (attempt,), (), ()
    )
    return [found, checked, Outcome(None, (found,)), result, WriteReport(("a\nb",), (), ())]


@pytest.mark.parametrize("value", _reprs(), ids=lambda one: type(one).__name__)
def test_what_a_session_prints_is_one_line_that_steers_nothing(value: object) -> None:
    for text in (repr(value), str(value)):
        assert text == escaped(text)
        assert "\n" not in text
        assert len(text) < 200


@pytest.mark.parametrize("value", _reprs()[1:4], ids=lambda one: type(one).__name__)
def test_what_a_notebook_shows_quotes_text_of_strangers_as_text(value: Checked | RehearsalResult) -> None:
    shown = value._repr_html_()
    assert "&lt;script&gt;alert(1)&lt;/script&gt;" in shown
    assert escaped(shown) == shown
    tree = ElementTree.fromstring(shown)
    assert {element.tag for element in tree.iter()} == {"table", "caption", "thead", "tbody", "tr", "th", "td"}
