"""Answers that are expensive to compute, kept in the user's cache folder by what was asked.

`CELLC_NO_CACHE=1` turns it off. The folder may be deleted at any time, and a result never depends on what is in it.
"""

from cellc.cache.folder import cache_folder
from cellc.cache.recall import recall

__all__ = ["cache_folder", "recall"]
