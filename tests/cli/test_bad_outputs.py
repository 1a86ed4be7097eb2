"""Places that cannot be written: a reason, no traceback, nothing half-written, no temporary file left."""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cells import CORPUS, ROOT
from tests.cli.refused import UNWRITABLE, assert_refused, everything_below
from tests.cli.run import MINIMAL, PICK, Ran, run

INIT = ("init", "bench", "ur5e", "-o")
_AS_ROOT = pytest.mark.skipif(os.geteuid() == 0, reason="root may write where nobody may")


def _with_small_disk(*arguments: str, limit_bytes: int) -> Ran:
    """Run a process that may write so many bytes to one file: the write fails in the middle, as on a full disk."""
    done = subprocess.run(
        [sys.executable, "-m", "cellc", *arguments],
        cwd=ROOT,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit_bytes, limit_bytes)),
        env=os.environ | {"CELLC_NO_CACHE": "1", "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    return Ran(done.returncode, done.stdout, done.stderr)


@pytest.mark.parametrize("compare", [(), ("--check",)], ids=["build", "build --check"])
def test_output_folder_that_is_a_file_is_refused(compare: tuple[str, ...], tmp_path: Path) -> None:
    (tmp_path / "out").write_text("mine")
    ran = run("build", MINIMAL, "-o", (tmp_path / "out").as_posix(), *compare)
    assert_refused(ran, (tmp_path / "out").as_posix())
    assert (tmp_path / "out").read_text() == "mine"
    assert everything_below(tmp_path) == ["out"]


def test_cell_folder_that_is_a_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "minimal").write_text("mine")
    assert_refused(run("build", MINIMAL, "-o", tmp_path.as_posix()), "output-blocked")
    assert (tmp_path / "minimal").read_text() == "mine"
    assert everything_below(tmp_path) == ["minimal"]


def test_cell_folder_that_is_a_link_is_refused(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "out").mkdir()
    (tmp_path / "out/minimal").symlink_to(tmp_path / "elsewhere")
    assert_refused(run("build", MINIMAL, "-o", (tmp_path / "out").as_posix()), "output-symlink")
    assert everything_below(tmp_path / "elsewhere") == []


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        (INIT, "cell.yaml"),
        ((*INIT[:-1], "--force", "-o"), "cell.yaml"),
        (("schema", "-o"), "cell.schema.json"),
        (("explain", "--all", "-o"), "README.md"),
    ],
    ids=["init", "init --force", "schema", "explain"],
)
def test_nothing_is_written_through_a_link(arguments: tuple[str, ...], name: str, tmp_path: Path) -> None:
    (tmp_path / "victim").write_text("mine")
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / name).symlink_to(tmp_path / "victim")
    (tmp_path / "linked").symlink_to(tmp_path / "out")

    def code(folder: str) -> int:
        place = tmp_path / folder
        return run(*arguments, (place / name if arguments[0] == "init" else place).as_posix()).code

    assert code("out") != 0
    assert code("linked") != 0
    (tmp_path / "out" / name).unlink()
    (tmp_path / "out" / name).symlink_to(tmp_path / "new")  # a link to nothing makes its target
    assert code("out") != 0
    assert (tmp_path / "victim").read_text() == "mine"
    assert not (tmp_path / "new").exists()


def _demo_cell(folder: Path) -> list[Path]:
    """Write a cell with an include, a device of its own and a measured file; return every file of it."""
    (folder / "parts").mkdir()
    (folder / "parts/hosts.yaml").write_text("hosts:\n  pc: {scheduling: generic}\n")
    (folder / "measured.yaml").write_text("transform: {}\n")
    shutil.copytree(CORPUS / "invalid/base/stage", folder / "stage")
    spec = "format: 1\ncell: line\ninclude: parts/hosts.yaml\nversions: {ros: jazzy}\ndevices:\n"
    (folder / "cell.yaml").write_text(f"{spec}  stage: {{model: ./stage}}\n")
    return sorted(path for path in folder.rglob("*") if path.is_file())


