"""How large a spec may be: far above any cell, far below what hurts the machine that checks it."""

from __future__ import annotations

MAX_FILE_BYTES = 2 * 1024 * 1024
MAX_FILES = 32
MAX_DEPTH = 64
MAX_NODES = 200_000
"""Values of one spec with every alias and include written out."""
MAX_FINDINGS = 100
"""After so many findings in one file it is not a spec with mistakes, and reading stops."""
