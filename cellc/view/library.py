"""three.js, from the installed package that ships it.

trimesh, which yourdfpy needs, has a page of its own with three.js in it (release 140, MIT) for
`trimesh.viewer.scene_to_html`: https://github.com/mikedh/trimesh/tree/5.2.0/trimesh/resources/templates. The library
alone is taken from there, with its license at the head, and trimesh is not imported, which would load numerics for a
text.
"""

from __future__ import annotations

import re
import zipfile
from importlib.util import find_spec
from pathlib import Path

_ARCHIVE, _TEMPLATE = "resources/templates/viewer.zip", "viewer.html.template"
_LARGEST = 4 * 1024 * 1024
# From the license to the end of the module; behind it the template has controls and loaders of its own.
_MODULE = re.compile(r"<script>(/\*\*\n \* @license\n[^/]*Three\.js Authors.*?\}\)\);)\n", re.DOTALL)


def three_js() -> str | None:
    """Return the text of three.js; None where no package ships it in the form that is known here."""
    found = find_spec("trimesh")
    for folder in (found.submodule_search_locations or ()) if found is not None else ():
        try:
            with zipfile.ZipFile(Path(folder) / _ARCHIVE) as archive, archive.open(_TEMPLATE) as template:
                text = template.read(_LARGEST).decode("utf-8")
        except (OSError, KeyError, ValueError, zipfile.BadZipFile):
            continue
        module = _MODULE.search(text)
        if module is not None and "</script" not in module[1]:
            return module[1]
    return None
