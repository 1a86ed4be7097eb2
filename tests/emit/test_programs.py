"""Programs that read what is generated are given names and addresses by it, never an option or a command."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from xml.sax.saxutils import escape

import pytest
from pydantic import ValidationError

from cellc.compiler.catalog.version_rows import RepositoryPin
from tests.cells import CORPUS, ROOT, spec_text
from tests.cli.run import run
from tests.emit.cells import emitted
from tests.emit.taint.payloads import PAYLOADS
from tests.emit.taint.programs import READ_BY, manifest, misled, recorded, vcs

HOSTILE = (
    "--upload-pack=touch taint",
    "-u",
    "ext::sh -c taint",
    "fd::17",
    "file:///etc",
    "/etc",
    "../elsewhere",
    "http://example.com/a",
    "git://example.com/a",
    "https://example.com/a --upload-pack=x",
    "https://-x/a",
    "https://user:secret@example.com/a",
    "https://example.com/../a",
    "https://example.com",
    "ssh://-oProxyCommand=taint/a",
    "ssh://git@-oProxyCommand=taint/a",
    "git@-oProxyCommand=taint:a",
    "git@example.com:-a",
    "git@example.com:/etc",
    "https://example.com/a\n",
    "https://example.com/$(taint)",
    "",
)
GENUINE = (
    "https://github.com/owner/name.git",
    "https://git.example.com:8443/group/sub.group/name",
    "ssh://git@example.com:22/owner/name.git",
    "ssh://example.com/name",
    "git@example.com:owner/name.git",
)
_MANIFEST = """<package format="3"><name>a</name><version>1.0.0</version><description>b</description>
<maintainer email="a@b.cd">c</maintainer><license>d</license><exec_depend version_gte="1">x</exec_depend>
<buildtool_depend>y</buildtool_depend><doc_depend>z</doc_depend><depend>w</depend></package>"""
_REPOS = "repositories: {{a: {{{}}}}}"
_ADDRESS = "url: 'https://example.com/a'"


@pytest.mark.parametrize("url", HOSTILE, ids=ascii)
def test_no_repository_is_fetched_by_an_option_a_file_or_a_program(url: str) -> None:
    with pytest.raises(ValidationError):
        RepositoryPin(name="a", url=url, ref="b")


@pytest.mark.parametrize("url", GENUINE)
def test_repositories_over_https_and_ssh_are_taken(url: str) -> None:
    assert not list(misled({"sources.repos": f"repositories: {{a: {{type: git, url: {url!r}, version: b}}}}"}))
    assert RepositoryPin(name="a", url=url, ref="b").url == url


def test_a_device_with_another_address_is_refused_at_its_line(tmp_path: Path) -> None:
    device = Path(shutil.copytree(CORPUS / "invalid/base/stage", tmp_path / "stage")) / "device.yaml"
    text = device.read_text(encoding="utf-8")
    row = "  - {part: driver, distro: jazzy, known: [1.0.0], source: a, as_of: 2026-01-01,\n"
    row += "     built_from: [{name: a, url: 'ext::sh -c taint', ref: b}]}\n"
    device.write_text(f"{text}versions:\n{row}", encoding="utf-8")
    spec = "format: 1\ncell: line\nversions: {ros: jazzy}\ndevices: {a: {model: ./stage}}\n"
    (tmp_path / "cell.yaml").write_text(spec, encoding="utf-8")
    ran = run("check", str(tmp_path / "cell.yaml"))
    line = text.count("\n") + 3
    assert (ran.code, f"device.yaml:{line}:" in ran.out) == (1, True), ran.out
    assert "help: write `https://HOST/PATH`, `ssh://HOST/PATH` or `git@HOST:PATH`" in ran.out


@pytest.mark.parametrize("cell", sorted(path.name for path in (ROOT / "generated").iterdir()))
def test_programs_are_given_names_and_addresses_alone(cell: str) -> None:
    folder = ROOT / "generated" / cell
    assert not list(misled({path: (folder / path).read_text() for path in READ_BY if (folder / path).exists()}))


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("sources.repos", "repositories: {{a: {{type: git, url: {}, version: b}}}}"),
        ("sources.repos", "repositories: {{a: {{type: git, url: 'https://example.com/a', version: {}}}}}"),
        ("sources.repos", "repositories: {{{}: {{type: git, url: 'https://example.com/a', version: b}}}}"),
        ("package.xml", _MANIFEST.replace(">x<", ">{}<")),
        ("package.xml", _MANIFEST.replace("<name>a", "<name>{}")),
        ("CMakeLists.txt", "install(FILES\n  {}\n)"),
    ],
)
@pytest.mark.parametrize("hostile", ["--upload-pack=x", "../x", "ext::x", "$x"])
def test_an_option_a_place_and_a_transport_would_be_seen(path: str, text: str, hostile: str) -> None:
    assert list(misled({path: text.format(hostile)}))


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("sources.repos", _REPOS.format(f"{_ADDRESS}, version: b")),  # left out by vcs
        ("sources.repos", _REPOS.format(f"type: svn, {_ADDRESS}")),  # Subversion would be run
        ("package.xml", _MANIFEST.replace(">b<", "> <")),
        ("package.xml", _MANIFEST.replace("1.0.0", "1.0")),
        ("package.xml", _MANIFEST.replace("a@b.cd", "a")),
        ("package.xml", _MANIFEST.replace(">d<", "> <")),
        ("package.xml", _MANIFEST.replace(">x<", ">a<")),  # on itself
    ],
)
def test_what_a_program_passes_over_would_be_seen(path: str, text: str) -> None:
    assert list(misled({path: text}))


def test_a_summary_without_a_letter_leaves_a_package_that_colcon_builds(tmp_path: Path) -> None:
    made = emitted(tmp_path, spec_text("minimal").replace("summary:", "summary: ' '  #"))
    assert manifest(made["package.xml"]).refusal == ""


def test_programs_read_of_a_manifest_all_dependencies_but_those_of_documents() -> None:
    assert manifest(_MANIFEST).keys == ("w", "y", "x")
    assert not list(misled({"package.xml": _MANIFEST}))


_VARIANTS = [
    _MANIFEST.replace(place, place.replace(old, escape(text, {'"': "&quot;"})))
    for place, old in [(">a<", "a"), ("1.0.0", "1.0.0"), (">b<", "b"), ("a@b.cd", "a@b.cd"), (">x<", "x"), ('"1"', "1")]
    for text in [*PAYLOADS.values(), " ", " x ", "a", "a-b", "B", "0.1", "02.0.0", "a.b@c.d.ef", "é@b.cd", "a@b.c"]
    if "\0" not in text and "\x9b" not in text
]


def test_the_real_parser_of_manifests_reads_and_refuses_the_same() -> None:
    package = pytest.importorskip("catkin_pkg.package", reason="catkin_pkg is not installed")
    for text in [
        _MANIFEST,
        *_VARIANTS,
        *((path / "package.xml").read_text() for path in (ROOT / "generated").iterdir()),
    ]:
        read = manifest(text)
        try:
            real = package.parse_package_string(text, warnings=[])
        except package.InvalidPackage:
            assert read.refusal, text
        else:
            assert (read.refusal, read.name) == ("", real.name), text


def test_the_real_rosdep_has_the_same_keys(tmp_path: Path) -> None:
    loader = pytest.importorskip("rosdep2.rospkg_loader", reason="rosdep is not installed")
    packages = pytest.importorskip("rospkg")
    folder = tmp_path / "a"
    folder.mkdir()
    (folder / "package.xml").write_text(_MANIFEST, encoding="utf-8")
    found = loader.RosPkgLoader(packages.RosPack([str(tmp_path)]), packages.RosStack([str(tmp_path)]))
    assert set(found.get_rosdeps("a")) == set(manifest(_MANIFEST).keys)


def test_the_real_colcon_takes_the_name_of_a_manifest_or_passes_over_it(tmp_path: Path) -> None:
    ros = pytest.importorskip("colcon_ros.package_identification.ros", reason="colcon is not installed")
    for number, text in enumerate((_MANIFEST, _MANIFEST.replace(">b<", "> <"))):
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / "package.xml").write_text(text, encoding="utf-8")
        package, _ = ros.get_package_with_build_type(str(folder))
        assert (package.name if package else "") == ("" if manifest(text).refusal else "a")


def test_the_real_vcs_runs_the_same_commands() -> None:
    pytest.importorskip("vcstool", reason="vcstool is not installed")
    versions = ("", ", version: b", ", version: heads/b", ", version: tags/b", ", version: 1.10", ", version: ''")
    asked = ((url, version) for url in GENUINE for version in versions)
    rows = (f"  r{number}: {{type: git, url: '{url}'{version}}}\n" for number, (url, version) in enumerate(asked))
    text = "".join(("repositories:\n", *rows))

    def run(folder: Path, environment: dict[str, str]) -> None:
        (folder / "src").mkdir()
        (folder / "a.repos").write_text(text, encoding="utf-8")
        program = "import sys; from vcstool.commands.import_ import main; sys.exit(main(sys.argv[1:]))"
        line = [sys.executable, "-c", program, "src", "--input", "a.repos", "--workers", "2"]
        found = {**environment, "PYTHONPATH": os.pathsep.join(sys.path)}
        subprocess.run(line, env=found, cwd=folder, check=True, capture_output=True, timeout=60)

    # 30 clones; of the six versions two are asked for and three checked out; one host of `git@`.
    expected = sorted(words for words in vcs(text) if words[0] != "mkdir")
    assert (len(expected), sorted(recorded(("git", "ssh-keygen"), run))) == (30 + 5 * (2 + 3) + 1, expected)
