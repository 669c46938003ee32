#!/usr/bin/env python3
"""Checks that every source is laid out as .clang-format says, by Debian 12's clang-format (others differ in details).

usage: format.py SOURCE_FOLDER [--fix]     --fix: lays the files out
Exit status 1 and the places; 77 if that clang-format is missing.
"""
import pathlib
import re
import subprocess
import sys

import style_tool

ROOMS = ["base", "texel", "spirv", "raster", "glass", "icd", "cts-subset", "tests"]


def main():
    root, fix = pathlib.Path(sys.argv[1]), "--fix" in sys.argv[2:]
    name = style_tool.find("clang-format")
    if not name:
        return 77
    files = sorted(p for room in ROOMS for pattern in ("*.h", "*.cpp") for p in (root / room).rglob(pattern))
    run = subprocess.run([name, *(["-i"] if fix else ["--dry-run", "-Werror"]), *files], capture_output=True, text=True)
    places = re.findall(r"^(\S+:\d+):\d+: error", run.stderr, re.MULTILINE)
    for place in places:
        print(f"{pathlib.Path(place).relative_to(root)}: not as .clang-format says")
    if run.returncode and not places:
        print(run.stderr)
    if run.returncode:
        print("to lay them out: tests/structure/format.py . --fix")
    return run.returncode


if __name__ == "__main__":
    sys.exit(main())
