"""Every code that reading a spec can report, with its documentation page, and the diagnostic of a code."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.contract.diagnostics import Diagnostic, Related, Severity, Span, YamlPath
from cellc.contract.diagnostics.diagnostic import CodePage
from cellc.contract.limits import DEFAULTS, MIB, option

# Each is the whole text of a file, in which a test finds it reported at its mark and nowhere else; or, after `$`, what
# a shell is told beside a sound `cell.yaml`, where the last command reports it.
_EXAMPLES: Mapping[str, str] = {
    "alias-bomb": """
a: &a [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]
b: &b [*a, *a, *a, *a, *a, *a, *a, *a, *a, *a]
c: &c [*b, *b, *b, *b, *b, *b, *b, *b, *b, *b]
d: &d [*c, *c, *c, *c, *c, *c, *c, *c, *c, *c]
e: &e [*d, *d, *d, *d, *d, *d, *d, *d, *d, *d]
f: [*e, *e, *e, *e, *e, *e, *e, *e, *e, *e]  # expect
""",
    "control-character": """
summary: "the arm\\e[2J of cell 4"  # expect
""",
    "duplicate-key": """
hosts:
  control_pc: {scheduling: preempt_rt}
  control_pc: {scheduling: standard}  # expect
""",
    "empty-file": """
# the arm of cell 4  # expect
""",
    "file-not-found": """
include: hosts.yml  # expect
""",
    "file-too-large": """
$ head -c 3000000 /dev/zero > cell.yaml
$ cellc check cell.yaml
""",
    "file-unreadable": """
$ rm cell.yaml
$ ln -s cell.yaml cell.yaml
$ cellc check cell.yaml
""",
    "include-cycle": """
include: cell.yaml  # expect
""",
    "include-escape": """
include: ../hosts.yaml  # expect
""",
    "include-shape": """
include: {hosts: hosts.yaml}  # expect
""",
    "key-collision": """
$ echo 'include: parts.yaml' > cell.yaml
$ echo 'hosts: {control_pc: {}}' >> cell.yaml
$ echo 'hosts: [control_pc]' > parts.yaml
$ cellc check cell.yaml
""",
    "merge-key": """
slow: &slow {velocity: 50 %}
limits:
  <<: *slow  # expect
""",
    "non-string-key": """
poses:
  1: {manipulator: 0 -90 90 -90 -90 0 deg}  # expect
""",
    "not-a-cell": """
$ printf 'format: 1\\nmodel: my_arm\\n' > device.yaml
$ cellc build device.yaml
""",
    "not-a-file": """
include: .  # expect
""",
    "not-utf8": """
$ printf 'summary: caf\\351\\n' > cell.yaml
$ cellc check cell.yaml
""",
    "not-yaml": """
