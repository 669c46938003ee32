#!/usr/bin/env python3
"""Cases of the conformance suite have the same bytes in whatever order their invocations run, and however late queues begin: a hash of
each case, with several seeds, against the usual order. Usage: shake_suite_test.py [--all] CTS_SUBSET MANIFEST; --all: all default cases,
20 seeds"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ALL = "--all" in sys.argv
SUITE, MANIFEST = (str(pathlib.Path(path).resolve()) for path in sys.argv[-2:])
CASES = [] if ALL else ["--gtest_filter=compute.*:glsl.narrow*:pointers.*:subgroups.*:workgroup*:image_load_store.*:transform_feedback.*"]
SEEDS = range(1, 21) if ALL else (1, 7, 20)


def hashes(folder, seed):
    file = pathlib.Path(folder) / f"{seed}.txt"
    environment = {**os.environ, "CTS_ICD": MANIFEST, "VK_DRIVER_FILES": MANIFEST}
    if seed:
        environment["VITRINE_SHAKE"] = f"{seed},order,delays"
    subprocess.run([SUITE, "--validation=0", "--isolate", "--jobs=2", f"--fingerprints={file}", *CASES], check=True, capture_output=True,
                   env=environment, cwd=folder)
    return dict(line.split(maxsplit=1) for line in file.read_text().splitlines())


class ShakeSuite(unittest.TestCase):
    def test_no_case_depends_on_order(self):
        with tempfile.TemporaryDirectory() as folder:
            usual = hashes(folder, 0)
            self.assertGreater(len(usual), 100)
            for seed in SEEDS:
                shaken = hashes(folder, seed)
                self.assertEqual([name for name in usual if shaken.get(name) != usual[name]], [], f"seed {seed}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
