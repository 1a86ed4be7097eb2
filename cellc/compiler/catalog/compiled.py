"""The catalog in the form in which a check reads it: JSON with expanded descriptions, beside the files it comes from.

Reading YAML with its places and expanding xacro took a fifth of a check. A compiled entry says from which bytes it was
made; where they differ from the files, it is not used. ``python -m cellc.compiler.catalog.compiled`` writes them all.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from cellc.contract.diagnostics import Span
from cellc.contract.store.regular_file import own_bytes, own_text
from cellc.contract.store.swap import write_whole

CATALOG = Path(__file__).parent
SHOWN = "cellc/compiler/catalog"
"""Placeholder for the folder of the package in messages: its place on the machine does not matter there."""

DEVICE_FILE = "device.yaml"
FAMILY_FILE = ".family.yaml"
"""How the name of the file ends that states what the models of a family share."""

MODEL = "{model}"
"""Placeholder for the name of the model in the texts of a family."""

_COMPILED = "compiled"
Places = Mapping[tuple[str, str], Span]
"""Where each ``("link", name)`` and ``("joint", name)`` of a description was written before its expansion."""


def compiled_table(file: str) -> str | None:
    """Return the data of a YAML file of the catalog as JSON, or None where it is to be read itself."""
    entry = _entry(file, (CATALOG / file,))
    return None if entry is None else json.dumps(entry["data"])


def compiled_device(name: str) -> tuple[str, str, Places] | None:
    """Return the facts of a device as JSON, its URDF and its places, or None where its files are to be read."""
    entry = _entry(f"devices/{name}", _files_of(name))
    if entry is None:
        return None
    data, family = entry["data"], None
    if "family" in data:
        file = device_file(name).with_name(f"{data['family']}{FAMILY_FILE}")
        family = _entry(_family_entry(file), (file,))
        if family is None:
            return None
        shared = json.loads(json.dumps(family["data"]).replace(MODEL, data["model"]))
        data = _laid_over(shared, data)
    places = {(tag, part): Span(f"{SHOWN}/devices/{file}", *at) for tag, part, file, *at in entry["places"]}
    return json.dumps(data), entry["urdf"], places


def _laid_over(below: Any, above: Any) -> Any:
    """As ``overlay`` of the source does; a test holds that both agree on every device."""
    if not isinstance(below, dict) or not isinstance(above, dict):
        return above
    overlaid = {key: _laid_over(below[key], value) if key in below else value for key, value in above.items()}
    return {key: value for key, value in {**below, **overlaid}.items() if value is not None or key not in below}


def _family_entry(file: Path) -> str:
    return f"devices/{file.parent.name}.{file.name}"


def device_file(name: str) -> Path:
    """Return the file that states a device: ``device.yaml`` of its own folder, or its own among those of its vendor.

    Raises:
        KeyError: the catalog lists no such device.
    """
    devices = CATALOG / "devices"
    single = devices / name / DEVICE_FILE
    entry_file = single if single.is_file() else next(devices.glob(f"*/{name}.yaml"), None)
    if entry_file is None:
        raise KeyError(name)
    return entry_file


def compile_catalog() -> Iterator[tuple[Path, str]]:
    """Yield every compiled file with its text.

    Raises:
        ValueError: an entry is not valid.
    """
    from cellc.compiler.catalog.load import controller_kinds, device_names

    tables = (
        "distros",
        "controller_manager",
        "message_types",
        "moveit",
        "packages",
        "program_parameters",
        "programs",
        "qos_profiles",
        "releases",
    )
    symptoms = (f"symptoms/{file.stem}" for file in sorted((CATALOG / "symptoms").glob("*.yaml")))
    for table in (*tables, *(f"controllers/{kind}" for kind in controller_kinds()), *symptoms):
        yield _written(f"{table}.yaml", (CATALOG / f"{table}.yaml",), {"data": _data(CATALOG / f"{table}.yaml")})
    for family in sorted((CATALOG / "devices").glob(f"*/*{FAMILY_FILE}")):
        yield _written(_family_entry(family), (family,), {"data": _data(family)})
    for name in device_names():
        yield _written(f"devices/{name}", _files_of(name), _device(name))


def _device(name: str) -> dict[str, Any]:
    from cellc.compiler.catalog.load import read_device
    from cellc.robot.description.xacro_expansion import expand_here

    devices = CATALOG / "devices"
    device = read_device(name)
    if device.value is None or device.diagnostics:
        raise ValueError(f"{name}: {'; '.join(diagnostic.message for diagnostic in device.diagnostics)}")
    description = device.value.model.description
    shown = f"{SHOWN}/devices"
    file = device_file(name)
    described = (file.parent / description.file).as_posix()
    expansion = expand_here(described, description.arguments, devices.as_posix(), shown).value
    assert expansion is not None  # it was read a moment ago
    places = [
        [tag, part, span.file.removeprefix(f"{shown}/"), span.line, span.column, span.end_line, span.end_column]
        for (tag, part), span in expansion.origins.items()
    ]
    return {"data": _data(file), "urdf": expansion.text, "places": places}


def _data(file: Path) -> object:
    from cellc.compiler.source.compose import compose

    root = compose(file.name, own_text(file)).value
    assert root is not None  # held valid by the catalog's tests
    return root.data


def _files_of(name: str) -> tuple[Path, ...]:
    """Name what a device is made from: all of its folder, or its own file and what its vendor's models share."""
    file = device_file(name)
    beside = sorted(path for path in file.parent.iterdir() if path.is_file())
    others = () if file.name == DEVICE_FILE else [path for path in beside if path.suffix == ".yaml" and path != file]
    shared = sorted((CATALOG / "devices").glob("*.xacro"))
    return (*shared, *(path for path in beside if path not in others or path.name.endswith(FAMILY_FILE)))


def _written(name: str, sources: Sequence[Path], content: Mapping[str, object]) -> tuple[Path, str]:
    return _file(name), json.dumps({"made_from": _digest(sources), **content}, separators=(",", ":")) + "\n"


def _entry(name: str, sources: Sequence[Path]) -> dict[str, Any] | None:
    try:
        entry = json.loads(own_bytes(_file(name)))
    except OSError:
        return None
    return entry if isinstance(entry, dict) and entry["made_from"] == _digest(sources) else None


def _file(name: str) -> Path:
    return CATALOG / _COMPILED / f"{name.removesuffix('.yaml')}.json"


def _digest(sources: Sequence[Path]) -> str:
    digest = hashlib.sha256()
    for source in sources:
        # Bytes as in the repository: a checkout on another system may end lines in another way.
        digest.update(f"{source.name}\0".encode() + own_bytes(source).replace(b"\r\n", b"\n") + b"\0")
    return digest.hexdigest()


if __name__ == "__main__":
    for _file_, _text in compile_catalog():
        write_whole(_file_, _text)
