#!/usr/bin/env python3
"""manifest/pack/ci-setup, and the step of action.yml that calls it, with an archive as ./package makes it.

usage: ci_setup_test.py ROOT
"""
import hashlib
import io
import os
import pathlib
import re
import subprocess
import sys
import tarfile
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else pathlib.Path(".")
SETUP = ROOT / "manifest/pack/ci-setup"
MACHINE = os.uname().machine


def manifest_of(machine):
    return f"lib/vitrine/vitrine_icd.{machine}.json"


def pack(path, files):
    with tarfile.open(path, "w:gz") as archive:
        for name, text in files.items():
            entry = tarfile.TarInfo(name)
            entry.size, entry.mode = len(text), 0o755
            archive.addfile(entry, io.BytesIO(text.encode()))


class Setup(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.archive = self.archive_for(MACHINE)
        self.sum = hashlib.sha256(self.archive.read_bytes()).hexdigest()
        self.tree = self.folder / f"tools it has/vitrine/vitrine-9.9.9-{MACHINE}"
        self.github = {name: str(self.folder / name) for name in ("GITHUB_ENV", "GITHUB_PATH", "GITHUB_OUTPUT")}

    def archive_for(self, machine):
        archive, top = self.folder / f"vitrine-9.9.9-{machine}.tar.gz", f"vitrine-9.9.9-{machine}"
        pack(archive, {f"{top}/{manifest_of(machine)}": "{}", f"{top}/bin/vitrine": "#!/bin/sh\necho vitrine 9.9.9\n"})
        return archive

    def run_it(self, *command, **variables):
        plain = {name: os.environ[name] for name in ("PATH", "HOME") if name in os.environ}
        return subprocess.run(command, capture_output=True, text=True, check=False,
                              env=plain | {"RUNNER_TOOL_CACHE": str(self.folder / "tools it has")} | variables)

    def written(self, name):
        path = self.folder / name
        return path.read_text() if path.exists() else ""

    def test_the_next_steps_have_the_driver(self):
        result = self.run_it(SETUP, self.archive, self.sum, **self.github)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        manifest = self.tree / manifest_of(MACHINE)
        self.assertTrue(manifest.is_file())
        self.assertEqual(self.written("GITHUB_ENV"), f"VK_DRIVER_FILES={manifest}\nVK_ICD_FILENAMES={manifest}\n")
        self.assertEqual(self.written("GITHUB_PATH"), f"{self.tree}/bin\n")
        self.assertEqual(self.written("GITHUB_OUTPUT"), f"manifest={manifest}\ncommand={self.tree}/bin/vitrine\n")
        self.assertIn("vitrine 9.9.9", result.stdout)

    def test_the_action_calls_it(self):
        step = re.search(r"      run: \|\n((?: {8}.*\n)+)", (ROOT / "action.yml").read_text()).group(1)
        step = step.replace("ldconfig -p", "echo libvulkan.so.1")  # whether this machine has a loader is another matter
        result = self.run_it("bash", "-e", "-c", step, ARCHIVE=str(self.archive), SHA256=self.sum, GITHUB_ACTION_PATH=str(ROOT), **self.github)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertIn(str(self.tree), self.written("GITHUB_ENV"))

    def test_other_runners_evaluate_what_it_prints(self):
        again = ["bash", "-c", f'eval "$("{SETUP}" "{self.archive}")"; eval "$("{SETUP}" "{self.archive}")"; vitrine; echo "$VK_DRIVER_FILES"']
        result = self.run_it(*again)
        self.assertEqual(result.stdout, f"vitrine 9.9.9\n{self.tree / manifest_of(MACHINE)}\n", result.stderr)

    def test_the_machine_says_which_driver(self):
        (self.folder / "bin").mkdir()
        uname = self.folder / "bin/uname"
        for machine, other in (("x86_64", "aarch64"), ("aarch64", "x86_64")):
            uname.write_text(f"#!/bin/sh\necho {machine}\n")
            uname.chmod(0o755)
            path = {"PATH": f"{uname.parent}:{os.environ['PATH']}"}
            result = self.run_it(SETUP, self.archive_for(machine), **path)
            self.assertIn(f"vitrine-9.9.9-{machine}/{manifest_of(machine)} ", result.stdout, result.stderr)
            result = self.run_it(SETUP, self.archive_for(other), **path)
            self.assertEqual((result.returncode, result.stdout), (1, ""))
            self.assertIn(f"has a driver for another machine than {machine}", result.stderr)

    def test_another_file_than_wanted_changes_nothing(self):
        other = self.folder / "other.tar.gz"
        pack(other, {"something/else": ""})
        text = self.folder / "text.tar.gz"
        text.write_text("not found")
        for archive, wanted, message in ((self.archive, "0" * 64, f"has the SHA-256 {self.sum}"), (other, "", "no driver inside"),
                                         (text, "", "is no archive"), ("/nowhere.tar.gz", "", "there is no"),
                                         ("file:///nowhere.tar.gz", "", "cannot be fetched")):
            with self.subTest(message):
                result = self.run_it(SETUP, archive, wanted, **self.github)
                self.assertNotEqual(result.returncode, 0)
                self.assertIn(message, result.stderr)
                self.assertEqual((self.written("GITHUB_ENV"), self.tree.exists()), ("", False))


unittest.main()
