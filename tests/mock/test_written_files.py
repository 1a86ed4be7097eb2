"""What `cellc mock` writes replaces files of its own alone, and nothing behind a link."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from cellc.contract.limits import limits
from cellc.contract.store.staging import staging_of
from cellc.contract.store.swap import write_whole
from cellc.mock.command.records import write_records
from cellc.mock.errors import MockError
from cellc.mock.evidence.folder import INDEX, EvidenceFolder

PRECIOUS = "precious\n"


@pytest.fixture(name="victim")
def victim_fixture(tmp_path: Path) -> Path:
    """Return a file of somebody else, in a folder of its own."""
    victim = tmp_path / "elsewhere" / "victim"
    victim.parent.mkdir()
    victim.write_text(PRECIOUS)
    return victim


def test_records_are_not_written_through_a_link(victim: Path, tmp_path: Path) -> None:
    link = tmp_path / "records.jsonl"
    link.symlink_to(victim)
    with pytest.raises(MockError, match="is a symbolic link"):
        write_records(link, ())
    assert victim.read_text() == PRECIOUS
    assert link.is_symlink()


def test_link_to_nothing_is_refused_too(tmp_path: Path) -> None:
    link = tmp_path / "records.jsonl"
    link.symlink_to(tmp_path / "new")
    with pytest.raises(MockError, match="is a symbolic link"):
        write_records(link, ())
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize("part", [".records.jsonl.part", ".records.jsonl.tmp-PID"])
def test_no_link_beside_the_records_is_written_through(part: str, victim: Path, tmp_path: Path) -> None:
    (tmp_path / part.replace("PID", str(os.getpid()))).symlink_to(victim)
    write_records(tmp_path / "records.jsonl", ())
    assert victim.read_text() == PRECIOUS
    assert not (tmp_path / "records.jsonl").is_symlink()


def test_no_link_beside_a_file_of_another_command_is_written_through(victim: Path, tmp_path: Path) -> None:
    (tmp_path / f".cell.yaml.tmp-{os.getpid()}").symlink_to(victim)
    write_whole(tmp_path / "cell.yaml", "text")
    assert victim.read_text() == PRECIOUS
    assert (tmp_path / "cell.yaml").read_text() == "text"


@pytest.mark.parametrize("content", [PRECIOUS, "[]\n", "1\n", '{"attempt_id": 1}', '{"other": 1}\n', "[" * 100_000])
def test_file_of_somebody_else_is_not_replaced(content: str, tmp_path: Path) -> None:
    file = tmp_path / "records.jsonl"
    file.write_text(content)
    with pytest.raises(MockError, match="is no file of records"):
        write_records(file, ())
    assert file.read_text() == content


@pytest.mark.parametrize("content", ["", '{"attempt_id": "1"}\n{"attempt_id": "2"}\n'])
def test_records_of_an_earlier_run_are_replaced(content: str, tmp_path: Path) -> None:
    file = tmp_path / "records.jsonl"
    file.write_text(content)
    write_records(file, ())
    assert file.read_text() == ""
    assert [path.name for path in tmp_path.iterdir()] == ["records.jsonl"]


def test_evidence_is_not_written_into_the_root() -> None:
    with pytest.raises(MockError, match="is not a folder that evidence can be written to"):
        EvidenceFolder(Path("/"), ["report.html"])


def test_evidence_is_not_staged_behind_a_link(victim: Path, tmp_path: Path) -> None:
    staging_of(tmp_path / "evidence").symlink_to(victim.parent)
    with pytest.raises(MockError, match="cannot be written"):
        EvidenceFolder(tmp_path / "evidence", ["report.html"])
    assert [path.name for path in victim.parent.iterdir()] == ["victim"]


def test_index_of_somebody_else_is_not_replaced(victim: Path, tmp_path: Path) -> None:
    folder = tmp_path / "evidence"
    folder.mkdir()
    (folder / INDEX).write_text('["mine"]')
    with pytest.raises(MockError, match="is no index of evidence"):
        EvidenceFolder(folder, ["report.html"])
    (folder / INDEX).unlink()
    (folder / INDEX).symlink_to(victim)
    with pytest.raises(MockError, match="is no index of evidence"):
        EvidenceFolder(folder, ["report.html"])


@pytest.mark.parametrize("place", ["evidence", ".evidence.tmp-99999999/new"])
def test_pipe_in_the_place_of_the_index_is_not_waited_for(place: str, tmp_path: Path) -> None:
    (tmp_path / place).mkdir(parents=True)
    os.mkfifo(tmp_path / place / INDEX)
    if place == "evidence":
        with pytest.raises(MockError, match="is no index of evidence"):
            EvidenceFolder(tmp_path / "evidence", ())
    else:
        EvidenceFolder(tmp_path / "evidence", ()).discard()


def test_index_that_is_too_large_is_not_read(tmp_path: Path) -> None:
    (tmp_path / "evidence").mkdir()
    (tmp_path / "evidence" / INDEX).write_text('{"files": {}, "more": "' + "x" * limits().folder_bytes + '"}')
    with pytest.raises(MockError, match="is no index of evidence"):
        EvidenceFolder(tmp_path / "evidence", ())
