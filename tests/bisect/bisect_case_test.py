#!/usr/bin/env python3
"""What bisect_case.py reads: logs of steps, rows of passes.def, traces and messages of the suite."""
import pathlib
import re
import sys
import unittest

sys.dont_write_bytecode = True
import bisect_case as bisect  # noqa: E402  beside this file

LOG = """something else
vitrine: ir: shader 1, front end
%0:1 = LoadInput  ; %5
StoreOutput %0

vitrine: ir: shader 2, front end
Return

vitrine: ir: shader 1, step 7 (needed), round 2: opt_dce
StoreOutput %0

vitrine: ir: shader 1, final
StoreOutput %0

vitrine: error: another topic
not a part of it
"""


class Bisect(unittest.TestCase):
    def test_steps_of_shaders(self):
        shaders = bisect.read_steps(LOG)
        self.assertEqual([(s.number, s.round, s.name) for s in shaders[1]],
                         [(-1, 0, "front end"), (7, 2, "opt_dce"), (-1, 0, "final")])
        self.assertEqual(shaders[1][0].text, ["%0:1 = LoadInput  ; %5", "StoreOutput %0"])
        self.assertEqual(shaders[2][0].text, ["Return"])
        self.assertEqual(bisect.changed_steps(shaders), {7: [(1, 1)]})

    def test_every_row_of_the_table_is_read(self):
        text = (pathlib.Path(__file__).parents[2] / "spirv/rewrite/passes.def").read_text()
        names = re.findall(r"^VITRINE_PASS\(\w+, \w+, \w+, (\w+),", text, re.MULTILINE)
        self.assertEqual(set(bisect.read_rows()), set(names))

    def test_invocations_of_messages(self):
        def first(case, message):
            return next(bisect.invocations(case, message))
        self.assertEqual(first("glsl.x.vertex/0", "o (R32_UINT 256x1), element 5: device 1"), "vertex:5")
        self.assertEqual(first("glsl.x", "o (R8_UINT 4x4), pixel (3, 2): device 1"), "fragment:3,2")

    def test_values_of_traces(self):
        values = bisect.values(["    3  FAdd              r1 = 40000000 2 <- r0 3f800000 1, u0 3f800000 1  ; %9 line 4",
                                "    4  store_storage     <- r1 40000000 2  set 0 slot 0"])
        self.assertEqual({origin: value for origin, (value, _) in values.items()}, {"%9 line 4": "40000000"})


if __name__ == "__main__":
    unittest.main()
