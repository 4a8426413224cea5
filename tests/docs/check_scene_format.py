#!/usr/bin/env python3
"""Holds the tables of docs/scene_format.md against `etendue info --json`; prints what differs and exits 1.

usage: check_scene_format.py ETENDUE PAGE   compare the page with what the program says of itself
       check_scene_format.py --self-test     plant one difference of each kind and see it found

Compared: every plugin of every family, every parameter of it, its type, default and unit; and what the integrators'
names stand for, which a render of one pixel tells. In the page a family is a heading `## Name` (`## Two
words` for `two_words`), a plugin in it `### `name``, its parameters a table `| parameter | type | default | unit |
meaning |`. Under an integrator that is another name of one, that one is named. A row of the table of dialects (its head
has all their names) that names integrators first names, first in each other cell, what they stand for there. Other
words may be any.
"""

import copy
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

FAMILIES = ["integrators", "light_samplers", "samplers", "cameras", "filters", "shapes", "bsdfs", "textures", "media",
            "phases", "lights", "tests"]
HEAD = ["parameter", "type", "default", "unit", "meaning"]
DIALECTS = ["nori-2012", "nori-eth", "nori"]
SCENE = """<scene><integrator type="{}"/>
<camera type="perspective"><integer name="width" value="1"/><integer name="height" value="1"/></camera>
<shape type="sphere"><emitter type="area"/></shape></scene>"""


def plugins_of_page(text):
    """{(family, plugin): {parameter: (type, default, unit)}}, and a list of what is written twice."""
    found, twice = {}, []
    family = plugin = None
    is_in_table = False
    for line in text.splitlines():
        if line.startswith("## "):
            name = line[3:].strip().lower().replace(" ", "_")
            family, plugin = (name if name in FAMILIES else None), None
        elif family and (heading := re.fullmatch(r"### `([^`]+)`\s*", line)):
            plugin = (family, heading[1])
            if plugin in found:
                twice.append(f"{family}: '{heading[1]}' has two headings")
            found[plugin] = {}
        cells = cells_of(line) if line.startswith("|") else []
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


def cells_of(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def quoted(text):
    """The names in `quotes`."""
    return re.findall(r"`([^`]+)`", text)


def compare_meanings(text, meanings):
    """A line for each integrator's name that the page says to stand for another than it does.
    `meanings`: {name: {dialect: the integrator that it stands for}}."""
    differences, stated, sections = [], {}, {}
    dialects = family = name = None
    for line in text.splitlines():
        if line.startswith("## "):
            family, name = line[3:].strip().lower(), None
        elif family == "integrators" and (heading := re.fullmatch(r"### `([^`]+)`\s*", line)):
            name = heading[1]
        elif name:
            sections.setdefault(name, []).extend(quoted(line))
        if not line.startswith("|"):
            dialects = None
            continue
        head, *rest = cells_of(line)
        if sorted(found[0] for cell in rest if (found := quoted(cell))) == sorted(DIALECTS):
            dialects = [quoted(cell)[0] for cell in rest]
        elif dialects:
            for integrator in quoted(head):
                if integrator in meanings:
                    stated[integrator] = dict(zip(dialects, (next(iter(quoted(cell)), "") for cell in rest)))
    for integrator, there in sorted(meanings.items()):
        means = set(there.values())
        if len(means) > 1 and integrator not in stated:
            differences.append(f"integrators: '{integrator}' is missing from the table of dialects")
        for dialect, here in stated.get(integrator, {}).items():
            if here != there[dialect]:
                differences.append(f"integrators: in {dialect} '{integrator}' stands for '{there[dialect]}', "
                                   f"not '{here}'")
        for canonical in means - {integrator} - set(sections.get(integrator, [])):
            differences.append(f"integrators: '{integrator}' stands for '{canonical}', which its section does not name")
    return differences


def meanings_of_program(etendue, info):
    """{name: {dialect: what --stats calls the integrator}}, of those that need no parameters."""
    with tempfile.TemporaryDirectory() as name:
        scene, stats = Path(name) / "scene.xml", Path(name) / "stats.json"

        def meaning(integrator, dialect):
            scene.write_text(SCENE.format(integrator))
            subprocess.run([etendue, "render", scene, "--dialect", dialect, "--spp", "1", "--stats", stats, "--quiet",
                            "-o", Path(name) / "image.exr"], check=True, capture_output=True)
            return json.loads(stats.read_text())["integrator"]

        return {plugin["name"]: {dialect: meaning(plugin["name"], dialect) for dialect in DIALECTS}
                for plugin in info["integrators"] if not any(p["is_required"] for p in plugin["parameters"])}


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
    ("a plugin missing from a family of two words", PAGE + "## Light samplers\n### `one`\n", INFO | {"light_samplers": [
        {"name": "one", "parameters": []}, {"name": "two", "parameters": []}]}, "light_samplers: 'two' is missing"),
    ("a family of two words", PAGE + "## Light samplers\n### `one`\n",
     INFO | {"light_samplers": [{"name": "one", "parameters": []}]}, None),
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
    ("a family unknown", PAGE, INFO | {"moods": [{"name": "a", "parameters": []}]}, "moods: a family"),
]

