"""The output formats of a comparison: for a terminal, for a comment of a pull request, for programs."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

import click
from pydantic import BaseModel

from cellc.contract.printing import Line, show, show_document

_Found = TypeVar("_Found", bound=BaseModel)

FORM = click.option(
    "--format",
    "output_format",
    type=click.Choice(["text", "markdown", "json"]),
    default="text",
    show_default=True,
    help="Output format.",
)


def tell(
    found: _Found, output_format: str, markdown: Callable[[_Found], str], text: Callable[[_Found], Iterable[Line]]
) -> None:
    """Print what was found in the form that is asked for."""
    if output_format == "json":
        from cellc.contract.diagnostics.unsafe_text import harmless_json

        show_document(harmless_json(found.model_dump_json(indent=2)) + "\n")
    elif output_format == "markdown":
        show_document(markdown(found))
    else:
        show(*text(found))
