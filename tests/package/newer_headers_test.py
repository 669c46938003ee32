#!/usr/bin/env python3
"""The choice of headers: what manifest/pack/newer-headers does with an apt that has them, has nothing, or something else, and
which ones manifest/pack/headers.cmake then takes.

usage: newer_headers_test.py SOURCE_FOLDER
"""
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = SCRIPT = None

# What stands in for apt-get: knows an archive, and downloads what $DOWNLOAD says or a file of the folder $ARCHIVES.
APT = """#!/bin/sh
case "$*" in
  indextargets*) echo "${SITE-http://archive.invalid/debian}" ;;
  *--print-uris*) ;;
  *update*) [ -n "$REACHED" ] ;;
  *download*)
    file=$(echo "$*" | sed 's/.*download //; s/=.*//')_1_all.deb
    if [ -n "$ARCHIVES" ]; then cp "$ARCHIVES/$file" .; else [ -n "$DOWNLOAD" ] && echo "$DOWNLOAD" >"$file"; fi ;;
esac
"""


class NewerHeaders(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.build, self.tools = self.folder / "build", self.folder / "bin"
        self.tools.mkdir()
        self.tool("apt-get", APT)
        self.tool("dpkg-query", "#!/bin/sh\nprintf 1.3.239.0-1\n")

    def tool(self, name, text):
        (self.tools / name).write_text(text)
        (self.tools / name).chmod(0o755)

    def run_script(self, wanted, script=None, **settings):
        """(exit status, what is told, what is in build) with the stand-in, on a system whose own headers are older."""
        environment = {**os.environ, "PATH": f"{self.tools}:{os.environ['PATH']}", **settings}
        environment.pop("VITRINE_HEADERS", None)
        if wanted is not None:
            environment["VITRINE_HEADERS"] = wanted
        run = subprocess.run([script or SCRIPT, self.build / "headers"], env=environment, capture_output=True, text=True, check=False)
        return run.returncode, run.stdout + run.stderr, sorted(p.name for p in self.build.iterdir()) if self.build.exists() else []

    def falls_back(self, reason, **settings):
        for wanted in (None, "newer", None):
            status, told, left = self.run_script(wanted, **settings)
            self.assertEqual((status, left), (0, ["headers.missed"]))
            self.assertIn(reason, told)
            self.assertIn("the build takes the installed ones", told)

    def with_packages(self):
        """(the script with the pins of small packages, the setting of an apt that has them)."""
        pins, archives = {}, self.folder / "archives"
        archives.mkdir()
        for package, file in (("libvulkan-dev", "usr/include/vulkan/vulkan.h"), ("spirv-headers", "usr/lib/not.wanted")):
            tree = self.folder / package
            (tree / file).parent.mkdir(parents=True)
            (tree / file).touch()
            (tree / "DEBIAN").mkdir()
            (tree / "DEBIAN/control").write_text(f"Package: {package}\nVersion: 1\nArchitecture: all\nMaintainer: none\nDescription: none\n")
            made = archives / f"{package}_1_all.deb"
            subprocess.run(["dpkg-deb", "-b", tree, made], check=True, capture_output=True)
            pins[package] = hashlib.sha256(made.read_bytes()).hexdigest()
        pack = self.folder / "pack"
        pack.mkdir()
        text = SCRIPT.read_text()
        for package, sum_ in pins.items():
            text, count = re.subn(rf'"{package} \S+ \S+"', f'"{package} 1 {sum_}"', text)
            self.assertEqual(count, 1)
        (pack / SCRIPT.name).write_text(text)
        (pack / SCRIPT.name).chmod(0o755)
        (pack / "apt-apart.sh").write_text((SCRIPT.parent / "apt-apart.sh").read_text())
        return pack / SCRIPT.name, {"REACHED": "1", "ARCHIVES": str(archives)}

    def test_nothing_is_done_for_the_installed_ones(self):
        self.assertEqual(self.run_script("system", REACHED="1"), (0, "", []))

    def test_what_is_no_choice(self):
        status, told, left = self.run_script("newest")
        self.assertEqual((status, left), (1, []))
        self.assertIn('VITRINE_HEADERS is "newest"', told)

    def test_without_an_archive(self):
        self.falls_back("apt knows no Debian archive", SITE="")

    def test_without_a_network(self):
        self.falls_back("cannot be reached")

    def test_without_the_version(self):
        self.falls_back("has no libvulkan-dev", REACHED="1")

    def test_another_file(self):
        self.falls_back("is not the file that was expected", REACHED="1", DOWNLOAD="something")

    def test_where_they_can_be_had(self):
        script, settings = self.with_packages()
        self.assertEqual(self.run_script(None, script, **settings), (0, "== unpacking Vulkan 1.4's headers\n", ["headers"]))
        self.assertTrue((self.build / "headers/usr/include/vulkan/vulkan.h").exists())
        self.assertFalse((self.build / "headers/usr/lib").exists())
        for wanted in (None, "newer", "system"):
            self.assertEqual(self.run_script(wanted, script), (0, "", ["headers"]))

    def test_a_failure_is_remembered_until_they_are_asked_for(self):
        script, settings = self.with_packages()
        self.run_script(None, script)
        status, told, left = self.run_script(None, script, **settings)
        self.assertEqual((status, left), (0, ["headers.missed"]))
        self.assertIn("of late", told)
        self.assertEqual(self.run_script("newer", script, **settings)[2], ["headers"])

    def test_a_failure_is_forgotten_after_a_day(self):
        script, settings = self.with_packages()
        self.run_script(None, script)
        yesterday = time.time() - 25 * 3600
        os.utime(self.build / "headers.missed", (yesterday, yesterday))
        self.assertEqual(self.run_script(None, script, **settings)[2], ["headers"])

    def test_earlier_ones_stay_where_later_ones_cannot_be_had(self):
        (self.build / "headers").mkdir(parents=True)
        (self.build / "headers/complete").write_text("libvulkan-dev 1 0\n")
        status, told, left = self.run_script(None)
        self.assertEqual((status, left), (0, ["headers", "headers.missed"]))
        self.assertIn("the build takes those that were unpacked before", told)

    def test_a_system_that_is_as_new_needs_no_others(self):
        (self.build / "headers").mkdir(parents=True)
        self.tool("dpkg-query", "#!/bin/sh\nprintf 1.4.309.0-1\n")
        self.assertEqual(self.run_script(None), (0, "", []))


class TakenHeaders(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "CMakeLists.txt").write_text(f"cmake_minimum_required(VERSION 3.25)\nproject(choice LANGUAGES NONE)\n"
                                                    f"include({ROOT}/manifest/pack/headers.cmake)\n"
                                                    "get_directory_property(folders INCLUDE_DIRECTORIES)\n"
                                                    'message(STATUS "folders: ${folders}")\n')

    def configure(self, *options, **settings):
        environment = {key: value for key, value in os.environ.items() if key != "VITRINE_HEADERS"}
        return subprocess.run(["cmake", "-S", self.folder, "-B", self.folder / "out", "-G", "Ninja", *options],
                              env={**environment, **settings}, capture_output=True, text=True, check=False)

    def taken(self, *options, **settings):
        """Whether the unpacked ones are taken: the registry, the include folder and what ./package reads say the same."""
        run = self.configure(*options, **settings)
        self.assertEqual(run.returncode, 0, run.stderr)
        unpacked = self.folder / "build/headers/usr"
        is_there = f"registry: {unpacked}/share/vulkan/registry/vk.xml\n" in run.stdout
        self.assertEqual(f"folders: {unpacked}/include\n" in run.stdout, is_there)
        cache = (self.folder / "out/CMakeCache.txt").read_text()
        self.assertIn(f"VITRINE_HEADERS_ROOT:INTERNAL={unpacked if is_there else ''}\n", cache)
        return is_there

    def unpack(self):
        (self.folder / "build/headers").mkdir(parents=True)
        (self.folder / "build/headers/complete").touch()

    def test_the_unpacked_ones_where_they_are(self):
        self.assertFalse(self.taken())
        self.assertIn("are not there", self.configure("-DVITRINE_HEADERS=newer").stdout)
        self.assertFalse(self.taken("-DVITRINE_HEADERS="))
        self.unpack()
        self.assertTrue(self.taken())
        self.assertTrue(self.taken("-DVITRINE_HEADERS=newer"))

    def test_the_installed_ones_where_they_are_asked_for(self):
        self.unpack()
        self.assertTrue(self.taken())
        self.assertFalse(self.taken("-DVITRINE_HEADERS=system"))
        self.assertFalse(self.taken())
        self.assertTrue(self.taken("-DVITRINE_HEADERS="))

    def test_the_environment_says_it_for_a_new_folder(self):
        self.unpack()
        self.assertFalse(self.taken(VITRINE_HEADERS="system"))

    def test_what_is_no_choice(self):
        run = self.configure("-DVITRINE_HEADERS=newest")
        self.assertNotEqual(run.returncode, 0)
        self.assertIn('VITRINE_HEADERS is "newest"', run.stderr)


if __name__ == "__main__":
    ROOT = pathlib.Path(sys.argv[1]).resolve()
    SCRIPT = ROOT / "manifest/pack/newer-headers"
    unittest.main(argv=sys.argv[:1])
