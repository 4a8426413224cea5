#!/usr/bin/env python3
"""Files and names that the docs and the demo's page mention are there; exits 1 where one is not.

usage: check_names.py ROOT         check the project at ROOT
       check_names.py --self-test  plant mentions of what is there and of what is not

Looked at is what stands in `backquotes` or <code>:
- a path below a folder of the project, and a C++ or Python file by its name alone, exists;
- `name` in `file`, `name` (`file`), names in the cell next to that of a file in a table: the file declares it;
- any other name with _ or :: or capitals inside occurs somewhere in the code.
"""

import pathlib
import re
import sys

PAGES = ("README.md", "CONTRIBUTING.md", "docs/*.md", "report/template.html.j2", "report/answers.py",
         "report/tables.py")
CODE = ("src", "include", "apps", "tests", "bench", "cmake", "report", "scripts", "scenes")
CODE_FILES = (".h", ".cpp", ".py", ".sh", ".js", ".cmake", ".txt", ".xml", ".in", ".css", ".json", ".j2")
PATH = re.compile(r"(?:src|include|apps|tests|bench|cmake|report|scripts|scenes|docs)/[\w./*-]*")
FILE = re.compile(r"[\w-]+\.(?:h|cpp|py)")
NAME = re.compile(r"~?[A-Za-z_]\w*(?:::~?[A-Za-z_]\w*)*(?:<F>)?(?:\(\))?")
QUOTED = re.compile(r"`([^`\n]+)`|<code>([^<]+)</code>")
IN_FILE = re.compile(r"\x01(\d+)\x01\s+(?:in\s+|\()(?:the\s+\w+\s+)?\x01(\d+)\x01")
# The exercise's own names, and words of other programs
FOREIGN = {"Li", "sampleLights", "samplePosition", "Mesh::samplePosition", "Mesh::pdf", "GROUP_NUMBER",
           "light_integrator.cpp"}


def is_path(token):
    return bool(PATH.fullmatch(token) or FILE.fullmatch(token))


def is_name(token):
    return bool(NAME.fullmatch(token)) and not is_path(token) and token not in FOREIGN and not token.startswith("std::")


def is_telling(token):
    """Whether a name is long enough to be looked for anywhere: foo_bar, Foo::bar, FooBar."""
    return "::" in token or re.search(r"[a-z0-9]_[a-z]|[a-z][A-Z]", token) is not None


class Project:
    def __init__(self, root):
        self.root = root
        files = [f for folder in CODE for f in (root / folder).rglob("*")
                 if f.is_file() and "__pycache__" not in f.parts]
        self.names = {f.name for f in files} | {f.name for f in root.glob("*") if f.is_file()}
        self.text = {f: f.read_text(errors="replace") for f in files if f.suffix in CODE_FILES}
        # what only a check or the page itself says is no proof that the code has it
        pages = {f for pattern in PAGES for f in root.glob(pattern)} | {root / "tests/docs/check_names.py"}
        self.strings = set(re.findall(r'"(\w+)"', "\n".join(self.text.values())))  # such as the integrators' names
        self.words = set(re.findall(r"\w+", "\n".join(t for f, t in self.text.items() if f not in pages)))

    def exists(self, path):
        if FILE.fullmatch(path):
            return path in self.names
        return any(self.root.glob(path.rstrip("/") or "."))

    def file_text(self, path):
        """Text of all files that a path or a bare name may mean."""
        if FILE.fullmatch(path):
            return "\n".join(t for f, t in self.text.items() if f.name == path)
        return "\n".join(t for f, t in self.text.items() if f == self.root / path or (self.root / path) in f.parents)

    def defines(self, name, files):
        """Whether one of the files declares a name or sets a member of that name, rather than only use it; or has it,
        for files that are not C++."""
        last = re.findall(r"\w+", name.removesuffix("<F>"))[-1]
        declared = re.compile(rf"\b(?:struct|class|enum|concept|using|#define)\s+{last}\b"
                              rf"|^\s*(?!return\b|throw\b)(?:[\w:<>,&*\[\]]+\s+)+[&*]*(?:\w+::)*{last}"
                              r"\s*(?:<[^>]*>)?\s*[({=;]"
                              rf"|^\s*{last}(?: = [^;]*)?,\s*(?:/|$)|\b{last},?.*\}};$|\.{last}\s*=[^=]", re.M)
        return any(declared.search(text) if f.endswith((".h", ".cpp")) else self.has(name, text)
                   for f, text in ((f, self.file_text(f)) for f in files))

    def has(self, name, text=None):
        """Whether each part of a name is a word of the text, or of any code."""
        parts = re.findall(r"\w+", name.removesuffix("<F>"))
        if text is None:
            return all(p in self.words for p in parts)
        return all(re.search(rf"\b{p}\b", text) for p in parts)


