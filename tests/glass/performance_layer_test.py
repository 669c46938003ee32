#!/usr/bin/env python3
"""A profiler that uses VK_KHR_performance_query (tests/glass/app/meter.cpp) gets the same numbers with the validation layer as
without, and the layer has nothing to say. Usage: performance_layer_test.py METER MANIFEST"""
import os
import pathlib
import subprocess
import sys
import unittest

METER, MANIFEST = sys.argv[-2:] if __name__ == "__main__" else ("", "")
LAYER = pathlib.Path("/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json")


def measure(**environment):
    result = subprocess.run([METER], capture_output=True, text=True, check=False,
                            env={**os.environ, "VK_DRIVER_FILES": MANIFEST, **environment})
    return result.returncode, result.stdout, result.stderr


class PerformanceLayer(unittest.TestCase):
    def test_counters_of_a_dispatch(self):
        code, out, errors = measure()
        self.assertEqual((code, errors), (0, ""), out)
        counters = {name: values.split() for name, values in (line.split(": ") for line in out.splitlines())}
        self.assertEqual(counters["invocations"], ["48"] * 3, "of the dispatch, of the command buffer, copied")
        self.assertEqual(counters["stores"], ["48"] * 3)
        for name, values in counters.items():
            self.assertEqual(len(set(values)), 1, name)

    def test_layer_is_silent(self):
        if not LAYER.exists():
            self.skipTest("the validation layer is missing")
        self.assertEqual(measure(VK_INSTANCE_LAYERS="VK_LAYER_KHRONOS_validation"), measure())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
