"""The campaign on the page: every fault at every step with its outcome, the bounds, and what failed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from xml.etree.ElementTree import Element

from cellc.mock.campaign.campaign import Campaign
from cellc.mock.campaign.matrix import Matrix, cell_text, legend, matrix_of
from cellc.mock.campaign.run import RunEnd
from cellc.mock.campaign.text import limit_lines, outcome_lines
from cellc.mock.report_page.element import tag
from cellc.mock.report_page.figures import count


def campaign_section(campaign: Campaign | None) -> Iterator[Element]:
    """Yield the section, where a campaign was run."""
    if campaign is None:
        return
    total, failed = len(campaign.all_ends), len(campaign.failed)
    mark = tag("span", "✓ passed" if campaign.passed else "✗ FAILED", class_="good" if campaign.passed else "bad")
    verdict = tag(
        "p", mark, f" {total - failed} of {count(total, 'run')} ended in a named outcome, within bounds and limits"
    )
    matrices = [_table(matrix_of(baseline.run.entry, campaign.ends)) for baseline in campaign.baselines]
    lines = [tag("li", line.strip()) for line in (*outcome_lines(campaign.ends), *limit_lines(campaign.limits))]
    yield tag(
        "section",
        tag("h2", "Campaign"),
        verdict,
        *_failures(campaign.failed),
        *matrices,
        tag("p", legend(campaign.ends), class_="hint legend"),
        tag("details", tag("summary", "Outcomes, bounds and limits"), tag("ul", *lines, class_="plain-list")),
    )


def _failures(failed: Sequence[RunEnd]) -> Iterator[Element]:
    if failed:
        rows = [tag("li", tag("code", end.run.identifier), f" {end.result.outcome}") for end in failed]
        yield tag("ul", *rows, class_="plain-list bad")


def _table(matrix: Matrix) -> Element:
    steps = [tag("th", tag("b", str(number)), f" {title}") for number, title in enumerate(matrix.steps, start=1)]
    head = tag("tr", tag("th", matrix.rehearsal), *steps)
    rows = [tag("tr", tag("td", fault), *(_cell(cell) for cell in row)) for fault, row in matrix.rows]
    return tag("div", tag("table", tag("thead", head), tag("tbody", *rows), class_="matrix"), class_="wide")


def _cell(ends: Sequence[RunEnd]) -> Element:
    if not ends:
        return tag("td", "–")
    said = "; ".join(f"{end.run.identifier}: {end.result.outcome}" for end in ends)
    style = "bad" if not all(end.passed for end in ends) else "borne" if cell_text(ends) == "ok" else "ended"
    return tag("td", cell_text(ends), class_=style, title=said)
