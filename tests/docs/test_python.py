"""The page on calling cellc from Python: its examples run, and a strict checker of types knows all of them."""

from __future__ import annotations

import subprocess
import sys
import venv
from pathlib import Path

import pytest

import cellc
from tests.cells import ROOT
from tests.docs.python_page import PAGE, rerun, snippets

_SITE = "lib/python{}.{}/site-packages".format(*sys.version_info)


def test_every_example_prints_what_stands_below_it(tmp_path: Path) -> None:
    # Written by `python -m tests.docs.python_page`.
    page = PAGE.read_text(encoding="utf-8")
    assert rerun(page, tmp_path) == page


def test_page_names_all_that_is_exported() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert [name for name in cellc.__all__ if f"`{name}" not in page and name != "__version__"] == []


@pytest.fixture(scope="module")
def user(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The environment of somebody who installed cellc: its files as a wheel has them, beside its dependencies."""
    folder = tmp_path_factory.mktemp("user")
    venv.create(folder, symlinks=True)
    site = folder / _SITE
    packed = subprocess.run(
        ["git", "ls-files", "-co", "--exclude-standard", "cellc"], cwd=ROOT, capture_output=True, text=True, check=True
    )
    for name in packed.stdout.split("\n")[:-1]:
        (site / name).parent.mkdir(parents=True, exist_ok=True)
        (site / name).write_bytes((ROOT / name).read_bytes())
    (site / "dependencies.pth").write_text(f"{Path(pytest.__file__).parents[1]}\n")
    return folder


_HEAVY = "".join(f"[mypy-{name}.*]\nfollow_imports = skip\n" for name in ("networkx", "numpy", "pydantic", "click"))
"""Packages whose types no example meets: reading them takes most of a minute."""
_CACHE = ROOT / ".mypy_cache/user"


def test_a_strict_checker_of_types_knows_the_page_and_no_other_names(user: Path) -> None:
    examples = "\n".join(snippets(PAGE.read_text(encoding="utf-8")))
    wrong = "from cellc import nothing\ncellc.check('x').nothing\nfor one in cellc.check('x'):\n    one.nothing\n"
    (user / "mine.py").write_text(examples + wrong)
    (user / "mypy.ini").write_text(f"[mypy]\nstrict = True\ncache_dir = {_CACHE}\n{_HEAVY}")
    command = [sys.executable, "-m", "mypy", "--no-error-summary", "--python-executable", str(user / "bin/python")]
    ran = subprocess.run([*command, "mine.py"], cwd=user, capture_output=True, text=True, check=False)
    found = [int(line.split(":")[1]) - examples.count("\n") for line in ran.stdout.splitlines()]
    assert found == [1, 2, 4], ran.stdout + ran.stderr
