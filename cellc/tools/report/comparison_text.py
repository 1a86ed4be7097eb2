"""A comparison of cells for people: at a terminal in two columns, or below each other; in Markdown as two tables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import zip_longest
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


_LEAST = 80
"""Columns of a terminal from which two cells stand beside each other."""


def _answers(cells: Sequence[str], row: Row, columns: int) -> Iterator[Line]:
    """Yield what all answer alike once, and then what each answers besides, of two cells beside each other."""
    alike = [answer for answer in row.answers[0] if all(answer in answers for answers in row.answers)]
    if alike and not row.same:
        yield (Styled(f"  {'both' if len(cells) == 2 else 'all'}", Style.CYAN),)
    for answer in alike or (("nothing stated",) if row.same else ()):
        yield from _wrapped(answer, columns, "    ")
    if row.same:
        return
    apart = [[answer for answer in answers if answer not in alike] for answers in row.answers]
    besides = "nothing else" if alike else "nothing stated"
    said = [answers or [besides] for answers in apart]
    if len(cells) == 2 and columns >= _LEAST:
        yield from _beside(cells, said, (columns - 3) // 2)
        return
    for name, answers in zip(cells, said, strict=True):
        yield (Styled(f"  {name}", Style.CYAN),)
        for answer in answers:
            yield from _wrapped(answer, columns, "    ")


def _beside(cells: Sequence[str], said: Sequence[Sequence[str]], width: int) -> Iterator[Line]:
    """Yield two columns; a name that is wider than one of them is cut there, and goes on below."""
    left, right = ([line for answer in answers for line in _column(answer, width - 4)] for answers in said)
    yield (Styled(f"  {cells[0]:<{width - 2}} | {cells[1]}", Style.CYAN),)
    yield from (f"    {one:<{width - 4}} | {other}".rstrip() for one, other in zip_longest(left, right, fillvalue=""))


def _column(text: str, width: int) -> Sequence[str]:
    return wrap(text, width, subsequent_indent="  ")


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
