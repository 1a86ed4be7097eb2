"""Every output of every command, fed with names and texts of strangers: no line is obeyed, and nothing is hidden."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pytest

from cellc.mock.__main__ import main as run_the_mock
from cellc.mock.faults.registry import possible_faults
from tests.cli.run import MINIMAL, Ran, run
from tests.printing.payloads import PAYLOADS, harm

# All at once: names of files hold up to 255 bytes, and neither a slash nor a zero character.
_EVERYTHING = "\n".join(text.replace("\n", "") for text in PAYLOADS.values()).replace("/", "|")
_SHORT = "::error::f\n::error::f\r::debug::f\x1b[2J\u009b1m\u202e\u200b\x7f##[error]f"
_NAME = f"{_SHORT}\udcff"  # the last one is a byte that is no UTF-8
_OWN = frozenset({"error", "warning", "notice"})


def _clean(ran: Ran, commands: frozenset[str] = frozenset()) -> Ran:
    assert harm(ran.out, commands) == []
    assert harm(ran.err) == []
    assert "Traceback" not in ran.err
    return ran


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    output = tmp_path_factory.mktemp("built")
    assert run("build", MINIMAL, "-o", output.as_posix()).code == 0
    return output / "minimal"


def test_name_of_a_spec_and_of_its_folder(here: Path) -> None:
    (here / _NAME).mkdir()
    file = here / _NAME / f"{_NAME}.yaml"
    text = Path(MINIMAL).read_text()
    # The texts that a spec may hold are shown too: an unknown key, and the line that it stands on.
    file.write_text(text + '"::error::a\\n::error::b ##[error]c": 1\n')
    given = f"{_NAME}/{_NAME}.yaml"
    for output_format in ("text", "json", "sarif", "github"):
        for given_file in (given, f"{_NAME}/none.yaml"):
            ran = _clean(
                run("check", given_file, "--format", output_format), _OWN if output_format == "github" else frozenset()
            )
            assert ran.code == 1
    file.write_text(text)
    for command in (("show", given, "devices"), ("audit", given), ("diagnose", "controller will not start", given)):
        _clean(run(*command))
    for option in ((), ("--check",), ("--force",)):
        _clean(run("build", given, "-o", _NAME, *option))
    (here / _NAME / "minimal" / "README.md").write_text(f"{_EVERYTHING}\n")
    (here / _NAME / "minimal" / "manifest.json").unlink()
    for option in (("--check",), ("--force",)):
        assert _clean(run("build", given, "-o", _NAME, *option)).code == 1 or option == ("--force",)


def test_names_of_files_in_the_folder_that_is_built_again(built: Path, here: Path) -> None:
    folder = Path(shutil.copytree(built, here / "minimal"))
    manifest = json.loads((folder / "manifest.json").read_text())
    (folder / _NAME).write_text("foreign\n")
    (folder / f"{_NAME}.old").write_text("of an earlier build\n")
    manifest["files"] |= {f"{_NAME}.old": "sha256:0", f"{_NAME}.gone": "sha256:0"}
    (folder / "manifest.json").write_text(json.dumps(manifest))
    (folder / "README.md").write_text(f"{_EVERYTHING}\n")
    for option in (("--check",), (), ("--force",)):
        _clean(run("build", MINIMAL, "-o", here.as_posix(), *option))
    assert (folder / _NAME).read_text() == "foreign\n"


def test_arguments_that_are_wrong(built: Path, here: Path) -> None:
    for arguments in (
        (_NAME,),
        (f"--{_NAME}",),
        ("check", MINIMAL, "--format", _NAME),
        ("check", MINIMAL, "--select", _NAME),
        ("check", MINIMAL, "--limit", _NAME),
        ("check", MINIMAL, f"--{_NAME}"),
        ("explain", _NAME),
        ("explain", "--all", "-o", _NAME),
        ("schema", _NAME),
        ("schema", "-o", _NAME),
        ("completion", _NAME),
        ("diagnose", _NAME),
        ("diagnose", f"controller {_NAME} will not start", MINIMAL),
        ("show", MINIMAL, _NAME),
        ("show", MINIMAL, f"devices.{_NAME}"),
        ("audit", _NAME),
        ("init", _NAME),
        ("init", "bench", _NAME),
        ("init", "bench", f"{_NAME}=stage"),
        ("mock", _NAME),
        ("mock", built.as_posix(), "--rehearsal", _NAME),
        ("replay", built.as_posix(), _NAME),
        ("mock", built.as_posix(), "--seed", _NAME),
        ("mock", built.as_posix(), "--records", f"{_NAME}/none"),
    ):
        _clean(run(*arguments))


def test_arguments_of_the_mock_alone_that_are_wrong(built: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for arguments in ((), (_NAME,), (built.as_posix(), "--seed", _NAME), (built.as_posix(), f"--{_NAME}")):
        with patch("sys.argv", ["cellc.mock", *arguments]), suppress(SystemExit):
            assert run_the_mock() == 2
        told = capsys.readouterr()
        _clean(Ran(2, told.out, told.err))
        assert told.err


def test_schema_that_a_new_spec_names_is_one_line(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (here / "a\nb: 1").mkdir()
    monkeypatch.chdir(here / "a\nb: 1")
    _clean(run("init", "bench", "ur5e", "-o", (here / "cell.yaml").as_posix()))
    assert (here / "cell.yaml").read_text().splitlines()[:2] == [
        "# yaml-language-server: $schema=a%0Ab%3A%201/schemas/cell.schema.json",
        "format: 1",
    ]


def test_files_that_init_writes(here: Path) -> None:
    arguments = ("init", "bench", "ur5e", "-o", f"{_NAME}/{_NAME}.yaml")
    for given in (arguments, arguments, (*arguments, "--force")):
        _clean(run(*given))
    written = (here / _NAME / f"{_NAME}.yaml").read_text()
    assert harm(written) == []


def _named(contract: Any, rehearsals: Any, manifest: Any) -> None:
    contract["configuration_id"] = contract["summary"] = _EVERYTHING
    contract["version_tuple"][_EVERYTHING] = _EVERYTHING
    manifest["configuration_id"] = f"other {_EVERYTHING}"
    rehearsals["rehearsals"][0]["name"] = "::error::f ##[error]f"


def _celled(contract: Any, rehearsals: Any, manifest: Any) -> None:
    contract["cell"] = _EVERYTHING  # becomes a path, and so must be a name


def _listed(contract: Any, rehearsals: Any, manifest: Any) -> None:
    manifest["files"] |= {_SHORT: "sha256:0"}


def _target(contract: Any, rehearsals: Any, manifest: Any) -> None:
    rehearsals["rehearsals"][0]["steps"][0]["target"] = _EVERYTHING


def _fault(contract: Any, rehearsals: Any, manifest: Any) -> None:
    rehearsals["rehearsals"][0]["faults"] = [{"kind": "protective_stop", "target": _EVERYTHING, "at_s": 0.1}]


def _key(contract: Any, rehearsals: Any, manifest: Any) -> None:
    contract[_EVERYTHING] = 1


def _file(contract: Any, rehearsals: Any, manifest: Any) -> None:
    contract["files"]["rehearsals"] = _SHORT


def _outcome(contract: Any, rehearsals: Any, manifest: Any) -> None:
    rehearsals["rehearsals"][0]["expect"] = _EVERYTHING


_RUNS: dict[str, tuple[str, ...]] = {
    "text": (),
    "json": ("--json",),
    "records": ("--records", "records.jsonl"),
    "evidence": ("--evidence", "evidence"),
}
_CAMPAIGN: dict[str, tuple[str, ...]] = {
    "matrix": ("campaign", "--jobs", "1"),
    "matrix as json": ("campaign", "--jobs", "1", "--json"),
    "list": ("campaign", "--list"),
    "gates": ("gates", "--jobs", "1"),
}


def _spoilt(built: Path, here: Path, edit: Callable[[Any, Any, Any], None]) -> str:
    folder = Path(shutil.copytree(built, here / "::error::f"))
    names = ("contract.json", "rehearsals.json", "manifest.json")
    told = [json.loads((folder / name).read_text()) for name in names]
    edit(*told)
    for name, content in zip(names, told, strict=True):
        (folder / name).write_text(json.dumps(content))
    return "::error::f"


@pytest.mark.parametrize("edit", [_named, _celled, _listed, _target, _fault, _key, _file, _outcome])
def test_mock_of_a_folder_of_strangers(edit: Callable[[Any, Any, Any], None], built: Path, here: Path) -> None:
    folder = _spoilt(built, here, edit)
    _clean(run("mock", folder))
    _clean(run("mock", folder, "--edited"))
    # The reader refuses hidden characters; without it the output is held by itself.
    with patch("cellc.mock.folder._refuse_hidden"):
        for name, options in _RUNS.items():
            ran = _clean(run("mock", folder, "--edited", *options))
            assert ran.code in ((0, 1) if edit is _named else (1, 2))
            if name == "json" and ran.code != 2:
                assert json.loads(ran.out)["rehearsals"]
    for file in (here / "records.jsonl", here / "evidence" / "report.html", here / "evidence" / "evidence.json"):
        if file.exists():
            lines = [line.replace("\t", " ") for line in file.read_text(encoding="utf-8").splitlines()]
            assert [line for line in harm("\n".join(f"- {line}" for line in lines)) if "##" not in line] == []


@pytest.mark.parametrize("options", _CAMPAIGN.values(), ids=_CAMPAIGN.keys())
def test_campaign_of_a_folder_of_strangers(options: tuple[str, ...], built: Path, here: Path) -> None:
    folder = _spoilt(built, here, _named)
    few = patch("cellc.mock.command.campaign.possible_faults", lambda contract: possible_faults(contract)[:2])
    with patch("cellc.mock.folder._refuse_hidden"), few:
        ran = _clean(run(options[0], folder, "--edited", *options[1:]))
        assert ran.code in (0, 1), ran.err
