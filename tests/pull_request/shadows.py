"""A checkout of somebody hostile: whatever a program could load or run from the folder that it stands in is a trap."""

from __future__ import annotations

import sys
from importlib.metadata import packages_distributions
from pathlib import Path

_PACKAGES = ("cellc", "pip", "hatchling", "setuptools", "venv", "sitecustomize", "usercustomize", "backend")
_PROGRAMS = (
    "git",
    "python",
    "python3",
    "pip",
    "cellc",
    "bash",
    "sh",
    "grep",
    "tr",
    "dirname",
    "basename",
    "less",
    "vi",
)
_GIT_CONFIG = """[core]
\trepositoryformatversion = 0
\tbare = {bare}
\tfsmonitor = {trap}
\tsshCommand = {trap}
\tpager = {trap}
\teditor = {trap}
\thooksPath = {hooks}
\talternateRefsCommand = {trap}
[diff]
\texternal = {trap}
[diff "trap"]
\ttextconv = {trap}
\tcommand = {trap}
[filter "trap"]
\tclean = {trap}
\tsmudge = {trap}
\tprocess = {trap}
\trequired = true
[gpg]
\tprogram = {trap}
[alias]
\tls-files = !{trap}
\tcat-file = !{trap}
\trev-parse = !{trap}
[remote "origin"]
\turl = ext::{trap}
\tpromisor = true
\tuploadpack = {trap}
[protocol]
\tallow = always
[extensions]
\tpartialClone = origin
"""
_PIP = "[global]\nno-index = false\nindex-url = file:///absent\n"


def shadow(checkout: Path, sprung: Path) -> None:
    """Fill a checkout with traps; one that is sprung adds its name to a file outside of it."""
    code = f"with open({str(sprung)!r}, 'a') as told: told.write(__file__ + '\\n')\n"
    names = {*sys.stdlib_module_names, *packages_distributions(), *_PACKAGES}
    for name in names:
        if name.isidentifier() and not (checkout / name).exists():
            (checkout / f"{name}.py").write_text(code, encoding="utf-8")
    for name in _PACKAGES:
        (checkout / name).mkdir(exist_ok=True)
        for file in ("__init__.py", "__main__.py"):
            (checkout / name / file).write_text(code, encoding="utf-8")
    for name in ("setup.py", "conftest.py", "trap.pth", ".pythonrc.py"):
        (checkout / name).write_text(code, encoding="utf-8")
    shell = f'#!/bin/sh\necho "$0 $*" >> {sprung}\n'
    for name in (*_PROGRAMS, ".bashrc", ".profile", ".bash_profile", ".envrc", "trap"):
        program = checkout / name
        if not program.exists():
            program.write_text(shell, encoding="utf-8")
            program.chmod(0o755)
    (checkout / "pip.conf").write_text(_PIP, encoding="utf-8")
    (checkout / ".gitattributes").write_text("* filter=trap diff=trap\n", encoding="utf-8")
    _git(checkout, checkout / "trap")


def _git(checkout: Path, trap: Path) -> None:
    """Configure traps in its repository, and make the checkout look like a bare one too."""
    hooks = checkout / "hooks"
    hooks.mkdir()
    for name in ("pre-commit", "post-checkout", "post-index-change", "fsmonitor-watchman", "reference-transaction"):
        (hooks / name).symlink_to(trap)
    for folder in ("objects", "refs"):
        (checkout / folder).mkdir()
    (checkout / "HEAD").write_text("ref: refs/heads/main\n", encoding="utf-8")
    for place, bare in ((checkout, "true"), (checkout / ".git", "false")):
        (place / "config").write_text(_GIT_CONFIG.format(trap=trap, hooks=hooks, bare=bare), encoding="utf-8")
