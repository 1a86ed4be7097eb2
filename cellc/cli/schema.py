"""``cellc schema``: the JSON schemas of the spec and of what is generated, and the reference of the spec."""

from __future__ import annotations

import json
from pathlib import Path

import click

from cellc.printing import show, show_document
from cellc.spec.reference import spec_reference
from cellc.spec.schema import schema_files
from cellc.store.swap import write_whole


@click.command()
@click.argument("name", required=False)
@click.option("-o", "--output", type=click.Path(path_type=Path, file_okay=False), help="Write all schemas to a folder.")
@click.option("--reference", is_flag=True, help="Print the reference of the spec language as Markdown.")
def schema(name: str | None, output: Path | None, reference: bool) -> None:
    """Print the schema NAME (the cell's if absent), or write all to a folder.

    Editors complete and explain a cell through the first line
    `# yaml-language-server: $schema=PATH/cell.schema.json`.

    \b
    cellc schema > cell.schema.json
    cellc schema -o schemas                    all of them
    """
    if reference:
        show_document(spec_reference())
        return
    files = {**schema_files(), "device.schema.json": _device_schema()}
    if output is not None:
        for file, text in files.items():
            write_whole(output / file, text)
            show(f"wrote {(output / file).as_posix()}")
        return
    wanted = f"{(name or 'cell').removesuffix('.schema.json')}.schema.json"
    if wanted not in files:
        known = ", ".join(file.removesuffix(".schema.json") for file in files)
        raise click.UsageError(f"there is no schema `{name}`; the schemas are {known}")
    show_document(files[wanted])


def _device_schema() -> str:
    """Return the schema of a ``device.yaml``, a folder of the user's own."""
    from cellc.catalog.device_model import DeviceModel
    from cellc.contract.base import DIALECT

    whole = DeviceModel.model_json_schema()
    # What the model of a family does not say, its family does.
    whole |= {"if": {"required": ["family"]}, "then": {"required": ["model"]}, "else": {"required": whole["required"]}}
    del whole["required"]
    schema = {"$schema": DIALECT, **whole, "title": "Device"}
    # JSON Schema's engines end a text with `$`, Python's with `\\Z`.
    return json.dumps(schema, indent=2, ensure_ascii=False).replace('\\\\Z"', '$"') + "\n"
