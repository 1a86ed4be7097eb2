"""A generated folder of a stranger is refused in one line, or its runs end with a name, whatever its numbers are."""

from __future__ import annotations

import contextlib
import io
import json
import os
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cellc.contract.limits import DEFAULTS, in_force, limits
from cellc.contract.store.regular_file import NotRegularError, read_regular
from cellc.mock import MockCell, MockError, load
from cellc.mock.cell import run_all
from cellc.mock.command.campaign import run_campaign
from cellc.mock.command.options import CampaignOptions, RehearsalOptions
from cellc.mock.command.rehearsals import run_rehearsals
from cellc.mock.control.controllers.joint_trajectory.motion import stop_points
from cellc.mock.errors import LimitReachedError
from cellc.mock.folder import path_tolerances
from cellc.mock.result import RunFailure
from tests.cells import ROOT
from tests.mock.conftest import LoadWith

READ = ("contract.json", "rehearsals.json", "manifest.json", "config/controllers.yaml", "urdf/ur5e_pick.mock.urdf")
VALUES = ("NaN", "Infinity", "1e300", "-1", "0", "1e9", "true", '"x"', "null", "[]", "1" + "0" * 400, "1e-300")
NO_NUMBER = ("NaN", "Infinity", "1e300", "true", '"x"', "[]", "1" + "0" * 400)
"""Values that no number of a folder may have: each is refused, wherever it is."""
MARK = "@@"


def refusal(folder: Path) -> MockError:
    """Return why a folder is refused."""
    with pytest.raises(MockError) as caught:
        load(folder, edited=True)
    assert "\n" not in str(caught.value)
    return caught.value


@pytest.mark.parametrize("name", READ)
def test_device_in_place_of_a_file_is_refused(folder: Path, name: str) -> None:
    (folder / name).unlink()
    (folder / name).symlink_to("/dev/zero")  # to put a device itself there takes root
    assert (refusal(folder).file, refusal(folder).reason) == (name, "is a link that leads out of the folder")


def test_device_is_not_read_by_its_own_name() -> None:
    with pytest.raises(NotRegularError):
        read_regular(Path("/dev/zero"), 10)


@pytest.mark.parametrize("name", READ)
def test_fifo_in_place_of_a_file_is_not_waited_for(folder: Path, name: str) -> None:
    (folder / name).unlink()
    os.mkfifo(folder / name)
    assert refusal(folder).reason == "is not a regular file"


@pytest.mark.parametrize("name", READ)
def test_file_that_is_too_large_is_not_read_to_its_end(folder: Path, name: str) -> None:
    with (folder / name).open("r+b") as file:
        file.truncate(1 << 40)  # of holes: it takes no room on the disk, and no memory holds it
    error = refusal(folder)
    assert error.file == name
    assert "`--limit folder-bytes=N` raises it" in error.reason


def test_files_that_only_the_manifest_names_are_bounded_too(folder: Path) -> None:
    with (folder / "README.md").open("r+b") as file:
        file.truncate(1 << 40)
    assert refusal(folder).file == "README.md"
    (folder / "README.md").unlink()
    with in_force(replace(DEFAULTS, folder_total_bytes=10_000)):
        assert "folder-total-bytes" in refusal(folder).reason


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("[" * 10_000, "is not JSON: recursion limit exceeded"),
        ('{"a":' * 50 + "1" + "}" * 50, "is nested deeper than 32 levels"),
        ('{"cell": [' + "0," * 20_000 + "0]}", "`cell`: has 20001 entries, at most 10000 are read"),
        (json.dumps([[0] * 1000] * 500), "holds more than 400000 values"),
        ('{"format": 9223372036854775808}', "`format`: must fit 64 bits"),
        ('{"frames": {"a": {"rate_hz": NaN}}}', "`frames.a.rate_hz`: must be a finite number, got nan"),
    ],
    ids=["brackets", "depth", "entries", "values", "integer", "nan"],
)
def test_json_is_bounded_before_anything_is_made_of_it(folder: Path, text: str, reason: str) -> None:
    (folder / "contract.json").write_text(text)
    assert reason in refusal(folder).reason


