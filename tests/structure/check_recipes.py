#!/usr/bin/env python3
"""Checks that each file that CONTRIBUTING.md's table of recipes names is there and has its recipe; else exits 1.

usage: check_recipes.py ROOT         check the project at ROOT
       check_recipes.py --self-test  plant one violation of each kind and see it found

The table is the one whose head begins "to add"; each row names a file in `quotes`. The file's head, the comment before
its first line of code, has the words "To add".
"""
import pathlib
import re
import sys
import tempfile


def files_of_table(page):
    files, is_in_table = [], False
    for line in page.splitlines():
        if line.startswith("| to add"):
            is_in_table = True
        elif not line.startswith("|"):
            is_in_table = False
        elif is_in_table:
            files += re.findall(r"`([^`]+)`", line)
    return files


def head_of(text):
    """The comment at the beginning, as one line."""
    comment = re.match(r"(?://[^\n]*\n|\n)*", text)[0]
    return " ".join(line.lstrip("/ ") for line in comment.splitlines())


def check(root):
    """A line for each thing that is wrong."""
    files = files_of_table((root / "CONTRIBUTING.md").read_text(encoding="utf-8"))
    if not files:
        return ["CONTRIBUTING.md has no table of recipes"]
    wrong = [f"{name}, which CONTRIBUTING.md names, is not there" for name in files if not (root / name).is_file()]
    wrong += [f"{name}:1: its head has no recipe ('To add ...'), which CONTRIBUTING.md says it has" for name in files
              if (root / name).is_file() and "To add" not in head_of((root / name).read_text(encoding="utf-8"))]
    return wrong


TABLE = "| to add a ... | at |\n|---|---|\n| light | `light.h` |\n\n| other | `absent.h` |\n"
RECIPE = "// Lights.\n//\n// Hot. To\n// add one: write it.\n#pragma once\n"
# Each: what is planted, the page, light.h or None, and words of what must be found (None: nothing).
PLANTED = [
    ("nothing", TABLE, RECIPE, None),
    ("no table", TABLE.replace("to add a", "a"), RECIPE, "no table"),
    ("no file", TABLE, None, "light.h, which"),
    ("no recipe", TABLE, RECIPE.replace("add", "remove"), "light.h:1: its head"),
    ("a recipe that is not at the head", TABLE, "#pragma once\n" + RECIPE, "light.h:1: its head"),
]


def self_test():
    failures = 0
    for name, page, header, expected in PLANTED:
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "CONTRIBUTING.md").write_text(page, encoding="utf-8")
            if header is not None:
                (root / "light.h").write_text(header, encoding="utf-8")
            found = check(root)
        if any(expected in line for line in found) if expected else not found:
            continue
        failures += 1
        print(f"FAILED {name}: expected {expected!r}, found {found}")
    print(f"{len(PLANTED) - failures} of {len(PLANTED)} planted cases judged rightly")
    return failures


def main(arguments):
    if arguments == ["--self-test"]:
        return 1 if self_test() else 0
    if len(arguments) != 1 or arguments[0].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 2
    found = check(pathlib.Path(arguments[0]))
    for line in found:
        print(line)
    print(f"{len(found)} violations")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
