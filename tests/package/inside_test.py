#!/usr/bin/env python3
"""manifest/pack/inside.py: the compiler's libraries are listed as what dpkg says that they belong to.

usage: inside_test.py ROOT
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else pathlib.Path(".")

# What stands in for a compiler, and for dpkg-query: each package has a version, and libraries belong to installed packages
# that are not those of today's compiler.
COMPILER = """#!/bin/sh
echo "/nowhere/gcc/99/${1#-print-file-name=}"
"""
DPKG_QUERY = """#!/bin/sh
case $1 in
  -W) printf '1.0+%s' "$3" ;;
  -S) case $2 in
        /nowhere/gcc/99/libstdc++.a) echo "libc6:amd64: $2" ;;
        /nowhere/gcc/99/libgcc.a) echo "dpkg: $2" ;;
        *) exit 1 ;;
      esac ;;
esac
"""


class Inside(unittest.TestCase):
    def test_the_compilers_libraries_are_those_of_their_packages(self):
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        for name, text in (("c++", COMPILER), ("dpkg-query", DPKG_QUERY)):
            (folder / name).write_text(text)
            (folder / name).chmod(0o755)
        subprocess.run([sys.executable, "-B", ROOT / "manifest/pack/inside.py", "9.9.9", "86400", "amd64", folder, "", "", folder / "c++"],
                       check=True, env=os.environ | {"PATH": f"{folder}:{os.environ['PATH']}"})
        listed = {package["comment"]: (package["name"], package["versionInfo"])
                  for package in json.loads((folder / "vitrine.spdx.json").read_text())["packages"] if "comment" in package}
        self.assertEqual(listed["GCC's C++ runtime, linked"], ("libc6", "1.0+libc6"))
        self.assertEqual(listed["GCC's support routines, linked"], ("dpkg", "1.0+dpkg"))
        notices = (folder / "NOTICES").read_text()
        self.assertIn("dpkg 1.0+dpkg: GCC's support routines, linked", notices)
        self.assertIn(pathlib.Path("/usr/share/doc/dpkg/copyright").read_text(errors="replace"), notices)


unittest.main()
