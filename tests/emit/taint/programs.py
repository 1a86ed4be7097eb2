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
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import yaml

Commands = list[list[str]]
_STUB = '#!/bin/sh\nprintf \'%s\\0\' "${0##*/}" "$@" \'\n\' >> "$LOG"\n'
_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.+-]*")
_REMOTE = re.compile(r"(https://|ssh://|git@[\w.-]+:)[^\s:]\S*")
_PREFIX = "-DCMAKE_INSTALL_PREFIX="
# Options that a program gives by itself.
_OWN = {"--", "-F", "-H", "--packages-select", "-b"}
_NUMBER = re.compile(r"[0-9]+\.[0-9]+\.[0-9]+")
_ADDRESS = re.compile(r"[-\w%+]+(\.[-\w%+]+)*@[-a-zA-Z0-9%]+(\.[-a-zA-Z0-9%]+)*\.[a-zA-Z]{2,}", re.ASCII)
# What one branch of `version` is by its first letters, without a question to the server.
_BRANCH, _TAG = "heads/", "tags/"


def vcs(text: str) -> Commands:
    """Return what `vcs import src` of vcstool 0.3.0 runs where the server has no such tag or branch, but a commit.

    https://github.com/dirk-thomas/vcstool/blob/0.3.0/vcstool/commands/import_.py: lines 95-118 read `type`, `url` and
    `version` of each folder, lines 152-177 join the folder and choose the client of the type, lines 212-247 ask for
    the key of a host of `git@`. In vcstool/clients/git.py, lines 500-545 ask the server for a version, and lines
    380-458 clone and check out. A repository without type or URL is left out there, and another type has another
    client: both are reported here.
    """
    repositories = yaml.safe_load(text)["repositories"]
    urls = (str(stated.get("url")) for stated in repositories.values())
    hosts = {url.removeprefix("git@").partition(":")[0] for url in urls if url.startswith("git@") and ":" in url}
    imported = (command for name, stated in repositories.items() for command in _imported(name, stated))
    return [*(["ssh-keygen", "-F", host] for host in sorted(hosts)), *imported]


def _imported(name: str, stated: Mapping[str, object]) -> Iterator[list[str]]:
    url, version = str(stated.get("url")), str(stated["version"]) if "version" in stated else ""
    yield ["mkdir", os.path.join("src", name)]
    if stated.get("type") != "git":
        yield ["vcs", f"no client of git: {stated.get('type')}"]
    if version and not version.startswith((_BRANCH, _TAG)):
        yield ["git", "ls-remote", url, version]
    branch = version.removeprefix(_BRANCH) if version.startswith(_BRANCH) else ""
    yield ["git", "clone", url, ".", *(["-b", branch] if branch else [])]
    if version and not branch:
        yield ["git", "checkout", version, "--"]


@dataclass(frozen=True, slots=True)
class Manifest:
    """What `package.xml` says to colcon and rosdep; with a refusal, both go on without the package."""

    name: str
    keys: tuple[str, ...]
    refusal: str = ""


def manifest(text: str) -> Manifest:
    """Return what catkin_pkg 1.1.1 reads of a manifest of format 3 whose elements are known, without conditions.

    https://github.com/ros-infrastructure/catkin_pkg/blob/1.1.1/src/catkin_pkg/package.py: lines 597-790 take the
    children of the root alone, lines 811-818 their texts without space at the ends, and lines 228-325 refuse what
    is no name, number, address or description, and a package that depends on itself.
    """
    root = ElementTree.fromstring(text)
    keys = [
        key
        for kind in ("build", "buildtool", "build_export", "buildtool_export", "exec", "test")
        for tag in (f"{kind}_depend", *(["depend"] if kind in ("build", "build_export", "exec") else []))
        for key in _texts(root, tag)
    ]
    (name,), (version,), (description,) = (_texts(root, tag) for tag in ("name", "version", "description"))
    refusals = {
        "name": not re.fullmatch("[a-zA-Z0-9][a-zA-Z0-9_-]*", name),
        "version": not _NUMBER.fullmatch(version),
        "description": not description,
        "maintainer": not all(
            _ADDRESS.fullmatch(maintainer.get("email", "")) for maintainer in root.findall("maintainer")
        ),
        "license": not all(_texts(root, "license")),
        "depend": name in keys,
    }
    return Manifest(name, tuple(dict.fromkeys(keys)), " ".join(tag for tag, refused in refusals.items() if refused))


def _texts(root: ElementTree.Element, tag: str) -> list[str]:
    return [(node.text or "").strip(" \n\r\t") for node in root.findall(tag)]


def rosdep(text: str) -> Commands:
    """Return what `rosdep install` of rosdep 0.27.0 runs, as if each key were the name of a package of the system.

    https://github.com/ros-infrastructure/rosdep/blob/0.27.0/src/rosdep2/rospkg_loader.py: lines 142-146 take all
    kinds of dependencies but `doc_depend`, without their versions; platforms/debian.py, lines 304-314, installs one
    after another, with what installers.py, lines 326-335, puts before. A key that no list has is an error there.
    """
    return [["sudo", "-H", "apt-get", "install", key] for key in manifest(text).keys]


def colcon(text: str) -> Commands:
    """Return what `colcon build` runs for a package by its name, which is a folder too.

    https://github.com/colcon/colcon-ros/blob/0.5.0/colcon_ros/package_identification/ros.py: lines 57-68 and 172-201
    take the name of the manifest, or pass over the package; colcon-core 0.21.3, colcon_core/verb/build.py, lines
    50-57, name its folders after it; colcon-cmake 0.2.30, colcon_cmake/task/cmake/build.py, lines 144-173, runs CMake.
    """
    read = manifest(text)
    if read.refusal:
        return [["colcon", f"no package: {read.refusal}"]]
    return [
        ["colcon", "build", "--packages-select", read.name],
        ["mkdir", f"build/{read.name}"],
        ["cmake", f"generated/{read.name}", f"{_PREFIX}install/{read.name}"],
    ]


def cmake(text: str) -> Commands:
    """Return every argument of a command of CMake; a variable that is ours is filled in."""
    told = "\n".join(line for line in text.splitlines() if not line.startswith("#"))
    told = told.replace("${PROJECT_NAME}", "PROJECT_NAME")
    return [
        ["cmake", *re.findall(r'"[^"]*"|[^\s"]+', element)] for element in re.findall(r"^\w+\(([^)]*)\)$", told, re.M)
    ]


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
    parts = word.removeprefix(_PREFIX).split("/")
    return all(_NAME.fullmatch(part) and part not in (".", "..") for part in parts) or word == "."


def _told(commands: Commands) -> Commands:
    """Run commands with stubs, and return the words that each of them was given."""

    def run(folder: Path, environment: dict[str, str]) -> None:
        for words in commands:
            program = os.path.join(folder, words[0])
            subprocess.run([program, *words[1:]], env=environment, cwd=folder, check=True, timeout=60)

    return recorded({words[0] for words in commands}, run)


def recorded(programs: Iterable[str], run: Callable[[Path, dict[str, str]], None]) -> Commands:
    """Return the words of each command that is run in a folder of stubs, whose environment has them on the path."""
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "log"
        for name in programs:
            stub = Path(folder) / name
            stub.write_text(_STUB, encoding="utf-8")
            stub.chmod(0o755)
        run(Path(folder), {"LOG": str(log), "PATH": folder})
        said = log.read_bytes().decode("utf-8", "backslashreplace") if log.exists() else ""
    return [line.split("\0") for line in said.removesuffix("\0\n\0").split("\0\n\0") if line]
