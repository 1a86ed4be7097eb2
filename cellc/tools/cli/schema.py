"""``cellc schema``: the JSON schemas of the spec and of what is generated, and the reference of the spec."""

from __future__ import annotations

from pathlib import Path

import click

from cellc.compiler.spec.reference import spec_reference
from cellc.compiler.spec.schema import schema_files
from cellc.contract.printing import show, show_document
from cellc.contract.store.swap import write_whole


@click.command()
@click.argument("name", required=False)
@click.option("-o", "--output", type=click.Path(path_type=Path, file_okay=False), help="Write all schemas to a folder.")
@click.option("--reference", is_flag=True, help="Print the reference of a cell or a device as Markdown.")
def schema(name: str | None, output: Path | None, reference: bool) -> None:
    """Print the schema NAME (by default that of a cell), or write all schemas to a folder.

    Editors complete and explain a cell if its first line is
    `# yaml-language-server: $schema=PATH/cell.schema.json`.

    \b
    cellc schema > cell.schema.json
    cellc schema -o schemas                    all of them
    cellc schema device --reference            every key of device.yaml
    """
    from cellc.compiler.catalog.device_schema import device_reference, device_schema

    if reference:
        pages = {"cell": spec_reference, "device": device_reference}
        if (name or "cell") not in pages:
            raise click.UsageError(f"there is no reference of `{name}`; there are those of {' and '.join(pages)}")
        show_document(pages[name or "cell"]())
        return
    files = {**schema_files(), "device.schema.json": device_schema()}
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
