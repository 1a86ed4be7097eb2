"""The vendor's own description, where its package lies beside the spec or on the package path: its shapes are taken.

Joints, limits and inertias stay those of the catalog, which the real driver was compared with; rules report
what differs.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.cell.body import VendorDescription
from cellc.compiler.source.document import SourceDocument
from cellc.contract.limits import Budget
from cellc.robot.description.model import Description, Link
from cellc.robot.description.packages import find_package, root_of


def link_vendor_description(
    facts: DeviceModel, document: SourceDocument, prefix: str, budget: Budget, packages: Sequence[str] = ()
) -> VendorDescription | None:
    """Read the vendor's description; None where the catalog names none.

    Args:
        prefix: of the device; the vendor's names are taken without any.
        budget: what expansions of the spec may still take.
        packages: further folders of packages that the spec names.
    """
    package, vendor = facts.description.package, facts.description.vendor
    if package is None or vendor is None:
        return None
    folder = find_package(package, os.path.dirname(document.file) or ".", *packages)
    if folder is None:
        return VendorDescription(package=package)
    from cellc.robot.description.read_description import read_description

    file = Path(folder) / vendor.file
    read = read_description(file, vendor.arguments, root_of(file), budget)
    description = VendorDescription(package=package, folder=Path(folder).as_posix())
    if read.value is None:
        cause = read.diagnostics[0]
        return replace(description, refused=f"{cause.span.file}:{cause.span.line}: {cause.message}")
    return replace(description, description=read.value.with_link_names(vendor.links).renamed(prefix))


def with_vendor_shapes(description: Description, vendor: VendorDescription | None) -> Description:
    """Return the description with the vendor's shapes on each link that both have."""
    if vendor is None or vendor.description is None:
        return description
    shaped = {link.name: link for link in vendor.description.links}
    return replace(description, links=tuple(_shaped(link, shaped.get(link.name)) for link in description.links))


def _shaped(link: Link, vendor: Link | None) -> Link:
    return link if vendor is None else replace(link, visuals=vendor.visuals, collisions=vendor.collisions)