def test_a_page_replaces_a_page_and_no_file_of_a_cell(tmp_path: Path) -> None:
    files = _demo_cell(tmp_path)
    before = [file.read_bytes() for file in files]
    for file in files:
        ran = run("view", (tmp_path / "cell.yaml").as_posix(), "-o", file.as_posix())
        assert (ran.code, ran.err.count("is not an HTML page")) == (2, 1), file
    assert [file.read_bytes() for file in files] == before
    for text in ("", "<!doctype html>\n<p>before\n"):
        (tmp_path / "page.html").write_text(text)
        assert run("view", PICK, "-o", (tmp_path / "page.html").as_posix()).code == 0
        assert (tmp_path / "page.html").read_bytes().startswith(b"<!DOCTYPE html>\n<html")


def test_a_page_does_not_replace_a_pipe(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    assert_refused(
        run("view", PICK, "-o", (tmp_path / "pipe").as_posix()), "pipe: cannot be written: not a regular file"
    )
    assert (tmp_path / "pipe").is_fifo()


@pytest.mark.parametrize("command", ["explain", "catalog"])
def test_pages_do_not_replace_the_readme_of_a_project(command: str, tmp_path: Path) -> None:
    (tmp_path / "README.md").write_text("# My project\n")
    ran = run(command, "--all", "-o", tmp_path.as_posix())
    assert (ran.code, everything_below(tmp_path)) == (2, ["README.md"])
    assert f"`{tmp_path.as_posix()}/README.md` is not a page that cellc wrote" in ran.err
    assert (tmp_path / "README.md").read_text() == "# My project\n"
    assert [run(command, "--all", "-o", (tmp_path / "pages").as_posix()).code for _ in range(2)] == [0, 0]


def test_import_does_not_replace_the_robot_that_it_reads(tmp_path: Path) -> None:
    shutil.copy(CORPUS / "valid/parts/demo_arm/demo_arm.urdf", tmp_path / "robot.urdf")
    before = (tmp_path / "robot.urdf").read_bytes()
    ran = run("import", (tmp_path / "robot.urdf").as_posix(), "-o", tmp_path.as_posix())
    assert_refused(ran, "robot.urdf` would be replaced by the output")
    assert (ran.code, everything_below(tmp_path)) == (2, ["robot.urdf"])
    assert (tmp_path / "robot.urdf").read_bytes() == before


def test_full_disk_leaves_nothing_of_a_first_build(tmp_path: Path) -> None:
    ran = _with_small_disk("build", MINIMAL, "-o", (tmp_path / "out").as_posix(), limit_bytes=4096)
    assert_refused(ran, "cannot be written: file too large")
    assert everything_below(tmp_path) == []


def test_full_disk_leaves_the_folder_of_the_last_build(tmp_path: Path) -> None:
    assert run("build", MINIMAL, "-o", tmp_path.as_posix()).code == 0
    contract = (tmp_path / "minimal/contract.json").read_bytes()
    spec = tmp_path / "minimal.yaml"
    spec.write_text(Path(MINIMAL).read_text().replace("goal_time: 1 s", "goal_time: 2 s"))
    before = everything_below(tmp_path)
    assert_refused(
        _with_small_disk("build", spec.as_posix(), "-o", tmp_path.as_posix(), limit_bytes=4096),
        "cannot be written: file too large",
    )
    assert (tmp_path / "minimal/contract.json").read_bytes() == contract
    assert everything_below(tmp_path) == before


def test_full_disk_leaves_no_half_spec_or_schema(tmp_path: Path) -> None:
    init = _with_small_disk(*INIT, (tmp_path / "cell.yaml").as_posix(), limit_bytes=100)
    assert_refused(init, f"{tmp_path.as_posix()}/cell.yaml: file too large", UNWRITABLE)
    schema = _with_small_disk("schema", "-o", (tmp_path / "schemas").as_posix(), limit_bytes=100)
    assert_refused(schema, ".schema.json: file too large", UNWRITABLE)
    assert everything_below(tmp_path) in ([], ["schemas"])


@_AS_ROOT
def test_read_only_output_is_refused(tmp_path: Path) -> None:
    tmp_path.chmod(0o555)
    try:
        assert_refused(run("build", MINIMAL, "-o", tmp_path.as_posix()), "output-unwritable")
        assert_refused(run(*INIT, (tmp_path / "cell.yaml").as_posix()), "permission denied", UNWRITABLE)
    finally:
        tmp_path.chmod(0o755)
    assert everything_below(tmp_path) == []


def test_file_in_the_way_of_init_and_schema_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    inside = (tmp_path / "file/cell.yaml").as_posix()
    assert_refused(run(*INIT, inside), inside, UNWRITABLE)
    assert_refused(run("schema", "-o", (tmp_path / "file").as_posix()), (tmp_path / "file").as_posix())
    assert everything_below(tmp_path) == ["file"]


def test_two_cells_of_one_name_do_not_replace_each_other(tmp_path: Path) -> None:
    other = tmp_path / "other.yaml"
    other.write_text(Path(MINIMAL).read_text().replace("goal_time: 1 s", "goal_time: 2 s"))
    ran = run("build", MINIMAL, other.as_posix(), "-o", (tmp_path / "out").as_posix())
    assert_refused(ran, "error[output-shared]: two specs of this call are called `minimal`")
    assert MINIMAL in ran.out
    assert "goal_time: 1.0" in (tmp_path / "out/minimal/config/controllers.yaml").read_text()


def test_one_cell_named_twice_is_no_fault(tmp_path: Path) -> None:
    assert run("build", MINIMAL, MINIMAL, "-o", tmp_path.as_posix()).code == 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("init", "Bench", "ur5e"), "`Bench` is not a package name"),
        (("init", "bench"), "name at least one model"),
        (("init", "bench", "arm=ur5e", "arm=ur5e"), "two devices have the name `arm`"),
        (("init", "bench", "ur5e", "--ros", "foxy"), "foxy"),
        (("schema", "cel"), "there is no schema `cel`"),
        (("explain", ""), "there is no code"),
        (("show", MINIMAL, "devices..arm"), "`devices..arm` has an empty name beside a dot"),
        (
            ("show", MINIMAL, "control.update_rate"),
            "there is no `update_rate` in `control`: did you mean `update_rate_hz`?",
        ),
        (("show", MINIMAL, "device.arm"), "there is no `device` at the top of the cell: did you mean `devices`?"),
        (("view", "nowhere.yaml"), "nowhere.yaml: there is no such file or folder"),
    ],
)
def test_argument_that_means_nothing_is_a_usage_error(
    arguments: tuple[str, ...], words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    ran = run(*arguments)
    assert_refused(ran, words)
    assert ran.code == 2
    assert everything_below(tmp_path) == []


@pytest.mark.parametrize("place", ["", "/launch", "/README.md"], ids=["folder", "folder in it", "file"])
def test_nothing_is_shown_of_what_a_link_in_the_output_leads_to(place: str, tmp_path: Path) -> None:
    out, home = tmp_path / "out", tmp_path / "home"
    assert run("build", MINIMAL, "-o", out.as_posix()).code == 0
    (out / f"minimal{place}").rename(home)
    for file in (file for file in (home, *home.rglob("*")) if file.is_file()):
        file.write_text("secret of somebody\n")
    (out / f"minimal{place}").symlink_to(home)
    ran = run("build", "--check", MINIMAL, "-o", out.as_posix())
    assert (ran.code, "secret" in ran.out + ran.err, ran.out.count("output-symlink")) == (1, False, 1)


def test_a_page_that_the_cell_names_replaces_a_page_of_cellc_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    page = tmp_path / "minimal.html"
    page.write_text("<!doctype html>\n<p>mine\n")
    ran = run("view", MINIMAL)
    assert (ran.code, "is not a page of this command" in ran.err) == (2, True)
    assert page.read_text() == "<!doctype html>\n<p>mine\n"
    page.unlink()
    assert [run("view", MINIMAL).code for _ in range(2)] == [0, 0]
