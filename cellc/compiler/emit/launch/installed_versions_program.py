#!/usr/bin/env python3
"""Compares the versions on this computer with the version tuple of the package.

    installed_versions --manifest manifest.json PART...      PART is a name of its version_tuple, as arm.driver

Each difference is printed with both versions, and ends this with 1. To go on in spite of differences, set
CELL_ACCEPT_VERSIONS=I_HAVE_READ_THE_DIFFERENCES. They are then written into $E/versions.txt, the record of the attempt,
and this ends with 0. A version that this computer cannot prove is printed and stops nothing.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import re
import sys
import time
from collections.abc import Sequence
from pathlib import Path

ACCEPTED = "I_HAVE_READ_THE_DIFFERENCES"
OF_SYSTEM = ("os", "kernel", "ros")
PACKAGES = {"ros2_control": "controller_manager", "moveit": "moveit_ros_move_group"}
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


def compared(part: str, pinned: str) -> tuple[str, bool]:
    """Return the message about one part, empty where it is as pinned, and whether it is a difference."""
    version = pinned.split()[-1]
    package = PACKAGES.get(part) or pinned.split()[0]
    chosen = os.environ.get("RMW_IMPLEMENTATION", NOTHING)
    if COMMIT.fullmatch(version) and share_of(package) is not None:
        installed = commit_of(package)
        if not installed:
            return (
                f"{part} must be {pinned}: cannot be checked, no source of {package} is beside its installation",
                False,
            )
        same = installed.startswith(version)
    elif part == "rmw" and chosen != package:
        installed, same = f"{chosen} in RMW_IMPLEMENTATION", False
    else:
        installed = found_of_system(part) if part in OF_SYSTEM else version_of(package)
        same = installed in (pinned, version)
    return ("", False) if same else (f"{part} must be {pinned}, is {installed}", True)


def accepted(differing: Sequence[str]) -> str:
    """Write accepted differences into the record of the attempt; return why that was not done."""
    if os.environ.get("CELL_ACCEPT_VERSIONS") != ACCEPTED:
        return f"to go on in spite of this, set CELL_ACCEPT_VERSIONS={ACCEPTED}"
    folder = os.environ.get("E", "")
    if not folder or not Path(folder).is_dir():
        return "set E to the folder of the attempt: it records what was accepted"
    begin = f"{time.strftime('%Y-%m-%dT%H:%M:%SZ', time.gmtime())} {platform.node()} {ACCEPTED}"
    with (Path(folder) / "versions.txt").open("a", encoding="utf-8") as record:
        record.writelines(f"{begin} {text}\n" for text in differing)
    return ""


def main(arguments: Sequence[str]) -> int:
    """Compare, print and record; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--manifest", type=Path, required=True, help="manifest.json of the package")
    parser.add_argument("parts", nargs="+", metavar="PART")
    read = parser.parse_args(arguments)
    pinned = json.loads(read.manifest.read_text(encoding="utf-8"))["version_tuple"]
    said = [answer for answer in (compared(part, pinned[part]) for part in read.parts) if answer[0]]
    print("; ".join(text for text, _ in said) or "all versions are as pinned", flush=True)
    differing = [text for text, differs in said if differs]
    refused = accepted(differing) if differing else ""
    print(refused, flush=True)
    return 1 if refused else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
