"""Which program reads a generated file, and what that program runs for it.

A table, as `judges.py` has one of readers: for each file of which a program makes commands, the commands as that
program puts them together, run with stubs that tell their arguments. No text of a spec or device may be an option
there, a command, a place elsewhere, or a transport that runs one.
"""

from __future__ import annotations

import os
import re
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from xml.etree import ElementTree

import yaml

Commands = list[list[str]]
_STUB = '#!/bin/sh\nprintf \'%s\\0\' "${0##*/}" "$@" \'\n\' >> "$LOG"\n'
_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.+-]*")
_REMOTE = re.compile(r"(https://|ssh://|git@[\w.-]+:)[^\s:]\S*")
# Options that a program gives by itself.
_OWN = {"--", "--packages-select", "-y", "-DCMAKE_INSTALL_PREFIX"}


def vcs(text: str) -> Commands:
    """Return what `vcs import` of vcstool 0.3 runs: a clone into a folder of its name, then the version."""
    repositories = yaml.safe_load(text)["repositories"]
    return [
        command
        for name, told in repositories.items()
        for command in (
            ["mkdir", name],
            ["git", "clone", told["url"], "."],
            ["git", "checkout", str(told["version"]), "--"],
        )
    ]


def rosdep(text: str) -> Commands:
    """Return what `rosdep install` runs for keys that the system's packages are named by."""
    tags = ("exec_depend", "buildtool_depend", "depend", "build_depend")
    root = ElementTree.fromstring(text)
    return [["apt-get", "install", "-y", node.text or ""] for tag in tags for node in root.iter(tag)]


def colcon(text: str) -> Commands:
    """Return how `colcon build` tells a package by its name, which is a folder too."""
    return [
        ["colcon", "build", "--packages-select", node.text or ""] for node in ElementTree.fromstring(text).iter("name")
    ]


def cmake(text: str) -> Commands:
    """Return every argument of a command of CMake; a variable that is ours is filled in."""
    told = "\n".join(line for line in text.splitlines() if not line.startswith("#"))
    told = told.replace("${PROJECT_NAME}", "PROJECT_NAME")
    return [["cmake", *re.findall(r'"[^"]*"|[^\s"]+', one)] for one in re.findall(r"^\w+\(([^)]*)\)$", told, re.M)]


READ_BY: dict[str, tuple[Callable[[str], Commands], ...]] = {
    "sources.repos": (vcs,),
    "package.xml": (rosdep, colcon),
    "CMakeLists.txt": (cmake,),
}
"""Programs by the end of the file's path. What bash, xacro and launch run is held by the readers of `judges.py`."""


def misled(made: Mapping[str, str]) -> Iterator[str]:
    """Yield each command of a program that a text has turned into another one."""
    for path, text in made.items():
        for program in READ_BY.get(path, ()):
            for words in _told(program(text)):
                yield from (f"{path}: {program.__name__} runs {words}" for word in words[1:] if not _is_harmless(word))


def _is_harmless(word: str) -> bool:
    if word in _OWN or _REMOTE.fullmatch(word):
        return True
    return all(_NAME.fullmatch(part) and part not in (".", "..") for part in word.split("/")) or word == "."


def _told(commands: Commands) -> Commands:
    """Run commands with stubs, and return the words that each of them was given."""
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "log"
        for name in {words[0] for words in commands}:
            stub = Path(folder) / name
            stub.write_text(_STUB, encoding="utf-8")
            stub.chmod(0o755)
        for words in commands:
            program = os.path.join(folder, words[0])
            subprocess.run([program, *words[1:]], env={"LOG": str(log)}, cwd=folder, check=True, timeout=60)
        said = log.read_bytes().decode("utf-8", "backslashreplace") if log.exists() else ""
    return [line.split("\0") for line in said.removesuffix("\0\n\0").split("\0\n\0") if line]
