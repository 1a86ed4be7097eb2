"""Tables for a hover: a model of the catalog, the limits of joints, the words of a closed list."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.cell.cell import Cell
from cellc.compiler.formats.escape import code, markdown
from cellc.compiler.formats.markdown_table import table
from cellc.compiler.spec.meanings import meaning_of_word
from cellc.contract.diagnostics import YamlPath
from cellc.tools.lsp.fields import words_of
from cellc.tools.lsp.units import of_a_joint

_LIMITS = {"velocity": "/s", "acceleration": "/s^2"}


def words_table(annotation: object, key: str) -> str:
    """Return the words that a value may be, each with what it means; empty where nothing is said of them."""
    rows = [(code(word), meaning_of_word(key, word)) for word in words_of(annotation)]
    return table(("word", "meaning"), rows) if any(meaning for _, meaning in rows) else ""


def card(name: str) -> str:
    """Return what the catalog has of a model: figures with their sources, joints, releases; empty without an entry."""
    from cellc.tools.browse.search import entries

    entry = next((entry for entry in entries() if entry.model.model == name), None)
    if entry is None:
        return ""
    model = entry.model
    joints = sum(joint.movable and joint.mimic is None for joint in entry.description.joints)
    rows = [*_figures(model), *((("joints that move", str(joints), ""),) if joints else ()), *_releases(model)]
    return f"{markdown(f'{model.vendor}: {model.summary}')}\n\n{table(('', name, 'source'), rows)}"


def _figures(model: DeviceModel) -> Iterator[tuple[str, str, str]]:
    for what in ("reach", "payload", "repeatability"):
        figure = getattr(model.limits, what)
        if figure is not None:
            yield what, figure.value.text, figure.source


def _releases(model: DeviceModel) -> Iterator[tuple[str, str, str]]:
    from cellc.tools.browse.page import releases

    for part, distro, versions, source in releases(model):
        yield f"{part} for {distro}" if distro != "all" else part, versions, source


def limits_table(cell: Cell, path: YamlPath) -> str:
    """Return what shares of its limits leave to each joint of a device, in degrees and millimeters."""
    if len(path) < 4 or path[0] != "devices" or path[2] != "limits" or path[3] not in _LIMITS:
        return ""
    per, what = _LIMITS[str(path[3])], str(path[3])
    device = next((device for device in cell.devices if device.name == path[1]), None)
    figures = () if device is None else ((joint, getattr(joint, what)) for joint in device.joints)
    rows = [(code(j.local_name), of_a_joint(f, per, slides=j.slides)) for j, f in figures if f is not None]
    return table(("joint", f"{what} at most"), rows) if rows else ""
