#!/usr/bin/env python3
"""Bad input of tools: names that do not exist, files that cannot be written or read, wrong use of the command. Each is
said once, and the application goes on with the same result.

usage: bad_input_test.py VITRINE MANIFEST APPLICATION
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

VITRINE, MANIFEST, APPLICATION = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:4])
NO_FOLDER, FULL = "No such file or directory", "No space left on device"
# What a tool is asked for, and the variable that names its file.
WRITERS = (("sanitize,printf", "VITRINE_REPORT", "a.json"), ("sanitize,printf", "VITRINE_REPORT", "a.sarif"),
           ("sanitize,printf", "VITRINE_REPORT", "a.txt"), ("coverage", "VITRINE_COVERAGE", "a.info"),
           ("count", "VITRINE_COUNTS", "a.json"), ("timeline", "VITRINE_TIMELINE", "a.json"))
TWO_ROUNDS_WITH_A_FAULT = ("2", "16")


class BadInput(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def run_in_folder(self, *words, **environment):
        return subprocess.run(words, capture_output=True, text=True, cwd=self.folder, check=False,
                              env={**os.environ, "VK_DRIVER_FILES": MANIFEST, "VITRINE_SOURCES": "/dev/null", **environment})

    def said(self, *arguments, **environment):
        """The lines that the driver says; the application ends as without tools."""
        result = self.run_in_folder(APPLICATION, *arguments, **environment)
        self.assertEqual((result.returncode, result.stdout), (0, ""), result.stderr)
        return result.stderr.splitlines()

    def assert_says_once(self, lines, *parts):
        self.assertEqual(len(lines), 1, lines)
        for part in ("vitrine: ", *parts):
            self.assertIn(part, lines[0])

    def test_tools_that_do_not_exist(self):
        lines = self.said("2", VITRINE_TOOLS="no-such-tool")
        self.assert_says_once(lines, "VITRINE_TOOLS: there is no tool 'no-such-tool'; there are sanitize, ")
        lines = self.said("1", VITRINE_TOOLS=",sanitise,printf,,", VITRINE_PRINTF="said.txt")
        self.assert_says_once(lines, "there is no tool 'sanitise'")
        self.assertEqual((self.folder / "said.txt").read_text(), "i is 3\n", "the other tool works")

    def test_folders_that_do_not_exist(self):
        for tools, variable, name in WRITERS:
            with self.subTest(variable + name):
                lines = self.said(*TWO_ROUNDS_WITH_A_FAULT, VITRINE_TOOLS=tools, **{variable: "no/such/" + name})
                self.assert_says_once(lines, "no/such/" + name, f"cannot be written: {NO_FOLDER}")
        lines = self.said("2", VITRINE_PRINTF="no/such/said.txt")
        self.assert_says_once(lines, "VITRINE_PRINTF: ", f"no/such/said.txt' cannot be written: {NO_FOLDER}")
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_folders_in_the_file_s_place(self):
        for tools, variable, name in WRITERS:
            with self.subTest(variable + name):
                (self.folder / name).mkdir(exist_ok=True)
                lines = self.said(*TWO_ROUNDS_WITH_A_FAULT, VITRINE_TOOLS=tools, **{variable: name})
                self.assert_says_once(lines, name, "cannot be written: Is a directory")
        self.assertEqual([file for folder in self.folder.iterdir() for file in folder.iterdir()], [])

    def test_devices_that_are_full(self):
        for tools, variable, name in WRITERS:
            with self.subTest(variable + name):
                lines = self.said(*TWO_ROUNDS_WITH_A_FAULT, VITRINE_TOOLS=tools, **{variable: "/dev/full"})
                self.assert_says_once(lines, "/dev/full", f"cannot be written: {FULL}")
        self.assert_says_once(self.said("2", VITRINE_PRINTF="/dev/full"), f"'/dev/full' cannot be written: {FULL}")
        self.assertTrue(pathlib.Path("/dev/full").is_char_device(), "it stays what it is")

    @unittest.skipIf(os.geteuid() == 0, "root writes everywhere")
    def test_files_that_belong_to_others(self):
        self.folder.chmod(0o555)
        self.addCleanup(self.folder.chmod, 0o755)
        for tools, variable, name in WRITERS:
            with self.subTest(variable + name):
                lines = self.said(*TWO_ROUNDS_WITH_A_FAULT, VITRINE_TOOLS=tools, **{variable: name})
                self.assert_says_once(lines, name, "cannot be written: Permission denied")

    def test_sources_that_are_missing_and_cannot_be_written(self):
        for place in ("/dev/null", "/proc/no-such-folder"):
            lines = self.said("1", VITRINE_TOOLS="coverage", VITRINE_COVERAGE="a.info", VITRINE_SOURCES=place)
            self.assertEqual(lines, [])
            self.assertIn("SF:tests/glass/app/fill.comp\n", (self.folder / "a.info").read_text(), "its name is known")

    def test_other_variables(self):
        lines = self.said("1", VITRINE_PRINTF="said.txt", VITRINE_PRINTF_FILTER="nonsense:x")
        self.assert_says_once(lines, "VITRINE_PRINTF_FILTER: 'nonsense:x' names no invocation; compute:5,0,0")
        for budget in ("nonsense", "-1", "", "99999999999999999999999"):
            self.assertEqual(self.run_in_folder(APPLICATION, VITRINE_SHADER_BUDGET=budget).returncode, 0, budget)

    def test_wrong_use_of_the_command(self):
        """What is wrong is said, and where help is."""
        for words, part in (((), "subcommand is required"), (("no-such-command",), "there is no command 'no-such-command'"),
                            (("run",), "APPLICATION is required"), (("run", "--"), "APPLICATION is required"),
                            (("check", "--no-such-option", "true"), "--no-such-option"),
                            (("check", "--sarif"), "--sarif: 1 required FILE missing"), (("diff", "a"), "AFTER is required"),
                            (("diff", "a", "b"), "a cannot be read"), (("run", "/no/such/program"), NO_FOLDER),
                            (("coverage", "--min-lines", "many", "true"), "--min-lines"),
                            (("count", "--max", "3", "true"), "--max"),
                            (("check", "--tools", ",", "true"), "the tool '' is not there"),
                            (("check", "--tools=no-such-tool", "true"), "the tool 'no-such-tool' is not there")):
            result = self.run_in_folder(VITRINE, *words)
            self.assertEqual((result.returncode, result.stdout), (2, ""), words)
            self.assertIn(part, result.stderr, words)
            self.assertLessEqual(len(result.stderr.splitlines()), 2, result.stderr)

    def test_outputs_of_the_command(self):
        """The application has run; what cannot be written is an error of the command."""
        for words in (("check", "--json"), ("check", "--sarif"), ("coverage", "-o"), ("count", "-o"), ("timeline", "-o")):
            for name, reason in (("no/such/file", NO_FOLDER), ("/dev/full", FULL)):
                with self.subTest(words, name=name):
                    result = self.run_in_folder(VITRINE, *words, name, "--", "sh", "-c", f"{APPLICATION} && echo done")
                    self.assertEqual(result.returncode, 2, result.stderr)
                    self.assertIn("done\n", result.stdout)
                    self.assertIn(f"{name} cannot be written: {reason}", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
