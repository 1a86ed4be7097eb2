"""A comparison of cells for people: at a terminal below each other, in Markdown as two tables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from textwrap import wrap

from cellc.compiler.formats.escape import markdown
from cellc.compiler.formats.markdown_table import table
from cellc.contract.printing import Line, Style, Styled
from cellc.tools.report.comparison import Comparison, Row


def render_comparison(compared: Comparison, columns: int) -> Iterator[Line]:
    """Yield the lines for a terminal of so many columns."""
    for title, rows, common in _parts(compared):
        yield (Styled(f"{title}: {', '.join(compared.cells)}", Style.BOLD),)
        for row in rows:
            yield from ("", (Styled(row.question, Style.BLUE), *((": the same in all",) if row.same else ())))
            yield from _answers(compared.cells, row, columns)
            yield from ((Styled(line, Style.DIM),) for line in _wrapped(f"{common}: {row.common}", columns, "  "))
        yield ""


def _parts(compared: Comparison) -> Iterator[tuple[str, Sequence[Row], str]]:
    yield "Motion contracts", compared.motion, "common evidence"
    yield "Duties", compared.duties, "by architecture"


def _answers(cells: Sequence[str], row: Row, columns: int) -> Iterator[Line]:
    for name, answers in zip(cells[:1] if row.same else cells, row.answers, strict=False):
        if not row.same:
            yield (Styled(f"  {name}", Style.CYAN),)
        for answer in answers or ("nothing stated",):
            yield from _wrapped(answer, columns, "    ")


def _wrapped(text: str, columns: int, margin: str) -> Sequence[str]:
    # A name that is longer than the terminal is wide stays whole, so that it can be copied.
    return wrap(text, max(columns, 40), initial_indent=margin, subsequent_indent=f"{margin}  ", break_long_words=False)


def comparison_markdown(compared: Comparison) -> str:
    """Return two tables: what motion rests on, and who has which duty."""
    blocks = [f"# {' and '.join(map(markdown, compared.cells))}"]
    for title, rows, common in _parts(compared):
        stated = (
            (row.question, *(answer or ("nothing stated",) for answer in row.answers), row.common) for row in rows
        )
        blocks += [f"## {title}", table(("question", *compared.cells, common), stated)]
    return "\n\n".join(blocks) + "\n"
