"""The hashes by which a build knows its own files again."""

from __future__ import annotations

import hashlib
import json

MANIFEST = "manifest.json"
_FORMAT = 1


def sha256(content: bytes) -> str:
    """Return the digest of a file's bytes as hexadecimal digits."""
    return hashlib.sha256(content).hexdigest()


def hashes_in(content: bytes | None) -> dict[str, str]:
    """Return the hashes of the files that a manifest lists; none where it is absent or not a manifest.

    Only what is needed is read, without the model of the whole file: a build that changes nothing loads no models.
    """
    try:
        manifest = json.loads(content or b"")
    except (ValueError, RecursionError):
        return {}
    if not isinstance(manifest, dict) or manifest.get("format") != _FORMAT:
        return {}
    files = manifest.get("files")
    if not isinstance(files, dict) or not all(isinstance(digest, str) for digest in files.values()):
        return {}
    return files