MEANINGS_PAGE = """
| what | `nori-2012` | `nori-eth` | `nori` |
|---|---|---|---|
| film x | right | right | left |
| integrators `direct`, `path` | `bsdf` by chance | `all` of `direct` | as `bsdf` |
## Integrators
### `direct`
As `bsdf`, or as `all`.
### `path`
As `all` and `bsdf`.
### `ems`
Another name, of `bsdf`.
"""
DIRECT = {"nori-2012": "bsdf", "nori-eth": "all", "nori": "bsdf"}
MEANINGS = {"direct": DIRECT, "path": DIRECT, "ems": dict.fromkeys(DIALECTS, "bsdf"),
            "bsdf": dict.fromkeys(DIALECTS, "bsdf")}
# The same for what the integrators' names stand for.
PLANTED_MEANINGS = [
    ("no meaning", MEANINGS_PAGE, MEANINGS, None),
    ("another sentence", MEANINGS_PAGE.replace("Another name, of", "Anther nmae off"), MEANINGS, None),
    ("a wrong meaning", MEANINGS_PAGE.replace("| `all` of", "| `light` of"), MEANINGS, "stands for 'all', not 'light'"),
    ("a meaning that is not named", MEANINGS_PAGE.replace("as `bsdf` |", "as before |"), MEANINGS, "'bsdf', not ''"),
    ("an alias of another", MEANINGS_PAGE.replace("of `bsdf`.", "of `all`."), MEANINGS, "'ems' stands for 'bsdf', wh"),
    ("a row missing", MEANINGS_PAGE.replace(", `path` |", " |"), MEANINGS, "'path' is missing from the table"),
    ("no table", MEANINGS_PAGE.replace("`nori-eth`", "nori-eth"), MEANINGS, "'direct' is missing from the table"),
    ("another meaning in the program", MEANINGS_PAGE, MEANINGS | {"path": dict.fromkeys(DIALECTS, "bsdf")},
     "in nori-eth 'path' stands for 'bsdf', not 'all'"),
]


def self_test():
    failures = 0
    cases = [(compare, *case) for case in PLANTED] + [(compare_meanings, *case) for case in PLANTED_MEANINGS]
    for compared, name, page, told, expected in cases:
        found = compared(page, told)
        if any(expected in line for line in found) if expected else not found:
            continue
        failures += 1
        print(f"FAILED {name}: expected {expected!r}, found {found}")
    print(f"{len(cases) - failures} of {len(cases)} planted cases judged rightly")
    return failures


def main(arguments):
    if arguments == ["--self-test"]:
        return 1 if self_test() else 0
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    said = subprocess.run([arguments[0], "info", "--json"], capture_output=True, text=True, check=True)
    info, page = json.loads(said.stdout), Path(arguments[1]).read_text(encoding="utf-8")
    differences = compare(page, info) + compare_meanings(page, meanings_of_program(arguments[0], info))
    for line in differences:
        print(f"{arguments[1]}: {line}")
    print(f"{len(differences)} differences")
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
