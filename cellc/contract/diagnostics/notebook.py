"""Tables of HTML for a notebook; every text in them may be untrusted."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

from cellc.contract.diagnostics.unsafe_text import escaped


def html_table(caption: str, head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table; a caption alone where it has no rows."""
    lines = [f"<tr>{_cells('td', row)}</tr>" for row in rows]
    body = f"<thead><tr>{_cells('th', head)}</tr></thead><tbody>{''.join(lines)}</tbody>" if lines else ""
    return f"<table><caption>{_shown(caption)}</caption>{body}</table>"


def _cells(tag: str, texts: Iterable[str]) -> str:
    return "".join(f'<{tag} style="text-align: left">{_shown(text)}</{tag}>' for text in texts)


def _shown(text: str) -> str:
    return escape(escaped(text))
