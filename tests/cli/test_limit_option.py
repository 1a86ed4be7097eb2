"""`--limit` raises what cellc reads for one call, in every process of it, and names the limits that there are."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.contract.compute.processes import processes
from cellc.contract.limits import DEFAULTS, LimitError, adjustable, as_options, in_force, limits, raised, rows
from cellc.tools.cli.batch import in_workers
from cellc.tools.cli.fleet import Task
from tests.cli.run import MINIMAL, run

READING = ("audit", "build", "check", "mock", "show")


def _wide(folder: Path) -> str:
    """Return a spec of 40 files, all of them empty but one that has the minimal cell."""
    spec = folder / "cell.yaml"
    parts = [f"{number}.yaml" for number in range(39)]
    for part in parts:
        (folder / part).write_text("hosts: {}\n", encoding="utf-8")
    spec.write_text(Path(MINIMAL).read_text(encoding="utf-8") + f"include: [{', '.join(parts)}]\n", encoding="utf-8")
    return spec.as_posix()


def test_spec_of_too_many_files_is_read_where_the_option_raises_the_limit(tmp_path: Path) -> None:
    refused = run("check", _wide(tmp_path))
    assert refused.code == 1
    assert "too-many-includes" in refused.out
    assert "`--limit spec-files=N` raises it" in refused.out
    assert "too-many-includes" not in run("check", "--limit", "spec-files=40", _wide(tmp_path)).out


def test_limits_are_the_defaults_again_after_a_command() -> None:
    run("check", "--limit", "spec-files=40", MINIMAL)
    assert limits() == DEFAULTS


@pytest.mark.parametrize("command", READING)
def test_unknown_limit_is_a_usage_error_that_lists_the_names(command: str) -> None:
    refused = run(command, "--limit", "bytes=9", MINIMAL)
    assert refused.code == 2
    assert "no limit `bytes`" in refused.err
    assert all(name in refused.err.replace("\n", " ") for name in adjustable())


def test_bound_that_no_cell_comes_near_is_fixed() -> None:
    fixed = [name for name, row in rows().items() if row.highest is None]
    assert "spec-depth" in fixed
    for name in fixed:
        with pytest.raises(LimitError, match=f"no limit `{name}` can be raised"):
            raised([f"{name}=1000000000"])


@pytest.mark.parametrize("value", ["", "0", "-1", "1e9", "nan", "inf", "64", "9" * 5000, "²", "٣0000000"])
def test_value_is_a_whole_number_between_the_default_and_the_largest(value: str) -> None:
    with pytest.raises(LimitError, match="`xml-bytes` must be a whole number from 8388608 to 268435456"):
        raised([f"xml-bytes={value}"])


def test_last_value_of_a_name_counts() -> None:
    assert raised(["spec-files=40", "spec-files=50"]).spec_files == 50


def test_limits_are_handed_on_as_options() -> None:
    chosen = raised(["spec-files=40", "mesh-shapes=2000"])
    assert as_options(chosen) == ["spec-files=40", "mesh-shapes=2000"]
    assert raised(as_options(chosen)) == chosen


def test_processes_of_a_call_have_its_limits(tmp_path: Path) -> None:
    with in_force(raised(["spec-files=40"])):
        results = list(in_workers("check", [Task(_wide(tmp_path))], processes(1)))
    assert "too-many-includes" not in [found.code for found in results[0].findings.diagnostics]