@pytest.mark.parametrize(
    ("path", "value", "reason"),
    [
        (("managers", "control", "update_rate_hz"), 1e9, "must be from 0.0001 to 20000 Hz, got 1e+09"),
        (("managers", "control", "update_rate_hz"), 0, "must be from 0.0001 to 20000 Hz, got 0"),
        (("managers", "control", "update_rate_hz"), True, "input should be a valid number"),
        (("joint_limits", "arm_elbow_joint", "jerk"), 0.0, "must be from 1e-09 to 1000000000, got 0"),
        (("goals", "pick", "pose", "quaternion"), [0, 0, 0, 0], "must be a unit quaternion, got one of length 0"),
        (("goals", "pick", "pose", "xyz"), [1e300, 0, 0], "must be from -1000000000 to 1000000000, got 1e+300"),
        (("frames", "object", "buffer_s"), 1e9, "must be from 0 to 86400 s, got 1e+09"),
    ],
)
def test_number_is_refused_with_its_place_and_its_bounds(
    edit_contract: Callable[[Callable[[Any], None]], MockCell], path: tuple[str, ...], value: object, reason: str
) -> None:
    def change(contract: Any) -> None:
        for key in path[:-1]:
            contract = contract[key]
        assert path[-1] in contract
        contract[path[-1]] = value

    with pytest.raises(MockError) as caught:
        edit_contract(change)
    assert caught.value.file == "contract.json"
    assert caught.value.reason.startswith(f"`{'.'.join(path)}")
    assert reason in caught.value.reason


def test_wait_of_a_day_ends_with_a_name_and_the_option(load_with: LoadWith) -> None:
    cell = load_with(steps=[{"kind": "wait", "target": "", "duration_s": 80_000}], timeout_s=86_000)
    with in_force(replace(DEFAULTS, mock_samples=100_000)):
        result = cell.run("faulty")
    assert result.outcome is RunFailure.LIMIT_REACHED
    assert result.reason.endswith(
        "with more than 100000 joint values are simulated; `--limit mock-samples=N` raises it"
    )
    assert not result.passed


def test_camera_at_the_highest_rate_ends_with_a_name_and_the_option(
    edit_contract: Callable[[Callable[[Any], None]], MockCell],
) -> None:
    def faster(contract: Any) -> None:
        contract["devices"]["camera"]["camera"]["rate_hz"] = 20_000

    cell = edit_contract(faster)
    with in_force(replace(DEFAULTS, mock_events=20_000)):
        result = cell.run("pick_and_place")
    assert result.outcome is RunFailure.LIMIT_REACHED
    assert "`--limit mock-events=N` raises it" in result.reason


def test_buffer_of_a_day_is_not_allocated(edit_contract: Callable[[Callable[[Any], None]], MockCell]) -> None:
    def longer(contract: Any) -> None:
        contract["frames"]["object"]["buffer_s"] = 86_400

    result = edit_contract(longer).run("pick_and_place")
    assert result.outcome is RunFailure.LIMIT_REACHED
    assert "a buffer of 43200002 joint states of 6 joints" in result.reason


@pytest.mark.parametrize("rate", ["1000000000", "99999999999999999999", "1" + "0" * 5000, ".inf", "1.0e9"])
def test_update_rate_of_the_parameters_is_bounded(folder: Path, rate: str) -> None:
    file = folder / "config/controllers.yaml"
    text = file.read_text()
    assert "update_rate: 500" in text
    file.write_text(text.replace("update_rate: 500", f"update_rate: {rate}"))
    assert load(folder, edited=True).run("pick_and_place").outcome in (
        RunFailure.LIMIT_REACHED,
        RunFailure.BRINGUP_FAILURE,
    )


