"""The whole report, from what was run to what no mock can show."""

from __future__ import annotations

from importlib.resources import files
from xml.etree.ElementTree import Element

from cellc.mock.report_page.boundary import gate_section, identity, unproven
from cellc.mock.report_page.campaign_section import campaign_section
from cellc.mock.report_page.content import ReportContent
from cellc.mock.report_page.element import tag, to_page
from cellc.mock.report_page.overview import header, key_figures, outcomes
from cellc.mock.report_page.run_section import run_section


def to_report(content: ReportContent) -> str:
    """Return the report of a call as one page; the same runs give the same bytes."""
    style = (files("cellc.mock.report_page") / "style.css").read_text(encoding="utf-8")
    runs = [run_section(number, run, content.contract) for number, run in enumerate(content.runs, start=1)]
    main = tag(
        "main",
        header(content),
        outcomes(content),
        key_figures(content),
        *campaign_section(content.campaign),
        gate_section(content.gates),
        *runs,
        identity(content.contract),
        unproven(),
        _colophon(),
    )
    return to_page(f"{content.contract.cell}: rehearsals on the mock", style, tag("body", main))


def _colophon() -> Element:
    words = (
        "Times are simulated, counted from the start of the cell; no clock of the host enters this page, so that the "
        "same folder and seed give the same bytes. Curves are drawn from the least and the greatest value in each "
        "column of the drawing, of all samples at the full rate: no extreme value is left out."
    )
    return tag("footer", tag("p", words))
