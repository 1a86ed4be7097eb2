"""What libraries print of a file that they cannot read: nothing of it reaches the terminal, and what helps is told."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from cellc.contract.printing import Stream, overheard, show
from tests.cells import ROOT
from tests.cli.hostile_cell import Files, make, mesh, new_cell, xacro
from tests.cli.run import run
from tests.printing.payloads import harm

FORGED = "\n::error::forged\x1b[2J\n"
_URDF = (ROOT / "tests/corpus/valid/parts/stage/stage.urdf").read_text(encoding="utf-8")
_SPEAKS = "<xacro:property name='a' value='1'/>"
INPUTS: dict[str, Files] = {
    "xacro warns": xacro(f"{_SPEAKS}<link name='base' forged='1'/>${{xacro.warning('::error::forged')}}"),
    "xacro errs": xacro(f"{_SPEAKS}<link name='base'/>${{xacro.error('::error::forged')}}"),
    "xacro says": xacro(f"{_SPEAKS}<link name='base'/>${{xacro.message('::error::forged')}}"),
    "xacro tells where": xacro(f"{_SPEAKS}<link name='base'/>${{xacro.print_location()}}"),
    "xacro fails": xacro("<xacro:macro name='m' params='a'><link/></xacro:macro><xacro:m b='::error::forged'/>"),
    "xacro is cut": xacro("<link name='base'>::error::forged"),
    "version": {"stage/stage.urdf": _URDF.replace("<robot ", '<robot version="::error::forged" ')},
    "two materials": {"stage/stage.urdf": _URDF.replace("</robot>", 2 * '<material name="::error::"/>' + "</robot>")},
    "no dynamics": {"stage/stage.urdf": _URDF.replace("</joint>", "<dynamics/></joint>", 1)},
    "no stl": mesh("a.stl", f"solid{FORGED}facet"),
    "no obj": mesh("a.obj", f"v{FORGED}f 1 2 99999"),
    "no dae": mesh("a.dae", f"<COLLADA>{FORGED}"),
    "no ply": mesh("a.ply", f"ply{FORGED}"),
    "no glb": mesh("a.glb", f"glTF{FORGED}"),
}
COMMANDS = (
    "check cell.yaml",
    "check cell.yaml --format json",
    "check cell.yaml --format sarif",
    "check stage/device.yaml --format json",
    "build cell.yaml -o out --format json",
    "show cell.yaml devices",
    "audit cell.yaml",
    "view cell.yaml -o page.html",
    "diagnose controller will not start cell.yaml",
    "import stage -o made --force",
)
GENERATED = {
    "version": ("<robot ", '<robot version="::error::forged" ', "version attribute should be in the form 'x.y'"),
    "dynamics": ("</joint>", "<dynamics/></joint>", "element specified with no damping and no friction"),
    "calibration": ("</joint>", '<calibration rising="::error::"/></joint>', "rising value (::error::) is not a valid"),
    "materials": ("</robot>", 2 * '<material name="::error::"/>' + "</robot>", "material '::error::' is not unique"),
}
OF_A_FOLDER = (
    "mock {} --edited",
    "mock {} --edited --json",
    "campaign {} --edited --jobs 1 --json",
    "sweep {} --edited --runs 2 --jobs 1 --json",
    "gates {} --edited --jobs 1",
    "view {} -o page.html",
)


def _said(command: str, capfd: pytest.CaptureFixture[str]) -> str:
    """Run a command; return what it printed, and nothing was printed past it."""
    capfd.readouterr()
    ran = run(*command.split())
    assert tuple(capfd.readouterr()) == ("", "")
    assert harm(ran.out) == harm(ran.err) == []
    foreign = [line for line in ran.err.splitlines() if not re.match(r"(error|note): |[\w./-]+: ", line)]
    assert foreign == []
    assert "Traceback" not in ran.err
    if re.search("json|sarif", command) and ran.code != 2:
        json.loads(ran.out)
    return ran.out + ran.err


@pytest.mark.parametrize("spoilt", INPUTS)
def test_nothing_that_a_library_says_of_a_device_is_printed(
    spoilt: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    make(new_cell(tmp_path / "cell"), INPUTS[spoilt])
    monkeypatch.chdir(tmp_path / "cell")
    for command in COMMANDS:
        _said(command, capfd)


@pytest.fixture(scope="module", name="built")
def built_fixture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = new_cell(tmp_path_factory.mktemp("libraries") / "cell")
    assert run("build", (folder / "cell.yaml").as_posix(), "-o", (folder / "out").as_posix()).code == 0
    (built,) = (folder / "out").iterdir()
    return built


@pytest.mark.parametrize("spoilt", GENERATED)
def test_what_the_reader_of_a_generated_description_says_is_the_reason_alone(
    spoilt: str, built: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    folder = Path(shutil.copytree(built, tmp_path / "made"))
    monkeypatch.chdir(tmp_path)
    (urdf,) = folder.glob("urdf/*.mock.urdf")
    place, written, reason = GENERATED[spoilt]
    urdf.write_text(urdf.read_text().replace(place, written, 1))
    for command in OF_A_FOLDER:
        assert reason in _said(command.format("made"), capfd), command


def _message(content: bytes) -> bytes:
    return b"Content-Length: %d\r\n\r\n%b" % (len(content), content)


_OPENED = b'{"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": {"capabilities": {}, "processId": null}}'


_UNREADABLE = (
    b'{"jsonrpc": "2.0\x1b[2J',
    b'{"jsonrpc": "2.0", "id": 2, "method": "a\\n::error::forged\\u001b[2J"}',
    b'{"jsonrpc": "2.0", "method": "textDocument/didOpen", "params": {"a": "\\n::error::forged\\u001b[2J"}}',
    b'{"jsonrpc": "2.0", "id": "\\n::error::forged\\u001b[2J", "result": 1}',
)


def test_what_the_language_server_cannot_read_is_one_line_of_its_log_each() -> None:
    end = (b'{"jsonrpc": "2.0", "id": 5, "method": "shutdown"}', b'{"jsonrpc": "2.0", "method": "exit"}')
    said = b"".join(_message(one) for one in (_OPENED, *_UNREADABLE, *end))
    ran = subprocess.run([sys.executable, "-m", "cellc", "lsp"], input=said, capture_output=True, cwd=ROOT, check=True)
    lines = ran.stderr.decode().splitlines()
    assert harm(ran.stderr.decode()) == []
    assert [line for line in lines if line.startswith((" ", "Traceback"))] == []
    assert len(lines) >= len(_UNREADABLE)


@pytest.mark.parametrize("module", ["cellc", "cellc.mock"])
def test_a_warning_of_python_is_not_printed(module: str) -> None:
    # A library warns on its way: here it is the interpreter's own `warnings`, called where a command begins.
    program = (
        "import runpy, sys, warnings\n"
        "import cellc.contract.printing as door\n"
        "door._prepare_streams = lambda: warnings.warn('::error::forged', RuntimeWarning)\n"
        f"sys.argv = ['cellc', '--help']\nrunpy.run_module('{module}', run_name='__main__')\n"
    )
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONWARNINGS"}
    ran = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, env=environment, cwd=ROOT, check=True
    )
    assert ran.stderr == ""


def test_what_is_kept_of_others_holds_none_of_our_lines(capfd: pytest.CaptureFixture[str]) -> None:
    begun, printed = threading.Event(), threading.Event()

    def print_ours() -> None:
        begun.set()
        show("a line of ours", to=Stream.ERR)
        printed.set()

    with overheard() as said:
        ours = threading.Thread(target=print_ours)
        ours.start()
        assert begun.wait(60)
        os.write(1, b"theirs on the output\n")
        os.write(2, b"theirs \xff on the error\n")
        assert not printed.is_set()
    ours.join()
    assert said == ["theirs on the output", "theirs \\xff on the error"]
    assert tuple(capfd.readouterr()) == ("", "a line of ours\n")
