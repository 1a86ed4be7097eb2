"""What was released together: whether the pins of a device are those of one release, old ones too."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

from cellc.compiler.catalog.load import load_releases
from cellc.compiler.catalog.tables import ReleaseSet
from cellc.compiler.catalog.version_rows import VersionRow
from cellc.compiler.cell.device import Device
from cellc.contract.pins import is_commit, last_word, same_version, version_number, version_numbers
from cellc.contract.vocabulary import UNKNOWN

PACKAGED = ("driver", "sdk", "description")
"""The parts of a device that are packages."""


@lru_cache(maxsize=16)
def release_sets(distro: str) -> tuple[ReleaseSet, ...]:
    """Return what belonged together on a distribution, the newest first."""
    table = load_releases().value
    return () if table is None else table.sets(distro)


def was_released(distro: str, package: str, text: str) -> bool:
    """Whether a distribution, or a vendor for it, ever released a package in the version of a pin."""
    return any(same_version(text, item.packages[package]) for item in release_sets(distro) if package in item.packages)


def were_together(distro: str, pins: Mapping[str, str]) -> ReleaseSet | None:
    """Return the newest set of a distribution with the packages of some pins as pinned, as far as it has them."""
    sets = (item for item in release_sets(distro) if not item.built and not item.packages.keys().isdisjoint(pins))
    return next(
        (
            item
            for item in sets
            if all(same_version(pins[name], item.packages[name]) for name in pins if name in item.packages)
        ),
        None,
    )


def named_row(text: str, part: str, rows: tuple[VersionRow, ...], distro: str) -> VersionRow | None:
    """Return the row of a distribution that names the very version of a pin; None where none does."""
    here = (row for row in rows if row.part == part and row.distro in (None, distro))
    return next((row for row in here if any(same_version(text, known) for known in row.known)), None)


def unlisted(device: Device, distro: str) -> tuple[str, ...]:
    """Return the parts of a device that are pinned to what no row of its matrix names, though it has rows for them."""
    pins = ((part, device.software.versions.part(part)) for part in PACKAGED)
    rows = tuple(row for row in device.software.version_rows if row.known)
    return tuple(
        part
        for part, text in pins
        if (version_number(text) or is_commit(last_word(text)))
        and any(row.part == part for row in rows)
        and named_row(text, part, rows, distro) is None
    )


def foreign_lines(device: Device, part: str, distro: str) -> tuple[VersionRow, ...]:
    """Return the rows of other distributions with the major version of a part, where none of its own knows that."""
    text = device.software.versions.part(part)
    rows = [row for row in device.software.version_rows if row.part == part and row.known]
    here = [row for row in rows if row.distro in (None, distro)]
    if not here or not version_numbers(text) or any(_has_line(row, text) for row in here):
        return ()
    if was_released(distro, package_of(device, part) or "", text):
        return ()
    return tuple(row for row in rows if _has_line(row, text))


def package_of(device: Device, part: str) -> str | None:
    """Return the package that a part of the version tuple is; None where the device has none."""
    packages = device.software.packages
    return {"driver": packages.driver, "sdk": packages.sdk, "description": packages.description}[part]


def shared_parts(device: Device, one: ReleaseSet) -> dict[str, str]:
    """Return the versions that a release set has of the packages that a device pins, by their part."""
    pinned = {part: package_of(device, part) for part in PACKAGED if device.software.versions.part(part) != UNKNOWN}
    return {part: one.packages[name] for part, name in pinned.items() if name is not None and name in one.packages}


def differing(device: Device, one: ReleaseSet) -> tuple[str, ...]:
    """Return the parts of a device that a release set has in another version."""
    shared = shared_parts(device, one).items()
    return tuple(part for part, version in shared if not same_version(device.software.versions.part(part), version))


def own_release(device: Device, distro: str) -> ReleaseSet | None:
    """Return the newest release set that a device is of: as the set says, and the set has all that no row names."""
    odd = set(unlisted(device, distro))
    fitting = (item for item in release_sets(distro) if odd <= set(shared_parts(device, item)))
    return next((item for item in fitting if not differing(device, item)), None)


def nearest_release(device: Device, distro: str) -> ReleaseSet | None:
    """Return the release set with most of a device's versions, the newest of such; None where none has its packages."""
    sets = [item for item in release_sets(distro) if shared_parts(device, item)]
    return max(sets, key=lambda one: len(shared_parts(device, one)) - len(differing(device, one)), default=None)


def _has_line(row: VersionRow, text: str) -> bool:
    return any(version_numbers(known)[:1] == version_numbers(text)[:1] for known in row.known)
