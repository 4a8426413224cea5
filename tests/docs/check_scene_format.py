#!/usr/bin/env python3
"""Holds the tables of docs/scene_format.md against `etendue info --json`; prints what differs and exits 1.

usage: check_scene_format.py ETENDUE PAGE   compare the page with what the program says of itself
       check_scene_format.py --self-test     plant one difference of each kind and see it found

Compared: every plugin of every family, every parameter of it, its type, default and unit. In the page a family is a
heading `## Name`, a plugin in it `### `name``, its parameters a table `| parameter | type | default | unit | meaning |`.
"""

import copy
import json
import re
import subprocess
import sys

FAMILIES = ["integrators", "samplers", "cameras", "filters", "shapes", "bsdfs", "textures", "lights", "tests"]
HEAD = ["parameter", "type", "default", "unit", "meaning"]


def plugins_of_page(text):
    """{(family, plugin): {parameter: (type, default, unit)}}, and a list of what is written twice."""
    found, twice = {}, []
    family = plugin = None
    is_in_table = False
    for line in text.splitlines():
        if line.startswith("## "):
            name = line[3:].strip().lower()
            family, plugin = (name if name in FAMILIES else None), None
        elif family and (heading := re.fullmatch(r"### `([^`]+)`\s*", line)):
            plugin = (family, heading[1])
            if plugin in found:
                twice.append(f"{family}: '{heading[1]}' has two headings")
            found[plugin] = {}
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")] if line.startswith("|") else []
        if not cells or not plugin:
            is_in_table = False
        elif cells == HEAD:
            is_in_table = True
        elif is_in_table and not re.fullmatch(r":?-+:?", cells[0]):
            parameter, kind, default, unit = (cell.strip("`") for cell in cells[:4])
            if parameter in found[plugin]:
                twice.append(f"{plugin[0]}: '{parameter}' of '{plugin[1]}' stands in two rows")
            found[plugin][parameter] = (kind, default, unit)
    return found, twice


def plugins_of_program(info):
    """The same from `etendue info --json`."""
    found = {}
    for family in FAMILIES:
        for plugin in info[family]:
            rows = found[family, plugin["name"]] = {}
            for p in plugin["parameters"]:
                default = "required" if p["is_required"] else p["default"] or "none"
                rows[p["name"]] = (p["type"], default, p["unit"])
    return found


def compare(text, info):
    """A line for each difference."""
    page, differences = plugins_of_page(text)
    program = plugins_of_program(info)
    for family in sorted(set(key for key, value in info.items() if isinstance(value, list) and value
                             and "parameters" in value[0]) - set(FAMILIES)):
        differences.append(f"{family}: a family that this test does not know; add it to FAMILIES and to the page")
    for family, name in sorted(program.keys() | page.keys()):
        if (family, name) not in page:
            differences.append(f"{family}: '{name}' is missing from the page")
        elif (family, name) not in program:
            differences.append(f"{family}: the page has '{name}', the program does not")
        else:
            here, there = page[family, name], program[family, name]
            for parameter in sorted(here.keys() | there.keys()):
                of = f"{family}: '{parameter}' of '{name}'"
                if parameter not in here:
                    differences.append(f"{of} is missing from the page")
                elif parameter not in there:
                    differences.append(f"{of} is in the page, but not in the program")
                else:
                    for what, a, b in zip(("type", "default", "unit"), here[parameter], there[parameter]):
                        if a != b:
                            differences.append(f"{of}: the page has the {what} '{a}', the program '{b}'")
    return differences


PAGE = """
## Cameras
### `pinhole`
| parameter | type | default | unit | meaning |
|---|---|---|---|---|
| `fov` | float | `30` | deg | Width |
| `file` | string | required | | Any |
| `toWorld` | transform | none | | Frame |
### `fisheye`
No parameters.
## Other
| parameter | type | default | unit | meaning |
|---|---|---|---|---|
| `not` | a | `plugin` | | |
"""


def parameter(name, kind, default, unit="", is_required=False):
    return {"name": name, "type": kind, "default": default, "unit": unit, "is_required": is_required, "meaning": "."}


INFO = {family: [] for family in FAMILIES} | {"cameras": [
    {"name": "pinhole", "parameters": [parameter("fov", "float", "30", "deg"),
                                       parameter("file", "string", "", is_required=True),
                                       parameter("toWorld", "transform", "")]},
    {"name": "fisheye", "parameters": []}]}


def with_info(change):
    info = copy.deepcopy(INFO)
    change(info["cameras"])
    return info


# Each: what is planted, the page, what the program says, and words of the difference that must be found (None: none).
PLANTED = [
    ("nothing", PAGE, INFO, None),
    ("a plugin missing", PAGE.replace("### `fisheye`", ""), INFO, "'fisheye' is missing"),
    ("a plugin too many", PAGE.replace("## Other", "### `old`\n## Other"), INFO, "the page has 'old'"),
    ("a plugin in another family", PAGE.replace("## Cameras", "## Lights"), INFO, "'pinhole' is missing"),
    ("a plugin twice", PAGE.replace("## Other", "### `fisheye`\n## Other"), INFO, "two headings"),
    ("a parameter missing", PAGE, with_info(lambda c: c[1]["parameters"].append(parameter("r", "float", "1"))),
     "'r' of 'fisheye' is missing"),
    ("a parameter too many", PAGE, with_info(lambda c: c[0]["parameters"].pop(0)), "'fov' of 'pinhole' is in the page"),
    ("a parameter twice", PAGE.replace("| `file`", "| `fov` | float | `30` | deg | Again |\n| `file`"), INFO, "two rows"),
    ("a wrong default", PAGE.replace("`30`", "`31`"), INFO, "default '31', the program '30'"),
    ("a default as if required", PAGE.replace("`30`", "required"), INFO, "default 'required'"),
    ("required, but with a default", PAGE.replace("required", "`a`"), INFO, "the program 'required'"),
    ("a wrong unit", PAGE.replace("deg", "rad"), INFO, "unit 'rad'"),
    ("a unit missing", PAGE.replace("deg", ""), INFO, "unit ''"),
    ("a wrong type", PAGE.replace("| float", "| integer"), INFO, "type 'integer'"),
    ("a family unknown", PAGE, INFO | {"phases": [{"name": "a", "parameters": []}]}, "phases: a family"),
]


def self_test():
    failures = 0
    for name, page, info, expected in PLANTED:
        found = compare(page, info)
        if any(expected in line for line in found) if expected else not found:
            continue
        failures += 1
        print(f"FAILED {name}: expected {expected!r}, found {found}")
    print(f"{len(PLANTED) - failures} of {len(PLANTED)} planted cases judged rightly")
    return failures


def main(arguments):
    if arguments == ["--self-test"]:
        return 1 if self_test() else 0
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    said = subprocess.run([arguments[0], "info", "--json"], capture_output=True, text=True, check=True)
    with open(arguments[1], encoding="utf-8") as page:
        differences = compare(page.read(), json.loads(said.stdout))
    for line in differences:
        print(f"{arguments[1]}: {line}")
    print(f"{len(differences)} differences")
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
