#!/usr/bin/env python3
"""Compares the versions on this computer with the version tuple of the package.

    installed_versions --manifest manifest.json PART=WHERE...

PART is a name of its version_tuple, as arm.driver. WHERE is what shows it: package:NAME of ROS, debian:NAME or system.
Each difference is printed with both versions, and ends this with 1. To go on in spite of one, name its part and who
accepts it: CELL_ACCEPT_VERSIONS="arm.driver: NAME; moveit: NAME". Each is then written into $E/versions.txt, the record
of the attempt. A version that this computer cannot prove is printed and stops nothing.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import re
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

COMMIT = re.compile(r"(?=.*[a-f])[0-9a-f]{7,40}|[0-9a-f]{40}")
NOTHING = "nothing"


def found_of_system(part: str) -> str:
    """Return the release of the operating system or kernel, or the distribution that is sourced."""
    if part == "os":
        text = Path("/etc/os-release").read_text(encoding="utf-8")
        stated = dict(re.findall(r'^(ID|VERSION_ID)="?([^"\n]*)"?$', text, re.MULTILINE))
        return f"{stated.get('ID', '')} {stated.get('VERSION_ID', '')}".strip()
    return platform.release() if part == "kernel" else os.environ.get("ROS_DISTRO", NOTHING)


def share_of(package: str) -> Path | None:
    """Return the share folder of a package: that of the first prefix with it, as ament finds it."""
    for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep):
        folder = Path(prefix) / "share" / package
        if prefix and (folder / "package.xml").is_file():
            return folder
    return None


def version_of(package: str) -> str:
    folder = share_of(package)
    text = "" if folder is None else (folder / "package.xml").read_text(encoding="utf-8")
    version = re.search(r"<version[^>]*>\s*([^<\s]+)", re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL))
    return version[1] if version else NOTHING


def debian_version_of(package: str) -> str:
    """Return the version of a Debian package without its epoch and revision."""
    asked = ["dpkg-query", "-W", "-f=${Version}", package]
    try:
        answer = subprocess.run(asked, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    except OSError:
        return NOTHING
    return answer.stdout.rpartition(":")[2].partition("-")[0] or NOTHING


def commit_of(package: str) -> str:
    """Return the commit of the source tree beside the install folder; empty where there is no such tree."""
    folder = share_of(package)
    for workspace in () if folder is None else folder.parents[1:4]:
        for file in sorted((workspace / "src").glob("**/package.xml")) if (workspace / "src").is_dir() else ():
            if f"<name>{package}</name>" in file.read_text(encoding="utf-8", errors="replace"):
                trees = (parent / ".git" for parent in file.parents if (parent / ".git").is_dir())
                return next((head_of(tree) for tree in trees), "")
    return ""


def head_of(tree: Path) -> str:
    """Return the commit that a git folder has checked out."""
    head = (tree / "HEAD").read_text(encoding="utf-8").strip()
    name = head.removeprefix("ref: ")
    if name == head:
        return head
    if (tree / name).is_file():
        return (tree / name).read_text(encoding="utf-8").strip()
    packed = tree / "packed-refs"
    lines = packed.read_text(encoding="utf-8").splitlines() if packed.is_file() else []
    return next((line.split()[0] for line in lines if line.endswith(f" {name}")), "")


def is_as_pinned(part: str, pinned: str, where: str) -> tuple[str, bool | None]:
    """Return what is installed, or why it cannot be checked, and whether it is as pinned; None where it cannot be."""
    version, (kind, _, package) = pinned.split()[-1], where.partition(":")
    chosen = os.environ.get("RMW_IMPLEMENTATION", NOTHING)
    if kind == "package" and COMMIT.fullmatch(version) and share_of(package) is not None:
        installed = commit_of(package)
        if not installed:
            return f"cannot be checked, because no source of {package} is beside its installation", None
        return installed, installed.startswith(version)
    if part == "rmw" and chosen != package:
        return f"{chosen} in RMW_IMPLEMENTATION", False
    read = {"package": version_of, "debian": debian_version_of}.get(kind)
    installed = found_of_system(part) if read is None else read(package)
    return installed, installed in (pinned, version)


def compared(part: str, pinned: str, where: str) -> tuple[str, bool]:
    """Return the message about one part, empty where it is as pinned, and whether it is a difference."""
    installed, same = is_as_pinned(part, pinned, where)
    if same is None:
        return f"{part} must be {pinned}, but this {installed}", False
    return ("", False) if same else (f"{part} must be {pinned}, got {installed}", True)


def accepting() -> dict[str, str]:
    """Return who accepts which part in spite of its difference; a part without a name is accepted by none."""
    entries = (entry.partition(":") for entry in os.environ.get("CELL_ACCEPT_VERSIONS", "").split(";"))
    return {part.strip(): person.strip() for part, _, person in entries if person.strip()}


def accepted(differing: Mapping[str, str]) -> str:
    """Write accepted differences into the record of the attempt; return why that was not done."""
    people = accepting()
    if missing := [part for part in differing if part not in people]:
        wanted = "; ".join(f"{part}: NAME" for part in missing)
        return f'to go on in spite of this, a person adds to CELL_ACCEPT_VERSIONS: "{wanted}"'
    folder = os.environ.get("E", "")
    if not folder or not Path(folder).is_dir():
        return "set E to the folder of the attempt, which records what was accepted"
    begin = f"{time.strftime('%Y-%m-%dT%H:%M:%SZ', time.gmtime())} {platform.node()}"
    with (Path(folder) / "versions.txt").open("a", encoding="utf-8") as record:
        record.writelines(f"{begin} accepted by {people[part]}: {text}\n" for part, text in differing.items())
    return ""


def main(arguments: Sequence[str]) -> int:
    """Compare, print and record; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--manifest", type=Path, required=True, help="manifest.json of the package")
    parser.add_argument("parts", nargs="+", metavar="PART=WHERE")
    read = parser.parse_args(arguments)
    pinned = json.loads(read.manifest.read_text(encoding="utf-8"))["version_tuple"]
    asked = dict(argument.split("=", 1) for argument in read.parts)
    said = {part: compared(part, pinned[part], where) for part, where in asked.items()}
    print("; ".join(text for text, _ in said.values() if text) or "all versions are as pinned", flush=True)
    differing = {part: text for part, (text, differs) in said.items() if differs}
    refused = accepted(differing) if differing else ""
    print(refused, flush=True)
    return 1 if refused else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
