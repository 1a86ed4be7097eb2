"""The door to the files that an answer is computed from: what is asked of them can be written down and asked again.

Every stage that reads what a user wrote asks here, also whether something is there at all. Whoever keeps an answer
keeps these questions with it: the answer holds as long as the disk says the same. Files of the package itself are no
questions; they belong to the program.
"""

from cellc.disk.questions import contents, kind_of, matches, names_in, real_path, status
from cellc.disk.record import Record, include_in_work, not_to_be_kept, recorded, unrecorded

__all__ = [
    "Record",
    "contents",
    "include_in_work",
    "kind_of",
    "matches",
    "names_in",
    "not_to_be_kept",
    "real_path",
    "recorded",
    "status",
    "unrecorded",
]
