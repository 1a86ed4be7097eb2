#!/usr/bin/env python3
"""Compares what this computer has with the version tuple that the gates are passed with.

    installed_versions --manifest manifest.json PART...      PART is a name of its version_tuple, as arm.driver

Each difference is told with both figures, and ends this with 1. A person who goes on in spite of them starts with
CELL_ACCEPT_VERSIONS=I_HAVE_READ_THE_DIFFERENCES: they are then written into $E/versions.txt, the record of the attempt,
and this ends with 0. What nothing on this computer can prove is told, and stops nothing.
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
        told = dict(re.findall(r'^(ID|VERSION_ID)="?([^"\n]*)"?$', text, re.MULTILINE))
        return f"{told.get('ID', '')} {told.get('VERSION_ID', '')}".strip()
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
    found = re.search(r"<version[^>]*>\s*([^<\s]+)", re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL))
    return found[1] if found else NOTHING


def commit_of(package: str) -> str:
    """Return the commit of the source tree beside the install folder; empty where there is no such tree."""
    folder = share_of(package)
    for workspace in () if folder is None else folder.parents[1:4]:
        for file in sorted((workspace / "src").glob("**/package.xml")) if (workspace / "src").is_dir() else ():
            if f"<name>{package}</name>" in file.read_text(encoding="utf-8", errors="replace"):
                trees = (one / ".git" for one in file.parents if (one / ".git").is_dir())
                return next((head_of(tree) for tree in trees), "")
    return ""


def head_of(tree: Path) -> str:
    """Return the commit that a git folder stands at, read as git writes it."""
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
    """Return what is to be told of one part, empty where it is as pinned, and whether it is a difference."""
    version = pinned.split()[-1]
    package = PACKAGES.get(part) or pinned.split()[0]
    chosen = os.environ.get("RMW_IMPLEMENTATION", NOTHING)
    if COMMIT.fullmatch(version) and share_of(package) is not None:
        found = commit_of(package)
        if not found:
            return f"{part} must be {pinned}: not provable, no source of {package} lies beside its installation", False
        same = found.startswith(version)
    elif part == "rmw" and chosen != package:
        found, same = f"{chosen} by RMW_IMPLEMENTATION", False
    else:
        found = found_of_system(part) if part in OF_SYSTEM else version_of(package)
        same = found in (pinned, version)
    return ("", False) if same else (f"{part} must be {pinned}, is {found}", True)


def accepted(differing: Sequence[str]) -> str:
    """Write differences that a person goes on with into the record of the attempt; return why that was not done."""
    if os.environ.get("CELL_ACCEPT_VERSIONS") != ACCEPTED:
        return f"whoever goes on in spite of this starts with CELL_ACCEPT_VERSIONS={ACCEPTED}"
    folder = os.environ.get("E", "")
    if not folder or not Path(folder).is_dir():
        return "E must name the folder of the attempt, in which what is accepted is written down"
    begin = f"{time.strftime('%Y-%m-%dT%H:%M:%SZ', time.gmtime())} {platform.node()} {ACCEPTED}"
    with (Path(folder) / "versions.txt").open("a", encoding="utf-8") as record:
        record.writelines(f"{begin} {one}\n" for one in differing)
    return ""


def main(arguments: Sequence[str]) -> int:
    """Compare, tell and record; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--manifest", type=Path, required=True, help="manifest.json of the package")
    parser.add_argument("parts", nargs="+", metavar="PART")
    read = parser.parse_args(arguments)
    pinned = json.loads(read.manifest.read_text(encoding="utf-8"))["version_tuple"]
    said = [one for one in (compared(part, pinned[part]) for part in read.parts) if one[0]]
    print("; ".join(text for text, _ in said) or "what is installed is what is pinned", flush=True)
    differing = [text for text, differs in said if differs]
    refused = accepted(differing) if differing else ""
    print(refused, flush=True)
    return 1 if refused else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
