"""A help that names a kind of controller can be followed: the release has the kind, and what was found is gone."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cellc.compiler.pipeline import check
from cellc.contract.diagnostics import Diagnostic, Severity
from tests.cells import DISTROS, spec_text, written

_KIND = re.compile(r"`type: (\w+)`")
_DEVICE = re.compile(r"with `device: (\w+)`")
_ON_ONE_LINE = re.compile(
    r"^    (\w+): {type: (\w*(?:broadcaster|reset_fault|io_and_status|configuration)), .*\n", re.MULTILINE
)
_SCALED = ("type: scaled_joint_trajectory", "type: joint_trajectory")


def _specs(cell: str, distro: str) -> list[str]:
    """Return a cell on a release as it is, without what only reports, and with other kinds of trajectories."""
    text = re.sub(r"^  ros: \w+", f"  ros: {distro}", spec_text(cell), flags=re.MULTILINE)
    assert f"ros: {distro}" in text
    return list(dict.fromkeys((text, _ON_ONE_LINE.sub("", text), text.replace(*_SCALED), text.replace(*_SCALED[::-1]))))


def _followed(text: str, finding: Diagnostic, kinds: list[str]) -> str:
    device = _DEVICE.search(finding.help)
    if device is not None:
        added = [f"    help_{number}: {{type: {kind}, device: {device[1]}}}\n" for number, kind in enumerate(kinds)]
        return text.replace("  controllers:\n", "  controllers:\n" + "".join(added))
    lines, line, column = text.split("\n"), finding.span.line - 1, finding.span.column - 1
    lines[line] = lines[line][:column] + re.sub(r"^\w+", kinds[0], lines[line][column:])
    return "\n".join(lines)


def _same(finding: Diagnostic) -> tuple[str, str]:
    return finding.code, finding.message


@pytest.mark.parametrize("distro", DISTROS)
@pytest.mark.parametrize("cell", ["ur5e_pick", "fr3_hand", "gen3_2f", "openarm_bimanual", "dual_ur"])
def test_help_that_names_a_kind_is_followed(cell: str, distro: str, tmp_path: Path) -> None:
    for text in _specs(cell, distro):
        found = check(written(tmp_path, text))
        for finding in found:
            kinds = _KIND.findall(finding.help)
            if kinds:
                after = check(written(tmp_path, _followed(text, finding, kinds)))
                assert _same(finding) not in set(map(_same, after)), finding
                errors = {new.code for new in after if new.severity is Severity.ERROR}
                assert errors <= {old.code for old in found if old.severity is Severity.ERROR}, finding
