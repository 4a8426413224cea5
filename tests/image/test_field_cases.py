#!/usr/bin/python3
"""Runs every case of a folder of situations from the field: each subfolder with a run.sh, which takes the program from
ETENDUE and ends with 0 where all is as expected. Skipped (77) unless ETENDUE_CASES names the folder.

usage: test_field_cases.py ETENDUE
"""
import os
import subprocess
import sys
from pathlib import Path

folder = os.environ.get("ETENDUE_CASES")
if not folder:
    print("skipped: ETENDUE_CASES does not name a folder of cases")
    sys.exit(77)
runs = sorted(Path(folder).glob("*/run.sh"))
if not runs:
    sys.exit(f"no case in {folder}: expected folders with a run.sh")
failed = 0
for run in runs:
    done = subprocess.run([run], env={**os.environ, "ETENDUE": sys.argv[1]}, capture_output=True, text=True,
                          errors="replace", check=False)
    print("as expected" if done.returncode == 0 else "WRONG      ", run.parent.name)
    if done.returncode != 0:
        failed += 1
        print(done.stdout + done.stderr)
print(f"{len(runs) - failed} of {len(runs)} cases as expected")
sys.exit(1 if failed else 0)
