"""Rows of the version matrix: which versions of a device's parts go together on which distribution."""

from typing import Literal

from pydantic import Field

from cellc.compiler.catalog.catalog_model import CatalogModel, Date, DistroName, FileName, RepositoryUrl, Text


class RepositoryPin(CatalogModel):
    """A repository at one commit or tag, as ``vcs import`` takes it.

    Attributes:
        name: Folder of the repository in the workspace.
        url: Where git fetches it from, over HTTPS or SSH.
        ref: Commit or tag.
    """

    name: FileName
    url: RepositoryUrl
    ref: FileName


class VersionRow(CatalogModel):
    """Versions that go together on one distribution.

    Attributes:
        part: Part of the device whose versions the row has.
        distro: Distribution for which the row holds; absent for all.
        product: Product of the firmware, such as ``polyscope_x``; absent where it has none.
        known: Versions that the source names.
        minimum: Oldest version that works.
        models: Oldest version that knows a model of the family, by the model, where that is a later one.
        below: First version that no longer works.
        built_from: Repositories from which a version is built that the distribution does not release, its own first.
        ambiguous: Why the version pins nothing, if so.
        note: What else is to be known of the row.
        source: Document or index from which the row was read.
        as_of: Day on which the row was read.
    """

    part: Literal["driver", "sdk", "description", "firmware"]
    distro: DistroName | None = None
    product: Text | None = None
    known: tuple[Text, ...] = ()
    minimum: Text | None = None
    models: dict[Text, Text] = Field(default_factory=dict)
    below: Text | None = None
    built_from: tuple[RepositoryPin, ...] = ()
    ambiguous: Text | None = None
    note: Text | None = None
    source: Text
    as_of: Date

    def of_model(self, model: str) -> "VersionRow":
        """Return the row as it holds for one model of the family."""
        return self.model_copy(update={"minimum": self.models.get(model, self.minimum), "models": {}})
