"""What a person has after README's first command, and what a release would hold: made once for all who ask.

The command is run to the letter, in a copy of the files of this repository, with the interpreter of the tests. The
libraries that the wheel requires, and no other, are linked from there before: pip finds them, and fetches what lacks.
`.ci/release` has pip fetch all of them.
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from zipfile import ZipFile

import pytest
from packaging.requirements import Requirement

from tests.cells import ROOT
from tests.cli.run import Ran

_LEFT_OUT = (":!tests", ":!benchmarks")
_DRIVER = """\
import contextlib, io, json, os, sys
from cellc.tools.cli.main import run
for words in json.load(sys.stdin):
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            code = run(words)
        except BaseException as end:
            code, _ = 99, print(repr(end), file=err)
    print(json.dumps([code, out.getvalue(), err.getvalue()]))
"""
_TREE = """\
import click, json
from cellc.tools.cli.main import cellc
def walk(name, command):
    if not isinstance(command, click.Group):
        return [name]
    context = click.Context(command)
    return [part for sub in command.list_commands(context)
            for part in walk(f"{name} {sub}".strip(), command.get_command(context, sub))]
print(json.dumps(walk("", cellc)))
"""


@dataclass(frozen=True, slots=True)
class Install:
    """A copy of the repository in which README's first command was run.

    Attributes:
        told: what the command printed.
        dist: folder with a wheel and an sdist of the copy.
    """

    checkout: Path
    told: Ran
    dist: Path

    @property
    def python(self) -> Path:
        """The interpreter of the environment."""
        return self.checkout / ".venv/bin/python"

    def calls(self, calls: Sequence[Sequence[str]], folder: Path) -> list[Ran]:
        """Run commands one after another in a folder, in one process of the environment."""
        done = run([str(self.python), "-I", "-c", _DRIVER], folder, json.dumps(calls))
        assert done.code == 0, done.err
        return [Ran(*json.loads(line)) for line in done.out.splitlines()]

    def commands(self) -> list[str]:
        """Return every command and subcommand that the installed program has."""
        done = run([str(self.python), "-I", "-c", _TREE], self.checkout)
        assert done.code == 0, done.err
        names: list[str] = json.loads(done.out)
        return names


def first_command() -> str:
    """Return the first command of README."""
    found = re.search(r"```sh\n(.*?)\n```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    assert found is not None
    return found[1]


def installed(folder: Path) -> Install:
    """Return what is in a folder, made there by the first of several processes that ask."""
    done = Install(folder / "checkout", Ran(0, "", ""), folder / "dist")
    record = folder / "told.json"
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not record.exists():
            record.write_text(json.dumps(_make(done)), encoding="utf-8")
        code, out, err = json.loads(record.read_text(encoding="utf-8"))
    if code is None:
        if os.environ.get("CI") == "true":
            pytest.fail(f"no package index is within reach: {err}")
        pytest.skip("no package index is within reach, so nothing can be installed as a user does")
    return Install(done.checkout, Ran(code, out, err), done.dist)


def _make(install: Install) -> tuple[int | None, str, str]:
    """Make everything; the code is None where no index answers."""
    _copy(install.checkout)
    built = run([sys.executable, "-I", "-m", "hatchling", "build", "-d", str(install.dist)], install.checkout)
    assert built.code == 0, built.err
    _link_libraries(install)
    # pip compiles every library otherwise, for longer than it installs them; Python does it where one is used. "0" is
    # what turns `--no-compile` on: https://pip.pypa.io/en/stable/topics/configuration/#boolean-options
    told = run(["bash", "-c", first_command()], install.checkout, extra={"PIP_NO_COMPILE": "0"})
    return None if "(from versions: none)" in told.err else told.code, told.out, told.err


def _link_libraries(install: Install) -> None:
    """Put what the wheel requires where the first command makes its environment, with what that requires in turn."""
    (wheel,) = install.dist.glob("*.whl")
    with ZipFile(wheel) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        lines = re.findall(r"^Requires-Dist: (.+)$", archive.read(name).decode(), re.MULTILINE)
    asked, tops = _applying(lines, Requirement("cellc")), dict[str, Path]()
    for requirement in asked:  # which grows
        with contextlib.suppress(PackageNotFoundError):
            library = distribution(requirement.name)
            asked += [one for one in _applying(library.requires or (), requirement) if one not in asked]
            tops |= {file.parts[0]: Path(str(library.locate_file(file.parts[0]))) for file in library.files or ()}
    libraries = install.checkout / ".venv" / Path(sysconfig.get_path("purelib")).relative_to(sys.prefix)
    libraries.mkdir(parents=True)
    for top in tops.keys() - {"..", "__pycache__"}:
        (libraries / top).symlink_to(tops[top])


def _applying(lines: Iterable[str], wanted: Requirement) -> list[Requirement]:
    """Return what a library that is wanted, with its extras, requires here."""
    found = [Requirement(line) for line in lines]
    extras = ("", *wanted.extras)
    return [
        finding
        for finding in found
        if finding.marker is None or any(finding.marker.evaluate({"extra": extra}) for extra in extras)
    ]


def _copy(place: Path) -> None:
    listed = run(["git", "ls-files", "-zco", "--exclude-standard", "--", ".", *_LEFT_OUT], ROOT)
    assert listed.code == 0, listed.err
    for name in filter(None, listed.out.split("\0")):
        if (ROOT / name).is_file():
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, place / name)


def run(command: Sequence[str], folder: Path, text: str = "", extra: Mapping[str, str] | None = None) -> Ran:
    """Run a program with the environment of a person who has no virtual environment active."""
    own = {"PIP_DISABLE_PIP_VERSION_CHECK": "1", **(extra or {})}
    kept = {key: value for key, value in os.environ.items() if key not in ("VIRTUAL_ENV", "PYTHONPATH")}
    path = os.pathsep.join([str(Path(sys.base_prefix, "bin")), kept["PATH"]])
    done = subprocess.run(
        command, cwd=folder, env=kept | own | {"PATH": path}, input=text, capture_output=True, text=True, check=False
    )
    return Ran(done.returncode, done.stdout, done.stderr)