def problems(page, text, project):
    """(line, what) for each mention of what is not there."""
    tokens = []

    def keep(match):
        tokens.append((match[1] or match[2]).strip())
        return f"\x01{len(tokens) - 1}\x01"

    text = re.sub(r"^```.*?^```|<pre>.*?</pre>", lambda m: "\n" * m[0].count("\n"), text, flags=re.S | re.M)
    marked = QUOTED.sub(keep, text)

    def line(at):
        return marked.count("\n", 0, at) + 1

    for match in re.finditer(r"\x01(\d+)\x01", marked):
        token = tokens[int(match[1])]
        if is_path(token) and token not in FOREIGN and not project.exists(token):
            yield line(match.start()), f"there is no {token}"
        elif is_name(token) and is_telling(token) and not project.has(token):
            yield line(match.start()), f"nothing in the code is called {token}"
    for match in IN_FILE.finditer(marked):
        name, file = tokens[int(match[1])], tokens[int(match[2])]
        if is_name(name) and is_path(file) and project.exists(file) and not project.defines(name, [file]):
            yield line(match.start()), f"{file} declares no {name}"
    for row in re.finditer(r"^\|.*\|$", marked, flags=re.M):
        cells = [[tokens[int(k)] for k in re.findall(r"\x01(\d+)\x01", cell)] for cell in row[0].split("|")[1:-1]]
        files = [t for cell in cells for t in cell if is_path(t) and project.exists(t)]
        for cell, following in zip(cells, cells[1:]):
            if cell and all(is_path(t) and not t.endswith("/") for t in cell):
                for name in filter(is_name, following):
                    if not project.defines(name, files) and name not in project.strings:
                        yield line(row.start()), f"none of the row's files declares {name}"


def check(root):
    project = Project(root)
    found = 0
    for pattern in PAGES:
        for page in sorted(root.glob(pattern)):
            for line, what in problems(page, page.read_text(), project):
                print(f"{page.relative_to(root)}:{line}: {what}")
                found += 1
    return 1 if found else 0


def self_test():
    import tempfile
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        files = {"src/a/one.h": "struct One { int first_thing(); };",
                 "src/a/two.h": "void other_thing();\nvoid more() {\n  return first_thing();\n}"}
        for file, text in files.items():
            (root / file).parent.mkdir(parents=True, exist_ok=True)
            (root / file).write_text(text)
        project = Project(root)
        right = ["`src/a/one.h`", "`one.h`", "`src/a/`", "`One::first_thing` in `src/a/one.h`",
                 "`other_thing()` (`two.h`)", "| 1 | `src/a/one.h` | `One`, `first_thing` |", "`scene.xml`",
                 "`plain`", "<code>first_thing</code>", "`first_thing<F>` in\n<code>one.h</code>", "```\nsrc/a/gone.h `gone_thing`\n```"]
        wrong = ["`src/a/gone.h`", "`gone.h`", "`gone_thing`", "`other_thing` in `src/a/one.h`",
                 "`other_thing` (`one.h`)", "`first_thing` in `src/a/two.h`",
                 "| 1 | `src/a/one.h` | `other_thing` |", "<code>One::gone</code>",
                 "<code>other_thing</code> in\n<code>one.h</code>"]
        bad = [t for t in right if list(problems("page", t, project))] + [
            t for t in wrong if not list(problems("page", t, project))]
    for text in bad:
        print(f"judged wrongly: {text!r}")
    return 1 if bad else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(self_test() if sys.argv[1] == "--self-test" else check(pathlib.Path(sys.argv[1]).resolve()))
