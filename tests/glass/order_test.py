#!/usr/bin/env python3
"""What tools write is the same with any number of threads and on every SIMD target: findings, coverage and counters of a
part of the conformance suite, byte by byte. Usage: order_test.py CTS_SUBSET"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SUITE = sys.argv.pop(1)
CASES = ("compute.*:glsl.random_control_flow*:glsl.random_arithmetic*:tessellation.*:geometry.*:"
         "rasterization.random_triangles*:pipeline.random_depth_bounds*")
SETTINGS = {"one thread": {"VITRINE_THREADS": "1"}, "four threads": {"VITRINE_THREADS": "4"},
            "the oldest SIMD target": {"VITRINE_TARGET": "sse4"}}


def outputs(folder, setting):
    """Runs the cases with all tools; what the tools wrote, by file name."""
    files = {"VITRINE_REPORT": folder / "found.json", "VITRINE_COVERAGE": folder / "lines.info",
             "VITRINE_COUNTS": folder / "counts.json"}
    environment = {**os.environ, **setting, "VITRINE_TOOLS": "sanitize,numbers,printf,coverage,count",
                   "VITRINE_COUNT_LINES": "1", "VITRINE_COUNT_DRAWS": "1", "VITRINE_SOURCES": str(folder / "sources"),
                   **{name: str(file) for name, file in files.items()}}
    subprocess.run([SUITE, "--validation=0", f"--fingerprints={folder / 'fingerprints'}", f"--gtest_filter={CASES}"],
                   check=True, capture_output=True, env=environment)
    return {file.name: file.read_bytes().replace(str(folder).encode(), b"FOLDER") for file in files.values()}


class OrderTest(unittest.TestCase):
    def test_outputs_do_not_depend_on_threads_or_simd(self):
        with tempfile.TemporaryDirectory() as folder:
            all_outputs = []
            for number, setting in enumerate(SETTINGS.values()):
                place = pathlib.Path(folder) / str(number)
                place.mkdir()
                all_outputs.append(outputs(place, setting))
        expected = all_outputs[0]
        for name, text in expected.items():
            self.assertGreater(len(text), 1000, f"{name} has next to nothing in it")
        for setting, found in zip(SETTINGS, all_outputs):
            for name, text in found.items():
                self.assertEqual(text, expected[name], f"{name} with {setting}")


if __name__ == "__main__":
    unittest.main()
