#!/usr/bin/env python3
"""A stranger's first quarter of an hour: the commands of README.md, docs/ci.md and the archive's README, as they are
printed, with an archive of this build and a project (tests/package/stranger) whose shader has two faults.

usage: stranger_test.py ROOT BUILD

What a runner has and this machine may lack (sudo, apt-get, vkcube) does nothing here, or is the project's test.
"""
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest

BUILD = pathlib.Path(sys.argv.pop(2)).resolve() if len(sys.argv) > 2 else None
ROOT = pathlib.Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else None
MACHINE = os.uname().machine
VERSION = re.search(r"project\(vitrine VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1] if ROOT else ""
NAME = f"vitrine-{VERSION}-{MACHINE}"
# The tree is built by ninja; make need not be there.
GENERATOR = {"CMAKE_GENERATOR": "Ninja"}
# The line of shaders/fill.comp, and what is wrong with it.
LINE, FAULTS = 10, {"vitrine/out-of-bounds-store", "vitrine/uninitialized-variable"}


def section(page, heading):
    """The text of a section, without those below it of the same rank."""
    text = (ROOT / page).read_text()
    found = re.search(rf"^## {heading}\n(.*?)(?=^## |\Z)", text, re.M | re.S)
    return found[1]


def block(text, language):
    """The first block of code in that language."""
    return re.search(rf"^```{language}\n(.*?)^```", text, re.M | re.S)[1]


def list_of(yaml, key):
    """The commands of a list in a job of GitLab's."""
    rows = re.search(rf"^  {key}:\n((?:    - .*\n)+)", yaml, re.M)[1]
    return re.findall(r"^    - (.*)$", rows, re.M)


def runs_of(yaml):
    """The scripts of a job's steps on GitHub, in order."""
    scripts = []
    for indent, lines, line in re.findall(r"^( +)- run: (?:\|\n((?:\1    .*\n)+)|(.*)$)", yaml, re.M):
        scripts.append(line or lines.replace(indent + "    ", ""))
    return scripts


class Stranger(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.shared = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        tree = cls.shared / NAME
        subprocess.run(["cmake", "--install", BUILD, "--prefix", tree], check=True, capture_output=True)
        shutil.copy(BUILD / "pack/README.md", tree)
        cls.archive = cls.shared / f"{NAME}.tar.gz"
        with tarfile.open(cls.archive, "w:gz", compresslevel=1) as packed:
            packed.add(tree, NAME)
        cls.readme = (tree / "README.md").read_text()
        shutil.rmtree(tree)
        cls.project = cls.shared / "project"
        shutil.copytree(ROOT / "tests/package/stranger", cls.project)
        shutil.copy(ROOT / "tests/glass/app/app.cpp", cls.project)
        (cls.project / ".git").mkdir()
        cls.run_shell("cmake -B build && cmake --build build", cls.project, {}).check_returncode()
        cls.tools = cls.shared / "bin"
        cls.tools.mkdir()
        for name, text in (("sudo", '"$@"'), ("apt-get", "exit 0"), ("vkcube", f'exec "{cls.project}/build/my-tests"')):
            (cls.tools / name).write_text(f"#!/bin/sh\n{text}\n")
            (cls.tools / name).chmod(0o755)

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.home = self.folder / "home"
        self.home.mkdir()

    @classmethod
    def run_shell(cls, script, folder, variables):
        """Runs it as the runners do: it ends with the first command that fails."""
        plain = {name: os.environ[name] for name in ("PATH", "HOME", "TMPDIR", "LD_LIBRARY_PATH", "LD_PRELOAD", "LLVM_PROFILE_FILE") if name in os.environ}
        return subprocess.run(["bash", "-e", "-o", "pipefail", "-c", script], cwd=folder, env=plain | GENERATOR | variables, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)

    def shell(self, script, folder=None, path="", **variables):
        there = {"HOME": str(self.home), "PATH": f"{path}{self.tools}:{os.environ['PATH']}"}
        return self.run_shell(script, folder or self.folder, there | variables)

    def clone(self):
        """The project as a job has it: built by nobody yet."""
        clone = self.folder / "clone"
        shutil.copytree(self.project, clone, ignore=shutil.ignore_patterns("build"))
        return clone

    def expect_annotations(self, said):
        rows = re.findall(r"^::error file=([^,]*),line=(\d+),.*?title=([^:]*)::", said, re.M)
        self.assertEqual(set(rows), {("shaders/fill.comp", str(LINE), fault) for fault in FAULTS}, said)

    def steps(self, scripts, folder, variables):
        """The steps of a job on GitHub, which hand on variables and the path; the last result."""
        for name in ("GITHUB_ENV", "GITHUB_PATH"):
            (self.folder / name).touch()
            variables[name] = str(self.folder / name)
        for i, script in enumerate(scripts):
            paths = "".join(f"{line}:" for line in (self.folder / "GITHUB_PATH").read_text().splitlines())
            given = dict(line.split("=", 1) for line in (self.folder / "GITHUB_ENV").read_text().splitlines())
            result = self.shell(script, folder, path=paths, **variables, **given)
            if i + 1 < len(scripts):
                self.assertEqual(result.returncode, 0, result.stdout)
        return result

    @unittest.skipIf(MACHINE != "x86_64", "the page names the archive for x86-64")
    def test_the_readme(self):
        shutil.copy(self.archive, self.folder)
        (self.folder / "my-tests").symlink_to(self.project / "build/my-tests")
        *commands, check = block(section("README.md", "Install"), "sh").splitlines()
        self.assertEqual(len(commands), 2)
        result = self.shell("\n".join(commands))
        self.assertEqual(result.returncode, 0, result.stdout)
        result = self.shell(check)
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn(f"{self.project}/shaders/fill.comp:{LINE}: error: store of 4 bytes", result.stdout)

    def test_the_readme_of_the_archive(self):
        self.assertNotRegex(self.readme, r"@\w+@")
        with tarfile.open(self.archive) as packed:
            packed.extractall(self.folder)
        tree = self.folder / NAME
        (tree / "my-tests").symlink_to(self.project / "build/my-tests")
        run, check, bare = block(self.readme, "sh").splitlines()
        for command, code in (run, 0), (check, 1), (bare, 0):
            result = self.shell(command, tree)
            self.assertEqual(result.returncode, code, result.stdout)
        for path in re.findall(r"`(?:man )?((?:bin|share)/[^ `]*)", self.readme):
            if "doc" not in path:  # those are what ./package adds
                self.assertTrue((tree / path).exists(), path)

    def test_the_job_of_the_archives_readme(self):
        scripts = runs_of(block(self.readme, "yaml"))
        self.assertEqual(len(scripts), 3)
        result = self.steps([script.replace("ARCHIVE", self.archive.as_uri()) for script in scripts], self.clone(), {})
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn("100% tests passed", result.stdout)
        self.expect_annotations(result.stdout)

    def test_the_job_on_github(self):
        action = re.search(r"      run: \|\n((?: {8}.*\n)+)", (ROOT / "action.yml").read_text())[1]
        page = block(section("docs/ci.md", "GitHub"), "yaml")
        self.assertRegex(page, r"uses: OWNER/vitrine@v" + re.escape(VERSION))
        inputs = {"ARCHIVE": str(self.archive), "SHA256": hashlib.sha256(self.archive.read_bytes()).hexdigest(), "GITHUB_ACTION_PATH": str(ROOT),
                  "RUNNER_TOOL_CACHE": str(self.folder / "tools")}
        result = self.steps([action, *runs_of(page)], self.clone(), inputs)
        self.assertEqual(result.returncode, 1, result.stdout)
        self.expect_annotations(result.stdout)

    @unittest.skipIf(MACHINE != "x86_64", "the page names the manifest for x86-64")
    def test_the_job_on_gitlab(self):
        page = block(section("docs/ci.md", "GitLab"), "yaml")
        (self.folder / "opt").mkdir()
        script = "\n".join([*list_of(page, "before_script"), *list_of(page, "script")])
        script = script.replace("ARCHIVE", self.archive.as_uri()).replace("/opt", str(self.folder / "opt"))
        (self.project / "my-tests").symlink_to("build/my-tests")
        result = self.shell(script, self.project, VITRINE_SHA256=hashlib.sha256(self.archive.read_bytes()).hexdigest())
        self.assertEqual(result.returncode, 1, result.stdout)
        report = re.search(r"codequality: (\S+)", page)[1]
        rows = json.loads((self.project / report).read_text())
        self.assertEqual({row["check_name"] for row in rows}, FAULTS)
        self.assertEqual({(row["location"]["path"], row["location"]["lines"]["begin"]) for row in rows}, {("shaders/fill.comp", LINE)})

    @unittest.skipIf(MACHINE != "x86_64", "the page names the archive for x86-64")
    def test_the_container(self):
        lines = block(section("docs/ci.md", "A container"), "dockerfile").splitlines()
        added, folder = re.search(r"ADD (\S+) (\S+)", "\n".join(lines)).groups()
        self.assertEqual((added, folder), (self.archive.name, "/opt/"))
        with tarfile.open(self.archive) as packed:
            packed.extractall(self.folder / "opt")
        variables = next(line for line in lines if line.startswith("ENV ")).removeprefix("ENV ").replace("/opt", str(self.folder / "opt"))
        result = self.shell(f"export {variables}; vitrine --version; {self.project}/build/my-tests; test -f $VK_DRIVER_FILES")
        self.assertEqual((result.returncode, result.stdout), (0, f"vitrine {VERSION}\n"))


if __name__ == "__main__":
    unittest.main()
