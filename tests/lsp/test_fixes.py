"""Every finding that proposes a text has a fix that ends it, the nearest first: in the examples of all rules.

A session takes one example of five; with ``--long`` every one is taken.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterable
from pathlib import Path

import pytest

from cellc.compiler.pipeline import check
from cellc.compiler.rules.run import ALL_RULES
from cellc.compiler.source import SourceDocument, read
from cellc.contract.diagnostics.diagnostic import Diagnostic
from tests.cells import CORPUS, there
from tests.lsp.proposals import faults, proposing, remedies_of
from tests.rules.examples import diagnose_example, examples
from tests.sample import sample

_SHARE = 5
INVALID = sorted((CORPUS / "invalid").glob("*.yaml"))


def test_cases_of_the_corpus(request: pytest.FixtureRequest) -> None:
    wrong = {}
    for case in sample(request, INVALID, _SHARE, lambda case: case.stem):
        document = read(case).value
        if document is not None:
            wrong[case.stem] = _faults(check(case), document)
    assert {case: found for case, found in wrong.items() if found} == {}


def test_examples_of_rules(request: pytest.FixtureRequest, tmp_path: Path) -> None:
    wrong = {}
    for rule in sample(request, ALL_RULES, _SHARE, lambda rule: rule.code):
        found = diagnose_example(examples(rule)[0], tmp_path)
        wrong[rule.code] = _faults(found, there(read(tmp_path / "cell.yaml").value))
    assert {code: found for code, found in wrong.items() if found} == {}


def _faults(found: Iterable[Diagnostic], document: SourceDocument) -> list[str]:
    proposed = [one for one in proposing(found) if one.span.file in document.texts]
    return [fault for one in proposed for fault in faults(one, document)]


_STAGE = """\
format: 1
cell: line
summary: a stage alone
hosts: {control_pc: {scheduling: generic}}
versions: {ros: jazzy}
devices:
  stage: {model: ./stage, mount: {parent: world, xyz: 0 0 250 mm}}
control:
  update_rate: 100 Hz
  host: control_pc
  controllers:
    joint_states: {type: joint_state_broadcaster}
network: {discovery: localhost}
"""
_SLIPS = [
    ("update_rate: 100 Hz", "update_rate: 100 hertz", ["Hz"], True),
    ("update_rate: 100 Hz", "update_rate: 100", ["100 Hz", "100 kHz", "100 MHz"], False),
    ("update_rate: 100 Hz", "update_rate: 100 mHz", ["MHz", "Hz", "kHz"], True),
    ("0 0 250 mm", "0 0 250", ["0 0 250 mm", "0 0 250 cm", "0 0 250 m", "0 0 250 um"], False),
    ("  host: control_pc", "  Host: control_pc", ["host"], True),
    ("  host: control_pc", "  host: Control_PC", ["control_pc"], True),
    ("summary: a stage alone", "summary: 12", ['"12"'], True),
    ("discovery: localhost", "discovery: Localhost", ["localhost"], True),
    ("cell: line", "cell: my-line", ["my_line"], True),
    ("mount: {parent: world", "mount: {parent: wrold", ["world"], True),
    ("mount: {parent: world", "mount: {parnet: world", ["parent"], True),
    ("ros: jazzy", "ros: jazy", ["jazzy"], True),
]


@pytest.mark.parametrize(("right", "wrong", "instead", "near"), _SLIPS)
def test_what_is_offered_for_a_slip(right: str, wrong: str, instead: list[str], near: bool, tmp_path: Path) -> None:
    shutil.copytree(CORPUS / "invalid/base/stage", tmp_path / "stage")
    spec = tmp_path / "cell.yaml"
    spec.write_text(_STAGE.replace(right, wrong), encoding="utf-8")
    document = there(read(spec).value)
    proposed = proposing(check(spec))
    remedies = [remedy for one in proposed for remedy in remedies_of(one, document)]
    assert [remedy.edit.text for remedy in remedies] == instead
    assert [remedy.preferred for remedy in remedies] == [near] + [False] * (len(instead) - 1)
    assert [fault for one in proposed for fault in faults(one, document)] == []


def test_a_key_that_is_there_already_is_not_offered_again(tmp_path: Path) -> None:
    spec = tmp_path / "cell.yaml"
    spec.write_text(_STAGE.replace("  host: control_pc", "  host: control_pc\n  hoste: control_pc"), encoding="utf-8")
    unknown = next(one for one in check(spec) if one.code == "unknown-key")
    assert unknown.help == "did you mean `host`?"
    assert remedies_of(unknown, there(read(spec).value)) == []
