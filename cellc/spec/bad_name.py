"""What a name may look like, for each pattern of the models."""

from __future__ import annotations

import re
from collections.abc import Mapping

from cellc.spec.base import NAME_PATTERN, PACKAGE_NAME_PATTERN, REFERENCE_PATTERN

_RULES: Mapping[str, str] = {
    NAME_PATTERN: "use letters, digits and `_`, beginning with a letter",
    PACKAGE_NAME_PATTERN: "use two or more lower case letters, digits and `_`, beginning with a letter",
    REFERENCE_PATTERN: "write `frame` or `device/link` with letters, digits and `_`",
}


def help_for_bad_name(written: str, pattern: str) -> str:
    """Tell what the pattern allows and, where it is near, a name that fits."""
    rule = _RULES.get(pattern, "use letters, digits and `_`; in a namespace each part begins with `/`")
    suggestion = re.sub(r"[^A-Za-z0-9_/]+", "_", written.strip()).strip("_/")
    suggestion = suggestion.lower() if pattern == PACKAGE_NAME_PATTERN else suggestion
    fits = pattern in _RULES and len(suggestion) <= 64 and re.search(pattern, suggestion)
    return f"{rule}, such as `{suggestion}`" if fits else rule
