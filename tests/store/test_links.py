"""A link on the way of a written file: below the current folder it may be a stranger's, above it is the user's own."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.contract.store.swap import link_above, link_on_the_way


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with a link in it, behind a link of the user."""
    (tmp_path / "disk" / "bench" / "real").mkdir(parents=True)
    (tmp_path / "home").symlink_to("disk", target_is_directory=True)
    (tmp_path / "disk" / "bench" / "linked").symlink_to("real", target_is_directory=True)
    monkeypatch.chdir(tmp_path / "disk" / "bench")
    return Path.cwd()


@pytest.mark.parametrize(
    ("place", "found"),
    [
        ("linked/out", "linked"),  # as it was written
        ("linked", "linked"),
        ("real/out", None),
        ("{here}/linked/out", "{here}/linked"),  # the same, absolute
        ("{here}/real/out", None),
        ("{above}/home/bench/real/out", None),  # a link of the user, outside of the current folder
        ("{above}/disk/elsewhere", None),
    ],
)
def test_link_is_found_below_the_current_folder_alone(place: str, found: str | None, here: Path) -> None:
    names = {"here": here, "above": here.parents[1]}
    expected = None if found is None else Path(found.format_map(names))
    assert link_on_the_way(Path(place.format_map(names))) == expected


@pytest.mark.parametrize(
    ("path", "found"),
    [("linked/a/b", "linked"), ("real/b", None), ("linked", None), ("b", None)],  # the file itself is not above
)
def test_link_above_a_file_is_the_first_from_the_folder(path: str, found: str | None, here: Path) -> None:
    assert link_above(path, here) == (None if found is None else here / found)
