"""Read YAML 1.2 once, with the position of every value."""

from cellc.source.codes import CODES
from cellc.source.document import Plain, SourceDocument
from cellc.source.read import read

__all__ = ["CODES", "Plain", "SourceDocument", "read"]