def _leaves(value: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for step, each in inner:
        yield from _leaves(each, (*path, step))
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        yield path


def _marked(value: Any, path: tuple[str | int, ...]) -> Any:
    if not path:
        return MARK
    items = value.items() if isinstance(value, dict) else enumerate(value)
    changed = {step: _marked(each, path[1:]) if step == path[0] else each for step, each in items}
    return changed if isinstance(value, dict) else list(changed.values())


@pytest.mark.parametrize("name", ["contract.json", "rehearsals.json"])
def test_damaged_numbers_end_in_a_refusal_or_an_outcome(folder: Path, name: str) -> None:
    # Every seventh number with one value after the other; all of them with all are a script's work.
    whole = json.loads((folder / name).read_text())
    for number, path in enumerate(list(_leaves(whole))[::7]):
        value = VALUES[number % len(VALUES)]
        (folder / name).write_text(json.dumps(_marked(whole, path)).replace(f'"{MARK}"', value))
        out, error = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
            code = run_rehearsals(RehearsalOptions(str(folder), rehearsals=("canceled",)))
        assert code in ((2,) if value in NO_NUMBER else (0, 1, 2)), (path, value)
        assert (code == 2) == (len(error.getvalue().splitlines()) == 1), (path, value, error.getvalue())


@pytest.mark.parametrize(
    ("kind", "count", "most"), [("fixed", 1001, "at most 1000 are read"), ("revolute", 201, "at most 200 are read")]
)
def test_chain_of_links_is_bounded(folder: Path, kind: str, count: int, most: str) -> None:
    file = folder / "urdf/ur5e_pick.mock.urdf"
    chain = "".join(
        f'<link name="l{i}"/><joint name="j{i}" type="{kind}"><parent link="l{i - 1}"/><child link="l{i}"/></joint>'
        for i in range(count)
    )
    file.write_text(file.read_text().replace("</robot>", f'<link name="l-1"/>{chain}</robot>'))
    error = refusal(folder)
    assert error.file == "urdf/ur5e_pick.mock.urdf"
    assert most in error.reason


@pytest.mark.parametrize("value", ["1e300", "1e21", "nan", "inf", "-1e7", "1" + "0" * 400])
def test_length_of_a_description_is_bounded(folder: Path, value: str) -> None:
    file = folder / "urdf/ur5e_pick.mock.urdf"
    file.write_text(file.read_text().replace('<origin xyz="', f'<origin xyz="{value} 0 0" rpy="', 1))
    assert refusal(folder).file == "urdf/ur5e_pick.mock.urdf"


@pytest.mark.parametrize("value", ["nan", "inf", "-inf", "1e300", "1e400", "0x1p3", "1_0", "x"])
def test_initial_value_that_hardware_cannot_have_fails_the_bring_up(folder: Path, value: str) -> None:
    file = folder / "urdf/ur5e_pick.mock.urdf"
    before = '<param name="initial_value">-1.5707963267948966</param>'
    assert before in file.read_text()
    file.write_text(file.read_text().replace(before, f'<param name="initial_value">{value}</param>', 1))
    assert load(folder, edited=True).run("pick_and_place").outcome is RunFailure.BRINGUP_FAILURE


@pytest.mark.parametrize("pairs", [10**9, 10**400])
def test_number_of_runs_asked_for_is_bounded(
    built_folder: Path, pairs: int, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_campaign(CampaignOptions(str(built_folder), pairs=pairs)) == 2
    assert "at most 10000; `--limit campaign-runs=N` raises it" in capsys.readouterr().err


def test_stop_that_takes_for_ever_is_refused_before_it_is_computed() -> None:
    slow = np.array([1e-9])
    with pytest.raises(LimitReachedError, match="a stop takes 5e\\+11 update cycles, at most 20000 are simulated"):
        stop_points(np.zeros(1), np.ones(1), slow, 2_000_000)


def test_lack_of_memory_is_told_in_one_line(
    built_folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def out_of_memory(_: Path, **_options: object) -> MockCell:
        raise MemoryError

    monkeypatch.setattr("cellc.mock.command.rehearsals.load", out_of_memory)
    assert run_rehearsals(RehearsalOptions(str(built_folder))) == 2
    assert capsys.readouterr().err.startswith("error: the folder asks for more memory than there is")


def test_rehearsals_of_one_folder_are_bounded_together(monkeypatch: pytest.MonkeyPatch) -> None:
    cell = load(ROOT / "generated/minimal")
    bounds = replace(limits(), rehearsal_seconds=0)
    with in_force(bounds), pytest.raises(MockError, match=r"at most 0 s of processor time together.*rehearsal-seconds"):
        run_all(cell)


def test_tolerances_of_a_hostile_parameter_file_are_none() -> None:
    merged = "".join(f"m{n}: &m{n} {{<<: [{', '.join([f'*m{n - 1}'] * 9)}]}}\n" for n in range(1, 12))
    for text in (f"m0: &m0 {{a: 1}}\n{merged}", "x: " + "[" * 200_000):
        assert path_tolerances({"control": text}) == {}
