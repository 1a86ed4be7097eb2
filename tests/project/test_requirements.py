"""What the action installs is pinned with hashes, satisfies pyproject.toml, and is complete."""

from __future__ import annotations

import re
import sys
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, requires

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tests.cells import ROOT

TEXT = (ROOT / ".ci/requirements.txt").read_text(encoding="utf-8")
LOCKED = {element: Requirement(element) for element in re.findall(r"^([^\s#-].*?) *\\$", TEXT, re.MULTILINE)}
PROJECT = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
WANTED = [
    Requirement(element)
    for section in (r"^requires = \[(.*?)\]$", r"^dependencies = \[(.*?)^\]$")
    for element in re.findall(r'"([^"]+)"', re.findall(section, PROJECT, re.MULTILINE | re.DOTALL)[0])
]
PYTHONS = ("3.10", "3.11", "3.12", "3.13")


def _environment(python: str) -> dict[str, str]:
    told = {"python_version": python, "python_full_version": f"{python}.0", "sys_platform": "linux"}
    return {**told, "platform_machine": "x86_64", "platform_system": "Linux", "os_name": "posix", "extra": ""}


def _applies(one: Requirement, environment: dict[str, str]) -> bool:
    return one.marker is None or one.marker.evaluate(environment)


def _versions(environment: dict[str, str]) -> dict[str, str]:
    """Return what is installed there, each package once."""
    found = [lock for lock in LOCKED.values() if _applies(lock, environment)]
    versions = {canonicalize_name(finding.name): str(finding.specifier).removeprefix("==") for finding in found}
    assert len(versions) == len(found)
    return {str(name): version for name, version in versions.items()}


@pytest.mark.parametrize("python", PYTHONS)
def test_what_the_action_installs_satisfies_pyproject(python: str) -> None:
    environment = _environment(python)
    versions = _versions(environment)
    missing = [
        name for name in WANTED if _applies(name, environment) and versions.get(name.name, "") not in name.specifier
    ]
    assert len(WANTED) > 10
    assert missing == []


def test_what_it_installs_needs_nothing_else() -> None:
    environment = _environment(f"{sys.version_info.major}.{sys.version_info.minor}")
    versions, missing = _versions(environment), []
    for name in versions:
        with suppress(PackageNotFoundError):  # a tool that builds, which an editable installation need not have
            needed = [Requirement(requirement) for requirement in requires(name) or ()]
            missing += [
                one for one in needed if _applies(one, environment) and canonicalize_name(one.name) not in versions
            ]
    assert missing == []


def test_each_pin_has_hashes_and_nothing_else_is_told_to_pip() -> None:
    pins = re.split(r"\n(?=\S)", TEXT.strip())
    assert len(pins) == len(LOCKED) > 40
    for pin in pins:
        first, *hashes = re.split(r" *\\\n *", pin)
        assert re.fullmatch(r"[\w.-]+==[\w.]+( ; [^\\@/]+)?", first), first
        assert hashes
        assert all(re.fullmatch(r"--hash=sha256:[0-9a-f]{64}", digest) for digest in hashes), first
