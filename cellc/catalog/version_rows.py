"""Rows of the version matrix: which versions of a device's parts go together on which distribution."""

from typing import Literal

from cellc.catalog.catalog_model import CatalogModel, Date, DistroName, FileName, Text


class RepositoryPin(CatalogModel):
    """A repository at one commit or tag, as ``vcs import`` takes it; ``name`` is its folder in a workspace."""

    name: FileName
    url: Text
    ref: FileName


class VersionRow(CatalogModel):
    """Versions that go together on one distribution; ``known`` are those that the source names.

    A version that the distribution does not release is ``built_from`` repositories, its own first. ``ambiguous`` says
    why a version pins nothing.
    """

    part: Literal["driver", "sdk", "description", "firmware"]
    distro: DistroName | None = None
    product: Text | None = None
    known: tuple[Text, ...] = ()
    minimum: Text | None = None
    below: Text | None = None
    built_from: tuple[RepositoryPin, ...] = ()
    ambiguous: Text | None = None
    note: Text | None = None
    source: Text
    as_of: Date