hosts:
  control_pc: {scheduling: preempt_rt
network: {domain_id: 42}  # expect
""",
    "number-out-of-range": """
rate: 18446744073709551616  # expect
""",
    "recursive-alias": """
steps: &steps [*steps]  # expect
""",
    "root-not-mapping": """
- cell: demo  # expect
""",
    "several-documents": """
cell: demo
---  # expect
cell: other
""",
    "substitution-in-text": """
summary: $(command rm)  # expect
""",
    "tab-indentation": """
hosts:
\tcontrol_pc: {}  # expect
""",
    "too-deep": """
$ printf '%70s%70s' | sed 's/ /[/1; s/ /[/g' > cell.yaml
$ cellc check cell.yaml
""",
    "too-many-includes": """
$ for n in $(seq 40); do echo "include: part$((n + 1)).yaml" > part$n.yaml; done
$ cellc check part1.yaml
""",
    "unknown-alias": """
steps: *home  # expect
""",
    "yaml-tag": """
cell: !!python/object demo  # expect
""",
}


def _page(code: str, title: str, why: str, fix: str) -> CodePage:
    return CodePage(code, Severity.ERROR, title, why, fix, _EXAMPLES.get(code, ""))


CODES: tuple[CodePage, ...] = (
    _page(
        "alias-bomb",
        "aliases expand to far more values than the file holds",
        "An alias means everything that its anchor holds, so nine short lines can mean thousands of millions of values "
        "and fill the memory of any reader. The expanded size is counted before anything is expanded.",
        "write the repeated part once and reference it by name instead of nesting aliases",
    ),
    _page(
        "command-too-long",
        "this spec, or the specs before it, took all the time that one call may take",
        "Each part of a spec has bounds of its own, and they add up: a job of CI would run until it is ended from "
        "outside, with no word on which spec it was. A spec that takes so much by itself is not finished. Where "
        "several take it together, the one that is under way is finished, and no further one is started.",
        "check fewer specs in one call, and look for the one that takes long",
    ),
    _page(
        "control-character",
        "the text holds a character that steers terminals or hides text",
        "Escape sequences, text direction overrides, characters without a width and Unicode line separators make a "
        "reviewer see something else than what the compiler reads. YAML itself forbids most of them, and as an escape "
        "they would reach names and files that are generated. A joiner between letters of a script that needs it, or "
        "between emoji, is no finding.",
        "delete the character",
    ),
    _page(
        "duplicate-key",
        "one key is written twice in a mapping",
        "Most YAML readers silently keep the last one, so that a limit or an address that everybody can see in the "
        "file is not the one in force. The same holds for a key that two included files both write.",
        "delete one of the two, or rename it",
    ),
    _page(
        "empty-file",
        "the file holds no data",
        "An empty file, or one of comments alone, describes no cell; a wrong path or an interrupted save looks the "
        "same.",
        "write a cell spec into it, or let `cellc init` write one that passes",
    ),
    _page(
        "file-not-found",
        "the named file does not exist",
        "Nothing can be read. For an include the path counts from the folder of the file that includes it.",
        "check the path and its spelling",
    ),
    _page(
        "file-too-large",
        "the file is larger than a spec can be",
        f"A cell is a page or two of text. Above {DEFAULTS.spec_bytes // MIB} MiB it is a recording, a mesh or a "
        "mistake, and it is refused before it is read into memory.",
        "name the cell spec itself, and keep recorded or generated data in files of their own",
    ),
    _page(
        "file-unreadable",
        "the operating system does not let the file be read",
        "Permissions, a broken disk or a link that leads to itself; the message has the reason of the system.",
        "make the file readable for the user who runs cellc",
    ),
    _page(
        "include-cycle",
        "a file includes itself, directly or through others",
        "Each of the files would need the other to be complete first.",
        "move the shared part into a third file that includes neither",
    ),
    _page(
        "include-escape",
        "an include, a link, a device or a folder of packages leads out of what belongs to the spec",
        "A spec is reviewed and shipped as one folder. A part from elsewhere on the machine is not under review, "
        "differs between machines, and could pull in a private file. Symbolic links are followed before the "
        "place is judged. Folders of `packages:` may lie elsewhere in the repository of the spec.",
        "move the included file into the folder of the root spec and write a relative path",
    ),
    _page(
        "include-shape",
        "`include` is neither a path nor a list of paths",
        "Includes are relative paths, written as text; nothing else says which file is meant.",
        "write `include: parts/devices.yaml` or a list of such paths",
    ),
    _page(
        "key-collision",
        "two files write different kinds of value under one section",
        "Sections of included files are merged key by key, which only mappings allow; one of two lists or texts would "
        "silently vanish.",
        "write the section in one file, or as a mapping in both",
    ),
    _page(
        "merge-key",
        "`<<` is not part of YAML 1.2",
        "Merge keys copy values that the reader of a line cannot see, and parsers disagree on which value wins.",
        "write the keys out, or move the shared part into a file and `include` it",
    ),
    _page(
        "non-string-key",
        "a key is not text",
        "Keys of a spec are names. An unquoted number, `true` or `null` as a key becomes a value of another type and "
        "never equals the name it was meant to be.",
        "put the key in double quotes",
    ),
    _page(
        "not-a-cell",
        "the file is a device, not a cell",
        "A `device.yaml` says what one device is. A cell says where it is, who commands it and what may stop it; "
        "only a cell is built, shown and rehearsed.",
        "name the spec of a cell, in which `model:` names the folder of the device; `cellc check` takes a device too",
    ),
    _page(
        "not-a-file",
        "the path names a folder, a pipe or a device",
        "A spec is read once, whole, and its text is shown in messages, so it must be a regular file.",
        "name the `.yaml` file itself; `check`, `build` and `format` take a folder for every `cell.yaml` below it",
    ),
    _page(
        "not-utf8",
        "the file is not UTF-8 text",
        "YAML in another encoding, or a binary file, cannot be read without guessing which characters are meant.",
        "save the file as UTF-8",
    ),
    _page(
        "not-yaml",
        "the text is not YAML",
        "The structure of the file breaks off at the marked place, so what follows has no certain meaning.",
        "correct the marked place; indent with spaces and quote text that holds `: `, `#`, brackets or quotes",
    ),
    _page(
        "number-out-of-range",
        "a number does not fit into 64 bits",
        "ROS parameters, JSON and C++ would round or refuse it. Most often it is a serial number or a hash whose "
        "quotes are missing.",
        "put it in double quotes if it is a name, or write a smaller number",
    ),
    _page(
        "recursive-alias",
        "an alias is inside the value that it names",
        "The value would contain itself without end.",
        "write the inner value out",
    ),
    _page(
        "root-not-mapping",
        "the root of the file is not a mapping",
        "A spec and each of its included files is a mapping of sections such as `devices:`.",
        "begin the file with a section name and a colon",
    ),
    _page(
        "several-documents",
        "the file holds more than one YAML document",
        "One file describes one cell; what follows `---` or `...` would be ignored by some readers and win in others.",
        "delete the separator, or move the second document into a file of its own",
    ),
    _page(
        "substitution-in-text",
        "a text holds `${`, `$(` or `$$`",
        "xacro, ros2 launch and shells replace `${…}` and `$(…)` by what they evaluate, so that a text of the spec or "
        "of a device could run a program on the host that starts the cell. No device needs them: link fills in "
        "placeholders such as `{address}` and `{share:PACKAGE}`.",
        "write the value itself, or a placeholder of the catalog",
    ),
    _page(
        "tab-indentation",
        "a line is indented with a tab",
        "YAML forbids tabs in indentation, because editors disagree on their width and with it on what belongs to "
        "what.",
        "replace the tab with spaces",
    ),
    _page(
        "too-deep",
        f"values are nested more than {DEFAULTS.spec_depth} deep",
        "No section of a spec is nested nearly so far; such files are made to exhaust the stack of a parser.",
        "remove brackets or indentation until the structure is that of the spec",
    ),
    _page(
        "too-many-includes",
        f"more than {DEFAULTS.spec_files} files belong to one spec",
        "A cell in so many pieces cannot be reviewed, and a generated chain of includes must end somewhere.",
        "join small files",
    ),
    _page(
        "too-many-values",
        f"the spec holds more than {DEFAULTS.spec_values} values",
        "A cell has some thousands. More is data that belongs beside the spec, and every check would have to walk it.",
        "keep recorded or generated data in files of their own",
    ),
    _page(
        "unknown-alias",
        "an alias names no anchor",
        "`*name` means the value marked `&name` earlier in the same file; anchors do not cross files. Text that "
        "merely begins with `*` needs quotes.",
        "write the anchor before its first use, or quote the text",
    ),
    _page(
        "yaml-tag",
        "a value carries a YAML tag",
        "Tags such as `!!python/object` or `!secret` make the meaning depend on the program that reads the file; the "
        "type of every field is fixed by the spec.",
        "remove the tag",
    ),
)

_PAGES = {page.code: page for page in CODES}


def finding(
    code: str,
    message: str,
    span: Span,
    *,
    path: YamlPath = (),
    advice: str = "",
    limit: str = "",
    related: tuple[Related, ...] = (),
) -> Diagnostic:
    """Return the diagnostic; without ``advice`` its help is the fix from the page of the code.

    Args:
        limit: the row of the table of limits that is exceeded; the help tells how to raise it.

    Raises:
        KeyError: the code has no page.
    """
    page = _PAGES[code]
    help_text = advice or page.fix
    if limit:
        help_text += f"; {option(limit)}"
    return Diagnostic(code, page.severity, message, span, path, help_text, related)
