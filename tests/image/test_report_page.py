#!/usr/bin/python3
"""A quick run of report/make_report.py, and check_numbers.py on what it wrote.

usage: test_report_page.py ETENDUE ROOT OUT
"""
import subprocess
import sys
from pathlib import Path

etendue, root, out = sys.argv[1:]
report = Path(root) / "report"
subprocess.run(["/usr/bin/python3", report / "make_report.py", "--etendue", etendue, "--scenes",
                Path(root) / "scenes/ex3", "--out", out, "--threads", "1", "--quick"], check=True)
files = {name: (Path(out) / name).stat().st_size for name in ("index.html", "report.pdf", "readme.pdf")}
assert files["report.pdf"] == files["readme.pdf"] > 100_000, files
sys.exit(subprocess.run(["/usr/bin/python3", report / "check_numbers.py", out], check=False).returncode)
