"""Where packages are found: in a tree of folders that a test makes, by the rules of colcon, and where a tree ends."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.robot.description.packages import (
    declared_name,
    find_package,
    folders_elsewhere,
    package_folders,
    repository_of,
)

_TREE = {
    "arms/small_arm": "small_arm",
    "arms/repository": "wrist",  # a folder of another name than its package
    "arms/small_arm/within": "within",  # inside of a package
    "arms/.hidden/hidden": "hidden",
    "arms/off/ignored": "ignored",
    "a/b/c/d/e/deepest": "deepest",  # 6 folders below the root
    "a/b/c/d/e/f/too_deep": "too_deep",
}


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """Return the root of a tree of packages, in a repository."""
    for folder, name in _TREE.items():
        (tmp_path / folder).mkdir(parents=True, exist_ok=True)
        (tmp_path / folder / "package.xml").write_text(f'<package format="3"><name> {name} </name></package>')
    (tmp_path / "arms/off/COLCON_IGNORE").touch()
    (tmp_path / "arms/plain").mkdir()  # no package
    (tmp_path / ".git").mkdir()
    return tmp_path


@pytest.mark.parametrize(
    ("name", "folder"),
    [
        ("small_arm", "arms/small_arm"),
        ("wrist", "arms/repository"),
        ("repository", "arms/repository"),  # by the name of its folder
        ("within", None),
        ("hidden", None),
        ("ignored", None),
        ("plain", None),
        ("deepest", "a/b/c/d/e/deepest"),
        ("too_deep", None),
        ("..", None),
    ],
)
def test_package_is_found_as_colcon_finds_it(name: str, folder: str | None, tree: Path) -> None:
    assert find_package(name, str(tree)) == (None if folder is None else str(tree / folder))


def test_root_that_is_a_package_may_hold_others(tree: Path) -> None:
    (tree / "package.xml").write_text("<package><name>whole</name></package>")
    assert find_package("whole", str(tree)) == str(tree)
    assert find_package("wrist", str(tree)) == str(tree / "arms/repository")


def test_folder_of_the_name_comes_before_the_manifest(tree: Path) -> None:
    (tree / "wrist").mkdir()
    places = [Path(place) for place in package_folders("wrist", str(tree)) if Path(place).is_dir()]
    assert places == [tree / "wrist", tree / "arms/repository"]


@pytest.mark.parametrize(
    ("manifest", "name"),
    [
        ("<package><name>a_b-2</name><name>other</name></package>", "a_b-2"),
        ("<package><name></name></package>", ""),
        ("<package><name>2_b</name></package>", ""),
        (None, ""),
    ],
)
def test_name_is_the_one_that_the_manifest_declares(manifest: str | None, name: str, tmp_path: Path) -> None:
    if manifest is not None:
        (tmp_path / "package.xml").write_text(manifest)
    assert declared_name(str(tmp_path / "package.xml")) == name


def test_repository_begins_where_version_control_does(tree: Path) -> None:
    inner = tree / "arms" / "small_arm" / "within"
    assert repository_of(str(inner)) == str(tree)
    assert repository_of(str(tree)) == str(tree)
    (tree / ".git").rmdir()
    assert repository_of(str(inner)) == str(inner)


def test_package_elsewhere_in_the_repository_is_named_from_the_folder(tree: Path) -> None:
    cell = tree / "cells" / "one"
    cell.mkdir(parents=True)
    names = ("wrist", "small_arm", "missing")
    assert folders_elsewhere(names, str(cell)) == ("../..",)
    assert folders_elsewhere(names, str(cell), [str(tree / "arms")]) == ("../../arms",)
    assert folders_elsewhere(names, str(tree)) == ()  # it holds them
    (tree / ".git").rmdir()
    assert folders_elsewhere(names, str(cell)) == ()
