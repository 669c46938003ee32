#!/usr/bin/env python3
"""manifest/pack/newer-headers with an apt that has nothing, or something else: the build goes on with the installed headers.

usage: newer_headers_test.py SOURCE_FOLDER
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = None

# What stands in for apt-get: knows an archive, and downloads what $DOWNLOAD says.
APT = """#!/bin/sh
case "$*" in
  indextargets*) echo "${SITE-http://archive.invalid/debian}" ;;
  *--print-uris*) ;;
  *update*) [ -n "$REACHED" ] ;;
  *download*) [ -n "$DOWNLOAD" ] && echo "$DOWNLOAD" >"$(echo "$*" | sed 's/.*download //; s/=.*//')_1_all.deb" ;;
esac
"""


class NewerHeaders(unittest.TestCase):
    def run_script(self, wanted, **settings):
        """(exit status, what is told, what is left) with the stand-in, on a system whose own headers are older."""
        with tempfile.TemporaryDirectory() as folder:
            tools, out = pathlib.Path(folder, "bin"), pathlib.Path(folder, "headers")
            tools.mkdir()
            for name, text in (("apt-get", APT), ("dpkg-query", "#!/bin/sh\nprintf 1.3.239.0-1\n")):
                (tools / name).write_text(text)
                (tools / name).chmod(0o755)
            environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", **settings}
            environment.pop("VITRINE_HEADERS", None)
            if wanted is not None:
                environment["VITRINE_HEADERS"] = wanted
            run = subprocess.run([SCRIPT, out], env=environment, capture_output=True, text=True, check=False)
            return run.returncode, run.stdout + run.stderr, sorted(p.name for p in pathlib.Path(folder).iterdir() if p != tools)

    def falls_back(self, reason, **settings):
        status, told, left = self.run_script("newer", **settings)
        self.assertEqual((status, left), (0, []))
        self.assertIn(reason, told)
        self.assertIn("the build takes the installed ones", told)

    def test_nothing_is_done_unasked(self):
        self.assertEqual(self.run_script(None), (0, "", []))
        self.assertEqual(self.run_script("system"), (0, "", []))

    def test_without_an_archive(self):
        self.falls_back("apt knows no Debian archive", SITE="")

    def test_without_a_network(self):
        self.falls_back("cannot be reached")

    def test_without_the_version(self):
        self.falls_back("has no libvulkan-dev", REACHED="1")

    def test_another_file(self):
        self.falls_back("is not the file that was expected", REACHED="1", DOWNLOAD="something")


if __name__ == "__main__":
    SCRIPT = pathlib.Path(sys.argv[1], "manifest/pack/newer-headers").resolve()
    unittest.main(argv=sys.argv[:1])
