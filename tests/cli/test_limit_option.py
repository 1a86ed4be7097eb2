"""`--limit` raises what cellc reads for one call, in every process of it, and names the limits that there are."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.contract.compute.processes import processes
from cellc.contract.limits import DEFAULTS, LimitError, as_options, in_force, limits, raised, rows
from cellc.tools.cli.batch import in_workers
from cellc.tools.cli.fleet import Task
from tests.cli.run import MINIMAL, run

READING = ("audit", "build", "check", "mock", "show")


def _long(folder: Path) -> str:
    """Return a spec of more than two MiB, all of it a comment but what the minimal cell says."""
    spec = folder / "cell.yaml"
    spec.write_text(Path(MINIMAL).read_text(encoding="utf-8") + "# padding\n" * 220_000, encoding="utf-8")
    return spec.as_posix()


def test_file_that_is_too_large_is_read_where_the_option_raises_the_limit(tmp_path: Path) -> None:
    refused = run("check", _long(tmp_path))
    assert refused.code == 1
    assert "file-too-large" in refused.out
    assert "`--limit spec-bytes=N` raises it" in refused.out
    assert run("check", "--limit", f"spec-bytes={3 * 2**20}", _long(tmp_path)).code == 0


def test_limits_are_the_defaults_again_after_a_command() -> None:
    run("check", "--limit", f"spec-bytes={3 * 2**20}", MINIMAL)
    assert limits() == DEFAULTS


@pytest.mark.parametrize("command", READING)
def test_unknown_limit_is_a_usage_error_that_lists_the_names(command: str) -> None:
    refused = run(command, "--limit", "bytes=9", MINIMAL)
    assert refused.code == 2
    assert "no limit `bytes`" in refused.err
    assert all(name in refused.err.replace("\n", " ") for name in rows())


@pytest.mark.parametrize("value", ["", "0", "-1", "1e9", "nan", "inf", "64", "9" * 5000, "²", "٣000000"])
def test_value_is_a_whole_number_between_the_default_and_the_largest(value: str) -> None:
    with pytest.raises(LimitError, match="`spec-bytes` must be a whole number from 2097152 to 67108864"):
        raised([f"spec-bytes={value}"])


def test_last_value_of_a_name_counts() -> None:
    assert raised(["spec-files=40", "spec-files=50"]).spec_files == 50


def test_limits_are_handed_on_as_options() -> None:
    chosen = raised(["spec-files=40", "xml-depth=100"])
    assert as_options(chosen) == ["spec-files=40", "xml-depth=100"]
    assert raised(as_options(chosen)) == chosen


def test_processes_of_a_call_have_its_limits(tmp_path: Path) -> None:
    with in_force(raised([f"spec-bytes={3 * 2**20}"])):
        results = list(in_workers("check", [Task(_long(tmp_path))], processes(1)))
    assert [found.code for found in results[0].findings.diagnostics if found.code == "file-too-large"] == []
