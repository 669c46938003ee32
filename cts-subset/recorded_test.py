#!/usr/bin/env python3
"""The suite judges by a record as it does by the reference, and says when a record does not fit.

Records the suite's self-test cases with this device on both sides, so that lavapipe is not needed; then judges by that.
Usage: recorded_test.py CTS_SUBSET MANIFEST_OF_THIS_DEVICE
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SUITE, ICD = sys.argv[1:3]
del sys.argv[1:3]


def run(*arguments, **environment):
    """Status and text of a run."""
    done = subprocess.run([SUITE, f"--icd={ICD}", *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          env={**os.environ, **environment})
    return done.returncode, done.stdout


def total(text):
    return re.sub(" +", " ", text[text.rindex("total "):].split("\n")[0])


class RecordedTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = pathlib.Path(self.folder.name) / "record.txt"
        self.results = f"--results={self.folder.name}"

    def record(self, *arguments):
        return run("--self-test", "--isolate", f"--reference={ICD}", f"--record={self.file}", self.results, *arguments)

    def judge(self, *arguments):
        return run("--self-test", "--isolate", f"--recorded={self.file}", self.results, *arguments)

    def edit(self, pattern, replacement):
        text = self.file.read_text()
        changed = re.sub(pattern, replacement, text, flags=re.M)
        self.assertNotEqual(text, changed)
        self.file.write_text(changed)

    def test_finds_what_the_reference_itself_would_show(self):
        _, live = self.record()
        status, text = self.judge()
        self.assertEqual(status, 1, text)
        self.assertIn("reference: recorded of ", text)
        self.assertIn("FAILED self.one_bit\n  ramp (R32_UINT 4x1) is not as recorded", text)
        self.assertIn("zeros: the reference's output is blank", text)
        self.assertIn("identical_again", self.file.read_text())
        self.assertEqual(total(text), total(live))
        self.assertRegex(total(text), "^total 10 cases 6 identical 0 listed deviation 0 unsupported 3 differing 1 crashed")

    def test_says_that_a_case_is_new(self):
        self.record("--gtest_filter=self.identical*")
        status, text = self.judge("--gtest_filter=self.identical*:self.one_bit")
        self.assertEqual(status, 1, text)
        self.assertRegex(text, "FAILED self.one_bit\n.*has no result of the case\n.*--record --gtest_filter='self.one_bit'")
        self.assertIn("(1 without a record)", total(text))

    def test_says_that_a_case_has_changed(self):
        self.record()
        self.edit("^self.identical - [0-9a-f]*", "self.identical - 00000000")
        status, text = self.judge("--gtest_filter=self.identical")
        self.assertEqual(status, 1, text)
        self.assertIn("it is another case now", text)
        self.assertIn("0 differing 0 crashed (1 changed since", total(text))

    def test_says_that_modules_are_compiled_otherwise(self):
        self.record()
        self.edit("^(self.one_bit - [0-9a-f]*) [0-9a-f]*", r"\1 00000000")
        self.edit("^compiler .*", "compiler glslang 0.0.0")
        _, text = self.judge("--gtest_filter=self.one_bit")
        self.assertRegex(text, "glslang .* makes other modules of its shaders than glslang 0.0.0")

    def test_proves_nothing_by_modules_that_another_cpu_folds_otherwise(self):
        self.record()
        self.edit("^(self.(?:one_bit|identical) - [0-9a-f]*) [0-9a-f]*", r"\1 00000000")
        _, text = self.judge("--gtest_filter=self.one_bit:self.identical")
        self.assertRegex(total(text), "^total 2 cases 1 identical 0 listed deviation 1 unsupported 0 differing")

    def test_a_part_goes_into_the_file(self):
        self.record("--gtest_filter=self.identical*")
        status, text = self.record("--gtest_filter=self.one_bit")
        self.assertEqual(status, 1, text)
        self.assertRegex(text, "recorded: 1 of 6 cases")
        self.edit("^driver .*", "driver Another 1.0")
        status, text = self.record("--gtest_filter=self.one_bit")
        self.assertEqual(status, 2)
        self.assertIn("record all cases anew", text)

    def test_refuses_what_is_not_recorded(self):
        self.record()
        for argument in ("--seed=2", "--mutate"):
            status, text = self.judge(argument)
            self.assertEqual(status, 2, text)
            self.assertIn("--reference=MANIFEST", text)
        status, text = run(f"--recorded={__file__}", "--gtest_filter=self.*")
        self.assertEqual(status, 2)
        self.assertIn("is no record of the reference", text)

    def test_is_taken_where_lavapipe_is_not(self):
        status, text = run("--which-reference", CTS_REFERENCE_ICD="/nowhere.json")
        self.assertEqual(status, 0)
        self.assertRegex(text, r"^recorded of Mesa .*, seed 1, because lavapipe is not installed\n$")
        status, text = run("--which-reference", CTS_REFERENCE_ICD=ICD)
        self.assertRegex(text, "^recorded of Mesa .*, because .* is installed\n$")
        _, text = run("--which-reference", f"--reference={ICD}")
        self.assertRegex(text, "vitrine_icd")


if __name__ == "__main__":
    unittest.main()
