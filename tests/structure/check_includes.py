#!/usr/bin/env python3
"""Checks that the source keeps the order of the house; prints file:line: message and exits 1 where it does not.

usage: check_includes.py ROOT        check the project at ROOT
       check_includes.py --self-test  plant one violation of each rule and see it found

The rules (standard library only, so that nothing need be installed to run it):
  order    a file in src/FOLDER includes only from FOLDER or folders before it in FOLDERS, by the path from src/
  xsimd    only src/base/simd.h includes xsimd
  embree   only src/geometry/raycast_embree.cpp includes Embree (bench/ may: it measures the bare library)
  output   nothing in src/ prints or ends the program: that is for apps/
  header   line 1 is a comment that explains the file, #pragma once comes before any code, 150 lines at most
"""

import pathlib
import re
import sys
import tempfile

# scenefile comes early because the plugins of every family state their parameters through it.
FOLDERS = ["base", "stats", "scenefile", "sampler", "image", "film", "geometry", "texture", "bsdf", "medium", "light",
           "lightsampler", "scene", "integrator", "lint", "render", "noritest", "verify", "course"]
TOPS = ["src", "apps", "tests", "bench", "include"]
MAX_HEADER_LINES = 150
XSIMD_HOME = "src/base/simd.h"
EMBREE_HOME = "src/geometry/raycast_embree.cpp"

# A comment, or a literal (raw strings first), so that neither is taken for the other.
COMMENT_OR_LITERAL = re.compile(
    r"""(?P<comment>//(?:\\\n|[^\n])*|/\*.*?\*/)
      |(?P<literal>\bu?8?[LUu]?R"(?P<mark>[^()\s\\]*)\(.*?\)(?P=mark)"
                  |"(?:\\.|[^"\\\n])*"
                  |(?<![0-9A-Fa-f])'(?:\\.|[^'\\\n])+')""", re.S | re.X)
INCLUDE = re.compile(r"""^[ \t]*\#[ \t]*include[ \t]*(?P<open>[<"])(?P<path>[^>"\n]+)[>"]""", re.M | re.X)
OUTPUT = re.compile(
    r"""std::(?:cout|cerr|clog|wcout|wcerr)\b
      |\bfmt::print(?:ln)?\b
      |(?<![\w.>])(?:v?f?printf|f?puts|f?putc|putchar|perror)\s*\(
      |(?<![\w.>])(?:exit|_exit|_Exit|quick_exit|abort)\s*\(""", re.X)


def blank(text, kinds):
    """The text with the comments or literals named in `kinds` blanked out; lines stay where they are."""
    def replace(match):
        if any(match.group(kind) is not None for kind in kinds):
            return re.sub(r"[^\n]", " ", match.group())
        return match.group()
    return COMMENT_OR_LITERAL.sub(replace, text)


def line_of(text, position):
    return text.count("\n", 0, position) + 1


def check_include(path, included, quoted):
    """What is wrong with `path` including `included`, or None."""
    if included.startswith("xsimd") and path != XSIMD_HOME:
        return f"includes <{included}>: only {XSIMD_HOME} knows xsimd; use its types"
    if re.match(r"embree\d*/", included) and path != EMBREE_HOME and not path.startswith("bench/"):
        return f"includes <{included}>: only {EMBREE_HOME} knows Embree; use geometry/'s ray casting"
    if not path.startswith("src/") or not quoted:
        return None
    here, there = path.split("/")[1], included.split("/")[0]
    if there not in FOLDERS:
        return f'includes "{included}": name project files by their path from src/ ("{here}/...")'
    if FOLDERS.index(there) > FOLDERS.index(here):
        return f'includes "{included}": src/{there} is further down than src/{here} (order: {", ".join(FOLDERS)})'
    return None


def check_header(text):
    """(line, message) for each thing wrong with a header."""
    lines = text.splitlines()
    if not lines or not re.match(r"//[/!]?\s*\w", lines[0]):
        yield 1, "a header's first line is a // comment that says what the file is"
    code = [(number, line.strip()) for number, line in enumerate(blank(text, ["comment"]).splitlines(), 1)
            if line.strip()]
    if not code or code[0][1] != "#pragma once":
        yield code[0][0] if code else 1, "#pragma once must come before any other code"
    if len(lines) > MAX_HEADER_LINES:
        yield MAX_HEADER_LINES + 1, (f"a header has {MAX_HEADER_LINES} lines at most, this one {len(lines)}: "
                                     "one concept a file")


def check_file(path, text):
    """(line, message) for each thing wrong with the file; `path` is relative to the project, with slashes."""
    if path.startswith("src/") and path.split("/")[1] not in FOLDERS:
        yield 1, f"belongs to no folder of src/ known here: {', '.join(FOLDERS)}"
        return
    no_comments = blank(text, ["comment"])
    for match in INCLUDE.finditer(no_comments):
        wrong = check_include(path, match["path"], match["open"] == '"')
        if wrong:
            yield line_of(text, match.start()), wrong
    if path.startswith("src/"):
        for match in OUTPUT.finditer(blank(text, ["comment", "literal"])):
            called = match.group().rstrip("( \t\n")
            yield line_of(text, match.start()), f"{called}: only apps/ prints or exits; throw InputError or return"
    if path.endswith(".h"):
        yield from check_header(text)


