"""Packs the extension for VS Code: ``python docs/editor/vscode/pack.py FOLDER`` writes ``cellc-VERSION.vsix`` there.

A VSIX is a zip of the extension, its manifest and the types of its files. The layout is that of ``vsce package``
(microsoft/vscode-vsce 3, src/package.ts), which needs Node.js; the bytes are the same on every machine.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from xml.sax.saxutils import escape, quoteattr
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

FOLDER = Path(__file__).resolve().parent
_LICENSE = FOLDER.parents[2] / "LICENSE"
_FILES = {"package.json": FOLDER, "extension.js": FOLDER, "readme.md": FOLDER}
_TYPES = """\
<?xml version="1.0" encoding="utf-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">\
<Default Extension=".json" ContentType="application/json"/>\
<Default Extension=".js" ContentType="application/javascript"/>\
<Default Extension=".md" ContentType="text/markdown"/>\
<Default Extension=".txt" ContentType="text/plain"/>\
<Default Extension=".vsixmanifest" ContentType="text/xml"/>\
</Types>
"""
_MANIFEST = """\
<?xml version="1.0" encoding="utf-8"?>
<PackageManifest Version="2.0.0" xmlns="http://schemas.microsoft.com/developer/vsx-schema/2011" \
xmlns:d="http://schemas.microsoft.com/developer/vsx-schema-design/2011">
  <Metadata>
    <Identity Language="en-US" Id={name} Version={version} Publisher={publisher}/>
    <DisplayName>{displayName}</DisplayName>
    <Description xml:space="preserve">{description}</Description>
    <Tags>{keywords}</Tags>
    <Categories>{categories}</Categories>
    <GalleryFlags>Public</GalleryFlags>
    <License>extension/LICENSE.txt</License>
    <Properties>
      <Property Id="Microsoft.VisualStudio.Code.Engine" Value={engine}/>
      <Property Id="Microsoft.VisualStudio.Code.ExtensionDependencies" Value=""/>
      <Property Id="Microsoft.VisualStudio.Code.ExtensionPack" Value=""/>
      <Property Id="Microsoft.VisualStudio.Code.ExtensionKind" Value={kind}/>
    </Properties>
  </Metadata>
  <Installation>
    <InstallationTarget Id="Microsoft.VisualStudio.Code"/>
  </Installation>
  <Dependencies/>
  <Assets>
    <Asset Type="Microsoft.VisualStudio.Code.Manifest" Path="extension/package.json" Addressable="true"/>
    <Asset Type="Microsoft.VisualStudio.Services.Content.Details" Path="extension/readme.md" Addressable="true"/>
    <Asset Type="Microsoft.VisualStudio.Services.Content.License" Path="extension/LICENSE.txt" Addressable="true"/>
  </Assets>
</PackageManifest>
"""


def pack(folder: Path) -> Path:
    """Write the package into a folder, and return it."""
    stated = json.loads((FOLDER / "package.json").read_text(encoding="utf-8"))
    package = folder / f"{stated['name']}-{stated['version']}.vsix"
    texts = {"[Content_Types].xml": _TYPES, "extension.vsixmanifest": _manifest(stated)}
    texts |= {f"extension/{name}": (place / name).read_text(encoding="utf-8") for name, place in _FILES.items()}
    texts["extension/LICENSE.txt"] = _LICENSE.read_text(encoding="utf-8")
    with ZipFile(package, "w", ZIP_DEFLATED) as archive:
        for name, text in texts.items():
            entry = ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.compress_type, entry.external_attr = ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, text)
    return package


def _manifest(stated: dict[str, object]) -> str:
    lists = {key: stated[key] for key in ("keywords", "categories", "extensionKind")}
    joined = {key: ",".join(value) for key, value in lists.items() if isinstance(value, list)}
    engines = stated["engines"]
    assert isinstance(engines, dict)
    return _MANIFEST.format(
        **{key: quoteattr(str(stated[key])) for key in ("name", "version", "publisher")},
        **{key: escape(str(stated[key])) for key in ("displayName", "description")},
        keywords=escape(joined["keywords"]),
        categories=escape(joined["categories"]),
        engine=quoteattr(engines["vscode"]),
        kind=quoteattr(joined["extensionKind"]),
    )


if __name__ == "__main__":
    sys.stdout.write(f"{pack(Path(sys.argv[1])).as_posix()}\n")
