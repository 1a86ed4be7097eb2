"""A release can be made: what is built is what is installed, with all that an editor and a type checker read."""

from __future__ import annotations

import re
import subprocess
import tarfile
import zipfile

import pytest
import yaml

from cellc.compiler.pages import all_codes
from cellc.version import __version__
from tests.cells import ROOT
from tests.installed.install import Install, first_command, run

SCHEMAS = sorted((ROOT / "schemas").glob("*.json"))


@pytest.fixture(name="wheel")
def wheel_fixture(readme_install: Install) -> zipfile.ZipFile:
    return zipfile.ZipFile(readme_install.dist / f"cellc-{__version__}-py3-none-any.whl")


def test_wheel_has_what_an_editor_and_a_type_checker_read(wheel: zipfile.ZipFile) -> None:
    assert SCHEMAS
    for schema in SCHEMAS:
        assert wheel.read(f"cellc/schemas/{schema.name}") == schema.read_bytes()
    licenses = f"cellc-{__version__}.dist-info/licenses"
    for name in ("cellc/py.typed", f"{licenses}/LICENSE", f"{licenses}/NOTICE"):
        assert name in wheel.namelist()


def test_wheel_has_the_page_of_every_code(wheel: zipfile.ZipFile) -> None:
    for code in all_codes():
        page = ROOT / "docs" / "rules" / f"{code}.md"
        assert wheel.read(f"cellc/docs/rules/{code}.md") == page.read_bytes()


def test_wheel_holds_the_package_and_nothing_else(wheel: zipfile.ZipFile) -> None:
    tops = {name.partition("/")[0] for name in wheel.namelist()}
    assert tops == {"cellc", f"cellc-{__version__}.dist-info"}
    assert not [name for name in wheel.namelist() if "__pycache__" in name]


def test_what_readme_installs_is_the_wheel(readme_install: Install, wheel: zipfile.ZipFile) -> None:
    program = "from importlib.metadata import files; print(*files('cellc'), sep='\\n')"
    done = run([str(readme_install.python), "-I", "-c", program], readme_install.checkout)
    installed = {name for name in done.out.splitlines() if name.startswith("cellc/")}
    assert installed == {name for name in wheel.namelist() if name.startswith("cellc/")}


def test_sdist_is_a_checkout_in_which_the_first_command_can_be_run(readme_install: Install) -> None:
    head = f"cellc-{__version__}"
    with tarfile.open(readme_install.dist / f"{head}.tar.gz") as sdist:
        names = set(sdist.getnames())
    for needed in ("pyproject.toml", "README.md", "LICENSE", "NOTICE", "cellc/version.py", "schemas/cell.schema.json"):
        assert f"{head}/{needed}" in names
    for code in all_codes():
        assert f"{head}/docs/rules/{code}.md" in names
    for named in re.findall(r"(?:cells|generated)/[\w/.]+", first_command()):
        assert [name for name in names if name.startswith(f"{head}/{named}")]


def test_installed_program_tells_its_version(readme_install: Install) -> None:
    (ran,) = readme_install.calls([["--version"]], readme_install.checkout)
    assert (ran.code, ran.out) == (0, f"cellc, version {__version__}\n")


def test_release_is_tried_on_the_pythons_of_the_suite() -> None:
    flows = {
        name: yaml.safe_load((ROOT / f".github/workflows/{name}.yml").read_text(encoding="utf-8"))
        for name in ("tests", "release")
    }
    bare = flows["release"]["jobs"]["bare"]
    assert bare["strategy"]["matrix"] == flows["tests"]["jobs"]["suite"]["strategy"]["matrix"]
    assert {"run": ".ci/release"} in bare["steps"]
    assert flows["release"]["jobs"]["publish"]["needs"] == "bare"


def test_script_of_the_release_runs_the_first_command_of_readme() -> None:
    script = (ROOT / ".ci/release").read_text(encoding="utf-8")
    found = re.search(r'eval "\$\((.+)\)"\)', script)
    assert found is not None
    done = subprocess.run(["bash", "-c", found[1]], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == first_command()
