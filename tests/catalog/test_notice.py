"""NOTICE names the license of every repository whose facts the catalog has."""

from __future__ import annotations

import re

from tests.cells import ROOT

_REPOSITORY = re.compile(r"github\.com/[\w.-]+/[\w-]+")


def test_every_repository_that_the_catalog_cites_has_its_license() -> None:
    catalog = ROOT / "cellc" / "compiler" / "catalog"
    files = [file for file in catalog.rglob("*.yaml") if "symptoms" not in file.parts]  # those cite threads
    cited = {name for file in files for name in _REPOSITORY.findall(file.read_text(encoding="utf-8"))}
    lines = (ROOT / "NOTICE").read_text(encoding="utf-8").splitlines()
    named = {line.split()[0]: line.split(maxsplit=1)[1] for line in lines if _REPOSITORY.match(line.strip())}
    assert len(cited) > 5
    assert cited <= named.keys()
    assert not [name for name, license_text in named.items() if "UNKNOWN" in license_text]
