"""Read YAML 1.2 once, with the position of every value."""

from cellc.compiler.source.document import Plain, SourceDocument
from cellc.compiler.source.read import read

__all__ = ["Plain", "SourceDocument", "read"]
