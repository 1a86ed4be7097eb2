"""Programs that read what is generated are given names and addresses by it, never an option or a command."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from pydantic import ValidationError

from cellc.compiler.catalog.version_rows import RepositoryPin
from tests.cells import CORPUS, ROOT
from tests.cli.run import run
from tests.emit.taint.programs import READ_BY, misled

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


@pytest.mark.parametrize("url", HOSTILE, ids=ascii)
def test_no_repository_is_fetched_by_an_option_a_file_or_a_program(url: str) -> None:
    with pytest.raises(ValidationError):
        RepositoryPin(name="a", url=url, ref="b")


@pytest.mark.parametrize("url", GENUINE)
def test_repositories_over_https_and_ssh_are_taken(url: str) -> None:
    assert not list(misled({"sources.repos": f"repositories: {{a: {{url: {url!r}, version: b}}}}"}))
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


@pytest.mark.parametrize("cell", sorted(one.name for one in (ROOT / "generated").iterdir()))
def test_programs_are_given_names_and_addresses_alone(cell: str) -> None:
    folder = ROOT / "generated" / cell
    assert not list(misled({path: (folder / path).read_text() for path in READ_BY if (folder / path).exists()}))


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("sources.repos", "repositories: {{a: {{url: {}, version: b}}}}"),
        ("sources.repos", "repositories: {{a: {{url: 'https://example.com/a', version: {}}}}}"),
        ("sources.repos", "repositories: {{{}: {{url: 'https://example.com/a', version: b}}}}"),
        ("package.xml", "<package><name>a</name><exec_depend>{}</exec_depend></package>"),
        ("package.xml", "<package><name>{}</name></package>"),
        ("CMakeLists.txt", "install(FILES\n  {}\n)"),
    ],
)
@pytest.mark.parametrize("hostile", ["--upload-pack=x", "../x", "ext::x", "$x"])
def test_an_option_a_place_and_a_transport_would_be_seen(path: str, text: str, hostile: str) -> None:
    assert list(misled({path: text.format(hostile)}))
