"""Every key of ``device.yaml`` has a meaning, in the schema and on docs/device.md."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator

import pytest
from pydantic import BaseModel

from cellc.compiler.catalog import catalog_model, device_model
from cellc.compiler.catalog.catalog_model import CatalogModel, said_of
from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.device_schema import device_reference, device_schema
from cellc.compiler.spec.place import keys_in_order
from tests.cells import ROOT
from tests.cli.run import run

PAGE = (ROOT / "docs" / "device.md").read_text(encoding="utf-8")
SCHEMA = json.loads(device_schema())
OBJECTS = {"DeviceModel": SCHEMA, **{name: one for name, one in SCHEMA["$defs"].items() if "properties" in one}}


def test_committed_page_and_schema_are_those_of_the_models() -> None:
    # Written by `cellc schema device --reference > docs/device.md` and `cellc schema -o schemas`.
    assert device_reference() == PAGE
    assert device_schema() == (ROOT / "schemas" / "device.schema.json").read_text(encoding="utf-8")


def test_every_key_has_a_meaning_that_is_a_sentence() -> None:
    told = {(model, key): field for model, one in OBJECTS.items() for key, field in one["properties"].items()}
    assert len(told) > 390
    wrong = {key for key, field in told.items() if not re.match(r"[`A-Z].*\.$", field.get("description", ""))}
    assert wrong == set()


def test_every_model_has_a_summary_without_its_keys() -> None:
    assert {model for model, one in OBJECTS.items() if not one["description"].endswith(".")} == set()
    assert {model for model, one in OBJECTS.items() if "Attributes" in one["description"]} == set()


def test_a_quantity_names_its_units() -> None:
    told = (field for one in OBJECTS.values() for field in one["properties"].values() if "x-units" in json.dumps(field))
    assert all(" Units: " in field["description"] for field in told)


def test_no_meaning_is_that_of_a_key_that_is_gone() -> None:
    stated = re.compile(r"^ {4}(\w+): ", re.MULTILINE)
    for model in _subclasses(CatalogModel):
        lines = stated.findall((model.__doc__ or "").replace("\n    ", "\n").partition("Attributes:")[2])
        assert set(lines) <= set(model.model_fields), model.__name__


def test_a_key_of_a_base_has_its_meaning_there() -> None:
    from cellc.compiler.catalog.limit_facts import VelocityLimit

    assert said_of(VelocityLimit, "source").startswith("Document with its version")
    assert said_of(VelocityLimit, "sourc") == ""


def test_every_key_stands_on_the_page_and_every_link_leads_to_one_heading() -> None:
    keys = {key for one in OBJECTS.values() for key in one["properties"]}
    assert {key for key in keys if f"`{key}`" not in PAGE} == set()
    headings = [_anchor(line) for line in re.findall(r"^#+ (.+)$", PAGE, re.MULTILINE)]
    assert len(headings) == len(set(headings))
    assert set(re.findall(r"\]\(#([^)]+)\)", PAGE)) <= set(headings)


def _anchor(heading: str) -> str:
    return re.sub(r"[^a-z0-9 _-]", "", heading.lower()).replace(" ", "-")


def test_the_command_prints_the_page_and_refuses_one_that_there_is_not() -> None:
    assert run("schema", "device", "--reference").out == PAGE
    refused = run("schema", "fleet", "--reference")
    assert refused.code == 2
    assert "there is no reference of `fleet`; there are those of cell and device" in refused.err


def test_no_docstring_is_read_where_a_device_is(monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*_: object) -> str:
        raise AssertionError("a check pays for the reference")

    for name in ("said_of", "summary_of"):
        monkeypatch.setattr(catalog_model, name, never)
    for model in _subclasses(CatalogModel):
        model.model_rebuild(force=True)
    assert "device_schema" not in vars(device_model)
    assert keys_in_order(DeviceModel)[0] == "format"


def _subclasses(model: type[BaseModel]) -> Iterator[type[BaseModel]]:
    for one in model.__subclasses__():
        if one.__module__.startswith("cellc."):
            yield one
            yield from _subclasses(one)
