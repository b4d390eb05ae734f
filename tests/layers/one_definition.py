"""Fails when two source files may mean different things by one name, without the linker's saying so.

By the one-definition rule (C++20 [basic.def.odr]) templates, inline functions and classes may stand in many translation
units if they are the same in all: the linker takes any one of them. Where they are not, a part of the program runs the
wrong one, or only a build for debugging does, which inlines less. (Of two ordinary functions the linker complains.) So
  - what a .cpp file alone has lies in an anonymous namespace; what it defines for others is declared in a header;
  - code for an instruction set is in one namespace for all files, which HWY_EXPORT looks into: there, and in headers,
    no two files have the same class, the same inline function, or, where one is a .cpp file, templates of one name.
Declarations at the level of namespaces are found by their brackets; what headers make of macros is not seen.

    one_definition.py REPOSITORY
"""

import collections
import pathlib
import re
import sys

FOLDERS = ("api", "base", "bench", "conformance", "runtime", "samples", "spirv_interp", "tests")
# Comments, strings and characters, which may hold brackets; a raw string ends with its own delimiter.
NOISE = re.compile(r'//[^\n]*|/\*.*?\*/|R"([^\s()\\]*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\\n])+\'', re.S)
DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n\\]|\\.|\\\n)*", re.M)
NAMESPACE = re.compile(r'(?:inline )?namespace ?((?:\w|::)*)|extern ""')
MEMBER_INITIALISER = re.compile(r"\)[\w\s]*:(?!:)(?:.*,)? ?[\w:]+(?:<.*>)?$")
TEMPLATE = re.compile(r"template ?<")
TYPE = re.compile(r"(?:alignas\([^()]*\) ?)?(?:struct|class|union|enum(?: class| struct)?) (?:alignas\([^()]*\) ?)?"
                  r"([\w:]+(?:<.*>)?)(?: ?final)?(?: ?:[^:].*)?$")
FUNCTION = re.compile(r"(~?(?:\w|::|<[^<>()]*>)*(?:operator[^(]*(?:\(\))?)?) ?\(")
INLINE = re.compile(r"\b(?:inline|constexpr|consteval|HWY_INLINE|HWY_API)\b")

Definition = collections.namedtuple("Definition", "file line scope name kind parameters")


def without_noise(text):
    def blank(match):
        return ('""' if '"' in match[0][:2] else " ") + "\n" * match[0].count("\n")

    return DIRECTIVE.sub(lambda match: "\n" * match[0].count("\n"), NOISE.sub(blank, text))


def bodies(text):
    """What has a body at namespace level, other than in anonymous namespaces: line, namespace, what stands before it."""
    scopes, parts = [], []  # the namespaces we are in, None for one without a name; the declaration so far
    line, begins, depth, seen = 1, 1, 0, None  # `seen`: what the declaration is, once its body has begun
    for token in re.finditer(r"[{};\n]|[^{};\n]+", text):
        word = token[0]
        line += word == "\n"
        if depth > 0:
            depth += {"{": 1, "}": -1}.get(word, 0)
            if depth == 0:
                parts = [] if seen == "function" else parts + ["{}"]
                seen = None if seen == "function" else seen
            continue
        head = " ".join("".join(parts).split())
        if word == "{":
            namespace = NAMESPACE.fullmatch(head)
            if namespace:
                scopes.append(None if head == "namespace" else namespace[1] or "")
                parts = []
                continue
            depth = 1
            if seen or head.count("(") != head.count(")") or MEMBER_INITIALISER.search(head):
                continue
            seen = "type" if TYPE.match(untemplated(head)) else "function" if ")" in head else "value"
            if seen != "value" and None not in scopes:
                yield begins, "::".join(filter(None, scopes)), head
        elif word in "};":
            if word == "}":
                scopes.pop()
            parts, seen = [], None
        else:
            begins = begins if head else line
            parts.append(word)


def untemplated(head):
    """Without "template <...>" in front, however deep its brackets are."""
    while TEMPLATE.match(head):
        at, depth = head.index("<"), 0
        for at in range(at, len(head)):
            depth += {"<": 1, ">": -1}.get(head[at], 0)
            if depth == 0:
                break
        head = head[at + 1:].lstrip()
    return head


def parameters(head):
    """Their types: each without the name and the default."""
    inside = head[head.index("(") + 1:head.rindex(")")]
    return tuple(re.sub(r"(?<=[\s&*>])\w+(?=(?:\[.*\])?$)", "", each.split("=")[0].strip()).strip()
                 for each in re.split(r",(?![^<(]*[>)])", inside))


def definitions(file, text):
    """Those that the linker would take without a word."""
    for line, scope, head in bodies(text):
        bare = untemplated(head)
        of_template = bare != head
        if of_template and re.match(r"template ?<>", head):
            continue  # a specialisation: as good as its template
        if match := TYPE.match(bare):
            if "::" not in match[1]:
                yield Definition(file, line, scope, match[1], "class", ())
        elif (of_template or INLINE.search(bare)) and not re.search(r"\bstatic\b", bare):
            name = FUNCTION.search(bare)
            if name and name[1] and "::" not in name[1]:
                yield Definition(file, line, scope, name[1], "template" if of_template else "inline function",
                                 parameters(bare[name.start():]))


def undeclared(definition, headers):
    if "HWY_NAMESPACE" in definition.scope:
        return False
    name = re.escape(definition.name)
    pattern = rf"\b(?:struct|class|union|enum(?: class)?) {name}\b" if definition.kind == "class" else rf"\b{name} ?\("
    return re.search(pattern, headers) is None


def alike(a, b):
    """Whether two definitions of one name in two files may be one thing to the linker."""
    if a.file == b.file or a.kind != b.kind:
        return False
    if a.kind == "template" and not (a.file.endswith(".h") and b.file.endswith(".h")):
        return True
    return a.parameters == b.parameters


def findings(root):
    texts = {}
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                texts[path.relative_to(root).as_posix()] = without_noise(path.read_text())
    headers = "\n".join(text for file, text in texts.items() if file.endswith(".h"))
    by_name, wrong = collections.defaultdict(list), []
    for file, text in texts.items():
        for definition in definitions(file, text):
            by_name[definition.scope, definition.name].append(definition)
            if file.endswith(".cpp") and undeclared(definition, headers):
                wrong.append(f"{file}:{definition.line}: {definition.kind} {definition.name} is in no header: it belongs "
                             "in an anonymous namespace")
    for (scope, name), several in by_name.items():
        for at, a in enumerate(several):
            wrong += [f"{b.file}:{b.line}: {b.kind} {scope}::{name} stands in {a.file}:{a.line}, too"
                      for b in several[at + 1:] if alike(a, b)]
    return len(texts), sum(map(len, by_name.values())), wrong


def main():
    files, count, wrong = findings(pathlib.Path(sys.argv[1]))
    if wrong:
        sys.exit("\n".join(wrong))
    if count < 1000:
        sys.exit(f"only {count} definitions seen in {files} files: nothing was checked")
    print(f"{count} definitions in {files} files: each is one of its kind")


if __name__ == "__main__":
    main()
