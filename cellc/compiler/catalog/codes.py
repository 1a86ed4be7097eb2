"""Every code that reading descriptions and the catalog can report, with its documentation page."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.contract.diagnostics import Severity
from cellc.contract.diagnostics.diagnostic import CodePage
from cellc.contract.limits import DEFAULTS, MIB

# Each is the whole text of a description, in which a test finds it reported at its mark and nowhere else; or, after
# `$`, what a shell gets beside a sound `cell.yaml`, where the last command reports it.
_EXAMPLES: Mapping[str, str] = {
    "urdf-bad-geometry": """
<robot name="arm">
  <link name="base">
    <collision><geometry><cone radius="1"/></geometry></collision>  <!-- expect -->
  </link>
</robot>
""",
    "urdf-bad-number": """
<robot name="arm">
  <link name="base">
    <inertial>
      <mass value="4 kg"/>  <!-- expect -->
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>
    </inertial>
  </link>
</robot>
""",
    "urdf-missing-attribute": """
<robot name="arm">
  <link/>  <!-- expect -->
</robot>
""",
    "urdf-missing-element": """
<robot name="arm">
  <link name="base"/>
  <joint name="turn" type="revolute"><parent link="base"/></joint>  <!-- expect -->
</robot>
""",
    "urdf-not-a-robot": """
<sdf version="1.7"/>  <!-- expect -->
""",
    "urdf-unknown-joint-type": """
<robot name="arm">
  <link name="base"/>
  <link name="tip"/>
  <joint name="turn" type="rotary"><parent link="base"/> <child link="tip"/></joint>  <!-- expect -->
</robot>
""",
    "urdf-not-expanded": """
<robot name="arm">
  <link name="${prefix}base"/>  <!-- expect -->
</robot>
""",
    "catalogue-entry-invalid": """
$ mkdir arm
$ echo 'kind: robot' > arm/device.yaml
$ sed -i 's#model: .*#model: ./arm#' cell.yaml
$ cellc check cell.yaml
""",
    "xacro-bad-yaml": """
$ echo 'limits: !python 1' > limits.yaml
$ echo '<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">' > arm.xacro
$ echo '<xacro:property name="limits" value="${xacro.load_yaml(&apos;limits.yaml&apos;)}"/>' >> arm.xacro
$ echo '<link name="base${limits}"/></robot>' >> arm.xacro
$ cellc check arm.xacro
""",
    "xacro-failed": """
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="${prefix}base"/>  <!-- expect -->
</robot>
""",
    "xacro-file-not-found": """
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="gripper.xacro"/>  <!-- expect -->
</robot>
""",
    "xacro-missing-argument": """
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="$(arg side)_base"/>  <!-- expect -->
</robot>
""",
    "xacro-not-text": """
$ printf '<robot name="caf\\351"/>' > arm.xacro
$ cellc check arm.xacro
""",
    "xacro-outside-root": """
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="/opt/arm.xacro"/>  <!-- expect -->
</robot>
""",
    "xacro-package-not-found": """
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="$(find arm_description)/urdf/arm.xacro"/>  <!-- expect -->
</robot>
""",
    "xacro-refused-expression": """
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="${().__class__}"/>  <!-- expect -->
</robot>
""",
    "xacro-refused-substitution": """
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="$(env USER)_base"/>  <!-- expect -->
</robot>
""",
    "xacro-too-large": """
$ echo '<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">' > arm.xacro
$ echo '<xacro:macro name="finger"><xacro:finger/></xacro:macro><xacro:finger/></robot>' >> arm.xacro
$ cellc check arm.xacro
""",
    "xacro-unknown-argument": """
$ echo '<robot name="arm"><link name="base"/></robot>' > arm.xacro
$ cellc import arm.xacro side:=left
""",
    "xacro-warning": """
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">  <!-- expect -->
  <xacro:property name="pi" value="3"/>
</robot>
""",
    "xml-entities": """
<!DOCTYPE robot [<!ENTITY arm "arm">]>  <!-- expect -->
<robot name="arm"/>
""",
    "xml-not-well-formed": """
<robot name="arm">
  <link name="base">
</robot>  <!-- expect -->
""",
    "xml-too-deep": """
