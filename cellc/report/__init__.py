"""Everything that a person or a program reads of the compiler's findings is formatted here."""

from cellc.report.json_report import render_json
from cellc.report.progress import progress
from cellc.report.terminal import wants_colour
from cellc.report.text_report import render_text, summary

__all__ = ["progress", "render_json", "render_text", "summary", "wants_colour"]
