"""Install the lowest and the newest dependencies that are allowed, and run the main job with each: prints a table.

    python -m tests.project.dependency_range --python python3.10 --python python3.13 --suite

It needs Python with `venv` and nothing else. For each interpreter and each end of the range it makes a fresh
environment, installs the wheel of cellc with what its tests need, all from wheels, builds every cell outside of the
checkout, holds the folders against `generated/`, and runs the rehearsals of `ur5e_pick`. With `--suite` it runs the
tests too.

*Lowest* is each lower bound of `pyproject.toml` taken as the version; what these bring along is the newest that fits,
as a user gets it today (`--resolution lowest-direct` of uv). Linters are left out there: what mypy says depends on the
annotations of the newest libraries.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import tempfile
import time
import zipfile
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from email import message_from_bytes
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RANGES = ("lowest", "newest")
_LINTERS = "tests/project/test_quality.py"
_SHOWN = ("numpy", "pin", "pydantic", "ruckig", "click")
_BOUND = re.compile(r"([A-Za-z0-9._-]+)(?:\[[^]]*\])?\s*>=\s*([^,;\s]+)\s*")
_EXACT = re.compile(r"([A-Za-z0-9._-]+)(?:\[[^]]*\])?\s*==\s*[^,;\s]+\s*")
_EXTRA = re.compile(r"(?:\s+and\s+)?extra\s*==\s*['\"][^'\"]*['\"]")


@dataclass
class Row:
    """What one interpreter made of one end of the range; `failed` is the first step that did."""

    python: str
    end: str
    versions: str = ""
    seconds: dict[str, float] = field(default_factory=dict)
    failed: str = ""
    said: str = ""


class StepError(Exception):
    """A step ended otherwise than it shall; it holds what the step printed."""


def lowest(requirements: Iterable[str]) -> tuple[str, ...]:
    """Return the constraints that hold each requirement to its lower bound.

    Raises:
        ValueError: a requirement has no lower bound.
    """
    constraints = []
    for requirement in requirements:
        stated, _, marker = requirement.partition(";")
        marker = _EXTRA.sub("", marker).strip()
        bound = _BOUND.match(stated)
        if bound is None:
            if _EXACT.fullmatch(stated):
                continue
            raise ValueError(f"`{requirement}` states no lower bound")
        name, version = bound.groups()
        constraints.append(f"{name}=={version}" + (f"; {marker}" if marker else ""))
    return tuple(sorted(set(constraints)))


def requirements_of(wheel: Path) -> tuple[str, ...]:
    """Return the requirements in the metadata of a wheel."""
    with zipfile.ZipFile(wheel) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        return tuple(message_from_bytes(archive.read(name)).get_all("Requires-Dist", []))


def examine(python: str, end: str, folder: Path, suite: Sequence[str] | None) -> Row:
    """Run every step with one interpreter and one end of the range.

    Args:
        folder: where the environment and what is built go; it is empty.
        suite: arguments of pytest, or None where only the main job is run.
    """
    row = Row(_run([python, "-c", "import platform; print(platform.python_version())"], folder).strip(), end)
    inside = str(folder / "venv/bin/python")
    steps: dict[str, Callable[[], str]] = {
        "install": lambda: _install(python, end, folder),
        "build": lambda: _build(inside, folder),
        "mock": lambda: _run([inside, "-m", "cellc", "mock", str(folder / "generated/ur5e_pick")], folder),
    }
    if suite is not None:
        left_out = ["--ignore", _LINTERS] if end == "lowest" else []
        steps["suite"] = lambda: _run([inside, "-m", "pytest", "-q", "-p", "no:cacheprovider", *left_out, *suite], ROOT)
    for name, step in steps.items():
        begin = time.monotonic()
        try:
            row.said = step()
        except StepError as error:
            row.failed, row.said = name, str(error)
        row.seconds[name] = time.monotonic() - begin
        if row.failed:
            break
        if name == "install":
            row.versions = row.said
    return row


def _install(python: str, end: str, folder: Path) -> str:
    _run([python, "-m", "venv", str(folder / "venv")], folder)
    pip = [str(folder / "venv/bin/python"), "-m", "pip", "--quiet", "--disable-pip-version-check"]
    _run([*pip, "wheel", "--no-deps", "--wheel-dir", str(folder), str(ROOT)], folder)
    (wheel,) = folder.glob("cellc-*.whl")
    constraints = folder / "constraints.txt"
    constraints.write_text("\n".join(lowest(requirements_of(wheel)) if end == "lowest" else ()) + "\n")
    _run([*pip, "install", "--only-binary", ":all:", "-c", str(constraints), f"{wheel}[test,evidence,docs]"], folder)
    _run([*pip, "check"], folder)
    versions = "; ".join(f"print({name!r}, version({name!r}))" for name in _SHOWN)
    printed = _run([pip[0], "-c", f"from importlib.metadata import version; {versions}"], folder)
    return ", ".join(printed.splitlines())


def _build(python: str, folder: Path) -> str:
    cells = sorted(str(path) for path in (ROOT / "cells").glob("*/cell.yaml"))
    said = _run([python, "-m", "cellc", "build", *cells, "-o", str(folder / "generated")], folder)
    built, committed = _files(folder / "generated"), _files(ROOT / "generated")
    other = sorted(name for name in built.keys() | committed.keys() if built.get(name) != committed.get(name))
    if other:
        raise StepError(f"{len(other)} files are not as committed, the first is {other[0]}")
    return said


def _files(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def _run(command: Sequence[str], folder: Path) -> str:
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        raise StepError(f"{' '.join(command)} ended with {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def main() -> int:
    """Print the table; end with 1 where a step failed."""
    parser = argparse.ArgumentParser(prog="python -m tests.project.dependency_range", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("--python", action="append", help="an interpreter, repeatable; this one by default")
    parser.add_argument("--end", action="append", choices=RANGES, help="one end of the range; both by default")
    parser.add_argument("--suite", action="store_true", help="run the tests too")
    parser.add_argument("pytest", nargs="*", help="after --: arguments of pytest, such as -n 2")
    chosen = parser.parse_args()
    print(f"{'python':8} {'range':7} {'result':15} {'seconds':45} versions", flush=True)
    failed = False
    for python in chosen.python or [sys.executable]:
        for end in chosen.end or RANGES:
            with tempfile.TemporaryDirectory(prefix="cellc-range-") as folder:
                row = examine(python, end, Path(folder), chosen.pytest if chosen.suite else None)
            seconds = ", ".join(f"{name} {taken:.0f}" for name, taken in row.seconds.items())
            result = f"{row.failed} failed" if row.failed else "good"
            print(f"{row.python:8} {row.end:7} {result:15} {seconds:45} {row.versions}", flush=True)
            if row.failed or chosen.suite:
                print(
                    "\n".join(f"    {line}" for line in row.said.splitlines()[-40 if row.failed else -1 :]), flush=True
                )
            failed = failed or bool(row.failed)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