def check_project(root):
    """(path, line, message) for each violation in the project at `root`, and how many files were read."""
    files = sorted(file for top in TOPS for kind in ("*.h", "*.cpp") for file in (root / top).rglob(kind))
    found = []
    for file in files:
        path = file.relative_to(root).as_posix()
        found += [(path, line, message) for line, message in check_file(path, file.read_text(encoding="utf-8"))]
    return found, len(files)


# Each: the planted file, its text, and the lines where a violation must be found (none: all must pass).
HEADER = "// A thing.\n#pragma once\n"
PLANTED = [
    ("order: further down", "src/bsdf/a.h", HEADER + '#include "base/vec.h"\n#include "light/b.h"\n', [4]),
    ("order: odd spacing", "src/base/a.cpp", '  #  include  "render/b.h"\n', [1]),
    ("order: the last folder from the first", "src/base/a.cpp", '#include "noritest/b.h"\n', [1]),
    ("order: a path not from src/", "src/light/a.cpp", '#include "b.h"\n#include "../base/vec.h"\n', [1, 2]),
    ("order: an unknown folder", "src/utils/a.cpp", "int a;\n", [1]),
    ("order: a file beside the folders", "src/a.cpp", "int a;\n", [1]),
    ("order: upwards is fine", "src/render/a.cpp", '#include "base/vec.h"\n#include "render/b.h"\n', []),
    ("order: apps and tests may include all", "apps/x/a.cpp", '#include "render/b.h"\n#include "c.h"\n', []),
    ("xsimd: in src/", "src/light/a.cpp", "\n#include <xsimd/xsimd.hpp>\n", [2]),
    ("xsimd: in tests/", "tests/unit/a.cpp", '#include "xsimd/xsimd.hpp"\n', [1]),
    ("xsimd: at home", XSIMD_HOME, HEADER + "#include <xsimd/xsimd.hpp>\n", []),
    ("embree: version 4", "src/geometry/a.cpp", "#include <embree4/rtcore.h>\n", [1]),
    ("embree: in apps/", "apps/x/a.cpp", "#include <embree3/rtcore.h>\n", [1]),
    ("embree: at home", EMBREE_HOME, "#include <embree3/rtcore.h>\n", []),
    ("embree: in bench/", "bench/a.cpp", "#include <embree3/rtcore.h>\n", []),
    ("output: streams", "src/base/a.cpp", "void f() {\n  std::cout << 1;\n  std::cerr << 2;\n}\n", [2, 3]),
    ("output: C", "src/base/a.cpp", 'int a = printf("x");\nint b = std::fprintf(stderr, "y");\n', [1, 2]),
    ("output: fmt", "src/base/a.cpp", 'void f() { fmt::print("x"); }\n', [1]),
    ("output: exit", "src/base/a.cpp", "void f() { std::exit(1); }\nvoid g() { abort(); }\n", [1, 2]),
    ("output: after a literal with quotes", "src/base/a.cpp",
     "char q = '\"';\nauto r = R\"(\" // )\";\nint k = 1'000; void f() { exit(1); } char c = 'c';\n", [3]),
    ("output: words in comments and literals", "src/base/a.cpp",
     '// printf(1)\n/* std::cout\n exit(1) */\nauto s = "exit(1) \\" printf(";\nauto r = R"x(abort()")x";\n', []),
    ("output: other names", "src/base/a.cpp", 'int n = std::snprintf(b, 8, "");\nint e = ray.exit(1) + on_exit(2);\n',
     []),
    ("output: apps may", "apps/x/a.cpp", "int main() { std::cout << 1; std::exit(0); }\n", []),
    ("header: no comment", "src/base/a.h", "#pragma once\nint a;\n", [1]),
    ("header: an empty comment", "src/base/a.h", "//\n#pragma once\n", [1]),
    ("header: no pragma", "src/base/a.h", "// A thing.\n\n#include <vector>\n", [3]),
    ("header: pragma too late", "tests/a.h", "// A thing.\n#include <vector>\n#pragma once\n", [2]),
    ("header: empty", "src/base/a.h", "", [1, 1]),
    ("header: too long", "apps/x/a.h", HEADER + "int a;\n" * 149, [151]),
    ("header: just short enough", "apps/x/a.h", HEADER + "int a;\n" * 148, []),
]


def self_test():
    """The number of planted violations that were not found as they should be."""
    failures = 0
    for name, path, text, lines in PLANTED:
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / path
            file.parent.mkdir(parents=True)
            file.write_text(text, encoding="utf-8")
            found, _ = check_project(pathlib.Path(folder))
        expected = [(path, line) for line in lines]
        if [(where, line) for where, line, _ in found] != expected:
            failures += 1
            print(f"FAILED {name}: expected {expected}, found {found}")
    print(f"{len(PLANTED) - failures} of {len(PLANTED)} planted cases judged rightly")
    return failures


def main(arguments):
    if arguments == ["--self-test"]:
        return 1 if self_test() else 0
    if len(arguments) != 1 or arguments[0].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 2
    root = pathlib.Path(arguments[0])
    found, count = check_project(root)
    for path, line, message in found:
        print(f"{root / path}:{line}: {message}")
    if count == 0:
        print(f"{root}: no source files found: is this the project's root?")
        return 1
    print(f"{count} files, {len(found)} violations")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
