#!/usr/bin/env python3
"""Every work that a comment of src/ cites by name and year has an entry in docs/references.bib; exits 1 where one has not.

usage: check_citations.py ROOT         check the project at ROOT
       check_citations.py --self-test  plant citations with and without an entry

A citation is a year behind a name, "et al.", a title in quotes or a comma: "Veach 1997", "Vose (1991)", `M. D. Vose, "A
linear ...", 1991`. An entry fits where it has the year, and its first author's last name stands shortly before.
"""

import pathlib
import re
import sys

COMMENT = re.compile(r'"(?:\\.|[^"\\\n])*"|(?P<comment>(?://[^\n]*\n?[ \t]*)+|/\*.*?\*/)', re.S)
CITATION = re.compile(r"""(?:[A-Z][\w-]+,?|et\sal\.|",?)\s\(?(?P<year>1[89]\d\d|20\d\d)\b""", re.X)
REACH = 260  # characters before the year in which a name must stand: a long title may be between them


def entries_of(bib):
    """[(year, last name of the first author)]"""
    entries = []
    for entry in re.split(r"^@", bib, flags=re.M)[1:]:
        year = re.search(r"\byear\s*=\s*\{(\d+)\}", entry)
        authors = re.search(r"^\s*author\s*=\s*\{(.*)\},\s*$", entry, re.M)
        if not year or not authors:
            raise ValueError(f"references.bib: an entry without author or year: {entry.splitlines()[0]}")
        entries.append((year[1], authors[1].split(" and ")[0].split()[-1]))
    return entries


def uncited(text, entries):
    """(line, citation) for each one without an entry."""
    for match in COMMENT.finditer(text):
        if match["comment"] is None:
            continue
        # Without the comment marks, a citation that goes over a line's end reads on; line numbers are kept.
        comment = re.sub(r"//[/!]?<?|\n[ \t]*", lambda m: " " * (len(m[0]) - m[0].count("\n")) + "\n" * m[0].count("\n"),
                         match["comment"])
        flat = re.sub(r"\s+", " ", comment)
        for cited in CITATION.finditer(flat):
            before = flat[max(0, cited.start("year") - REACH):cited.start("year")]
            if not any(year == cited["year"] and name in before for year, name in entries):
                line = text.count("\n", 0, match.start() + match["comment"].find(cited["year"])) + 1
                yield line, flat[max(0, cited.start("year") - 50):cited.end()].strip()


ENTRIES = [("1997", "Veach"), ("2004", "One")]
# Each: a source text, and the lines of its citations without an entry.
PLANTED = [
    ("// as Veach 1997 says\n", []),
    ("// as Veach 1998 says\n", [1]),
    ("// as Other 1997 says\n", [1]),
    ("int a;  // One (2004)\n", []),
    ("int a;  // Two (2004)\n", [1]),
    ("/// One et al. 2004, \"A title\"\n/// Three 2005\n", [2]),
    ("/// One and\n/// Two\n/// 2004\n", []),
    ("/// T. One, \"A title that is\n/// long\", 2004\n", []),
    ("/// N. Body, \"A title that is\n/// long\", 2004\n", [2]),
    ("int x = 2004;  // from 2004 on, nori-2012, 1997 of them\n", []),
    ("auto s = \"// Other 1997\";\n", []),
]


def self_test():
    failures = 0
    for text, expected in PLANTED:
        found = [line for line, _ in uncited(text, ENTRIES)]
        if found != expected:
            failures += 1
            print(f"FAILED {text!r}: expected {expected}, found {found}")
    print(f"{len(PLANTED) - failures} of {len(PLANTED)} planted cases judged rightly")
    return failures


def main(arguments):
    if arguments == ["--self-test"]:
        return 1 if self_test() else 0
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    root = pathlib.Path(arguments[0])
    entries = entries_of((root / "docs/references.bib").read_text(encoding="utf-8"))
    files = sorted(file for kind in ("*.h", "*.cpp") for file in (root / "src").rglob(kind))
    wrong = [(file, *found) for file in files for found in uncited(file.read_text(encoding="utf-8"), entries)]
    for file, line, citation in wrong:
        print(f"{file}:{line}: no entry in docs/references.bib for '... {citation}'")
    print(f"{len(files)} files, {len(wrong)} citations without an entry")
    return 1 if wrong or not files else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