$ (echo '<robot name="arm">'; seq -f '<link%.0f>' 100) > arm.urdf
$ cellc check arm.urdf
""",
}


def _page(code: str, title: str, why: str, fix: str, severity: Severity = Severity.ERROR) -> CodePage:
    return CodePage(code, severity, title, why, fix, _EXAMPLES.get(code, ""))


_XML = (
    _page(
        "xml-entities",
        "a description declares a document type",
        "A document type can define entities that expand to gigabytes or pull in files of the machine. No robot "
        "description needs one.",
        "remove the `<!DOCTYPE …>` declaration",
    ),
    _page(
        "xml-not-well-formed",
        "a description is not well-formed XML",
        "No tool can read it: a tag is not closed, an attribute has no quotes, or the file is something else.",
        "close or quote what the message names",
    ),
    _page(
        "xml-too-deep",
        f"elements are nested deeper than {DEFAULTS.xml_depth} levels",
        "A robot description nests five or six levels; deeper files exhaust the stack of the parser.",
        "check that the file is a robot description",
    ),
    _page(
        "xml-too-large",
        f"a description is larger than {DEFAULTS.xml_bytes // MIB} MiB",
        "A description of text is a few hundred kilobytes. More is a mesh or a mistake.",
        "keep meshes in files of their own",
    ),
)
_URDF = (
    _page(
        "urdf-bad-geometry",
        "a geometry holds no shape, several, or one that URDF does not know",
        "Parsers skip such a shape, and the link is then invisible to collision checking.",
        "write one of `box`, `cylinder`, `sphere` or `mesh`",
    ),
    _page(
        "urdf-bad-number",
        "a number is malformed, not finite, or the count of numbers is wrong",
        "Parsers of robot descriptions read `nan`, `1,5` or a missing third number differently, some silently as zero.",
        "write finite numbers with a decimal point, in m, kg and rad",
    ),
    _page(
        "urdf-missing-attribute",
        "an element lacks an attribute that URDF demands",
        "The element cannot be bound to anything; most parsers refuse the whole file with one line on stderr.",
        "add the attribute",
    ),
    _page(
        "urdf-missing-element",
        "an element lacks a child that URDF demands",
        "A joint without a parent or an inertia without a mass has no meaning; parsers refuse the whole file.",
        "add the element",
    ),
    _page(
        "urdf-not-a-robot",
        "the root element is not `<robot>`",
        "The file is XML of another kind: a launch file, an SDF world, an SRDF fragment.",
        "name a URDF or xacro file whose root is `<robot>`",
    ),
    _page(
        "urdf-not-expanded",
        "a URDF still holds xacro elements, or texts that are yet to be expanded",
        "Consumers of URDF ignore elements that they do not know, so whatever the macros hold would be missing "
        "from the robot; `${…}` and `$(…)` would be evaluated on the host that starts the cell.",
        "name the file `….xacro` so that it is expanded first",
    ),
    _page(
        "urdf-unknown-joint-type",
        "a joint has a type that URDF does not know",
        "Parsers refuse the whole file for it.",
        "use `revolute`, `continuous`, `prismatic`, `fixed`, `floating` or `planar`",
    ),
)
_XACRO = (
    _page(
        "xacro-bad-yaml",
        "a parameter file of a description is not plain YAML",
        "Aliases can expand to far more than the file holds, and other tags can stand for anything.",
        "write plain values, and units as xacro's own tags",
    ),
    _page(
        "xacro-failed",
        "xacro cannot expand the description",
        "The message quotes xacro: an unknown macro, a missing parameter, an expression that fails.",
        "fix the marked line",
    ),
    _page(
        "xacro-file-not-found",
        "a file of a description does not exist or cannot be read",
        "Includes are looked for beside the file that includes them.",
        "check the path and its spelling",
    ),
    _page(
        "xacro-missing-argument",
        "a description needs an argument that has no value",
        "It has no default, so the description cannot be expanded. To be given it needs no `<xacro:arg>`.",
        "give the argument a value, or a default in `<xacro:arg>`",
    ),
    _page(
        "xacro-not-text",
        "a file of a description is not UTF-8 text",
        "It may be a mesh, an archive or text in an old encoding, which other tools would read differently.",
        "save it as UTF-8",
    ),
    _page(
        "xacro-outside-root",
        "a description reaches for a file outside of its folder",
        "What is built must come from what was reviewed. A file elsewhere on the machine is not under review, differs "
        "between machines, and could be a private one. Symbolic links are followed before the place is judged.",
        "copy the file beside the description",
    ),
    _page(
        "xacro-package-not-found",
        "`$(find PACKAGE)` names a package that does not lie beside the spec",
        "Packages installed on the machine are left out on purpose, so that a build depends on nothing that the spec's "
        "folder does not hold. The message lists the folders that were searched.",
        "put the package, or a link-free copy of its description, in one of the folders searched",
    ),
    _page(
        "xacro-refused-expression",
        "an expression does more than compute a value",
        "xacro evaluates `${…}` as Python. A description is data: attributes with underscores, lambdas, `format`, "
        "huge numbers, texts and lists, and what depends on the run are refused, so that no description can run a "
        "program or exhaust the machine.",
        "use numbers, texts, lists and the functions that xacro documents",
    ),
    _page(
        "xacro-refused-substitution",
        "`$(…)` asks for the environment or the current folder",
        "The same description would then give different robots on different machines. `$(optenv NAME DEFAULT)` is read "
        "as its default, with a warning.",
        "use `$(arg NAME)`, `$(find PACKAGE)`, `$(dirname)` or `${…}`",
    ),
    _page(
        "xacro-too-large",
        "an expansion does not end within its bounds",
        f"At most {DEFAULTS.xacro_includes} nested includes, {DEFAULTS.xacro_macros} nested macros, "
        f"{DEFAULTS.xacro_elements} elements, {DEFAULTS.xml_bytes // MIB} MiB and "
        f"{DEFAULTS.xacro_seconds} s of a processor. More is a macro or an include that calls itself.",
        "look for a macro or an include that calls itself",
    ),
    _page(
        "xacro-unknown-argument",
        "a value is given for an argument that the description does not declare",
        "xacro would ignore it without a word, and the robot would silently be the default one.",
        "remove it, or name one that the description declares",
    ),
    _page(
        "xacro-warning",
        "xacro warns while it expands the description",
        "Xacro warns of attributes and children that it ignores, of a symbol that is defined twice, of an include "
        "whose pattern matches no file, and where the description itself calls `xacro.warning`. The expansion goes on, "
        "and so does every tool behind it: what was meant may be missing from the robot, or come from the other "
        "definition.",
        "fix what the message names",
        Severity.WARNING,
    ),
)
_CATALOGUE = (
    _page(
        "catalogue-entry-invalid",
        "a `device.yaml`, or the file of its family, is not what the catalog expects",
        "Everything derived from the device rests on it: joints, interfaces, versions, limits.",
        "fix the marked value; CONTRIBUTING.md shows how to describe a device",
    ),
)

CODES: tuple[CodePage, ...] = (*_CATALOGUE, *_URDF, *_XACRO, *_XML)
