"""The real `ros2 launch` on our launch files: it starts what the interpreter of the tests says, and stops at gates."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

from tests.cells import EVERY_CELL, built, spec_text
from tests.consumers.launch_interpreter import Process
from tests.consumers.matrix import HERE, Build
from tests.consumers.starting import MOTION_CONFIRMED, launched

SIMULATED = tuple(cell for cell in EVERY_CELL if "targets: {sim:" in spec_text(cell))
_GIVEN: tuple[tuple[str, dict[str, str]], ...] = (
    ("cell", {"target": "sim", "headless": "true"}),
    ("cell", {"target": "mock"}),
    ("move", {"target": "sim"}),
    ("move", MOTION_CONFIRMED),
)
_REFUSED = ("cell", {"target": "real"}), ("cell", {"target": "simulation"}), ("move", {"target": "real"})
_CANDIDATES = (sys.executable, "/usr/bin/python3")
"""This interpreter, and that of a sourced installation."""


@cache
def _interpreter() -> str:
    """Return the Python that has the real frontend; empty where none has."""
    asked = "import importlib.util, launch_xml, rclpy; assert importlib.util.find_spec('launch_ros')"
    for python in _CANDIDATES:
        if Path(python).exists() and not subprocess.run((python, "-c", asked), capture_output=True).returncode:
            return python
    return ""


pytestmark = pytest.mark.skipif(not _interpreter(), reason="launch_xml, launch_ros and rclpy are not installed")


def _installed(prefix: Path) -> None:
    """Install the packages of all cells, and stand-ins of the programs that their launch files name."""
    index = prefix / "share/ament_index/resource_index/packages"
    index.mkdir(parents=True)
    for cell in SIMULATED:
        for path, text in built(cell).texts.items():
            file = prefix / "share" / cell / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
            for package, program in re.findall(r'<node pkg="(\w+)" exec="(\w+)"', text):
                (index / package).touch()
                (prefix / "lib" / package).mkdir(parents=True, exist_ok=True)
                (prefix / "lib" / package / program).touch(mode=0o755)
        (index / cell).touch()
    (prefix / "bin").mkdir()
    (prefix / "bin/xacro").write_text(f"#!{sys.executable}\nimport xacro\n\nxacro.main()\n", encoding="utf-8")
    (prefix / "bin/xacro").chmod(0o755)


@pytest.fixture(scope="module")
def answers(tmp_path_factory: pytest.TempPathFactory) -> dict[tuple[str, str, str], dict[str, object]]:
    """What the real program answers, by cell, file and arguments."""
    prefix = tmp_path_factory.mktemp("installed")
    _installed(prefix)
    asked = [
        (cell, file, given)
        for cell in SIMULATED
        for file, given in (*_GIVEN, *_REFUSED)
        if f"launch/{file}.launch.xml" in built(cell).texts
    ]
    requests = [
        {"file": f"{prefix}/share/{cell}/launch/{file}.launch.xml", "given": given} for cell, file, given in asked
    ]
    known = {
        "AMENT_PREFIX_PATH": f"{prefix}:{os.environ.get('AMENT_PREFIX_PATH', '')}",
        "PATH": f"{prefix}/bin:{os.environ['PATH']}",
        "HOME": prefix.as_posix(),
    }
    run = subprocess.run(
        [_interpreter(), str(HERE / "ros_launch.py")],
        input=json.dumps(requests),
        text=True,
        capture_output=True,
        env={**os.environ, **known},
    )
    assert run.returncode == 0, run.stderr[-2000:]
    text = run.stdout.replace(f"{prefix}/", "")
    return {
        (cell, file, json.dumps(given)): answer
        for (cell, file, given), answer in zip(asked, json.loads(text), strict=True)
    }


def _told(words: list[str]) -> dict[str, object]:
    """Return what a command line says, without parameters that launching writes into files of its own."""
    _, package, program = words[0].split("/")
    cut = words.index("--ros-args")
    pairs = [pair for pair in zip(words[cut:], words[cut + 1 :], strict=False) if pair[0].startswith("-")]
    renamed = dict(value.split(":=", 1) for option, value in pairs if option == "-r")
    files = [value for option, value in pairs if option == "--params-file" and value.startswith("share/")]
    return {
        "program": (package, program),
        "arguments": tuple(re.sub(r"^share/\w+/", "", word) for word in words[1:cut]),
        "enclave": [value for option, value in pairs if option == "--enclave"],
        "name": renamed.pop("__node", None),
        "namespace": renamed.pop("__ns", ""),
        "remaps": renamed,
        "files": tuple(file.split("/", 2)[2] for file in files),
        "values": {value for option, value in pairs if option == "-p"},
    }


def _expected(process: Process, *, simulated: bool) -> dict[str, object]:
    return {
        "program": (process.package, process.executable),
        "arguments": process.arguments,
        "enclave": list(process.ros_arguments[1:2]),
        "name": process.name,
        "namespace": process.namespace,
        "remaps": dict(process.remaps),
        "files": process.files,
        "values": {"use_sim_time:=True"} if simulated else set(),
    }


@pytest.mark.parametrize("cell", SIMULATED)
@pytest.mark.parametrize(
    ("file", "given"), _GIVEN, ids=lambda value: value if isinstance(value, str) else value["target"]
)
def test_it_starts_what_the_tests_say_it_starts(
    cell: str, file: str, given: dict[str, str], answers: dict[tuple[str, str, str], dict[str, object]]
) -> None:
    whole = built(cell)
    answer = answers[cell, file, json.dumps(given)]
    assert "started" in answer, answer
    started = answer["started"]
    assert isinstance(started, list)
    simulated = given["target"] == "sim"
    expected = launched(Build(whole.graph, whole.artifacts, cell, ""), file, **given).processes
    assert [_told(words) for words in started] == [_expected(each, simulated=simulated) for each in expected]


@pytest.mark.parametrize("cell", SIMULATED)
@pytest.mark.parametrize(
    ("file", "given"), _REFUSED, ids=lambda value: value if isinstance(value, str) else value["target"]
)
def test_it_stops_at_a_gate_and_at_a_target_that_is_none(
    cell: str, file: str, given: dict[str, str], answers: dict[tuple[str, str, str], dict[str, object]]
) -> None:
    stopped = str(answers[cell, file, json.dumps(given)].get("stopped"))
    argument = "target" if given["target"] != "real" else "confirm_real" if file == "cell" else "confirm_motion"
    assert argument in stopped
    assert re.search("is not valid|not provided|was not", stopped), stopped
