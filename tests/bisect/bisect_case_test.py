#!/usr/bin/env python3
"""Of what bisect_case.py reads: logs of steps, rows of passes.def, traces and messages of the suite."""
import contextlib
import io
import pathlib
import re
import sys
import unittest

sys.dont_write_bytecode = True
import bisect_case as bisect  # noqa: E402  beside this file
import logs  # noqa: E402

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

TWO_RESULTS = """Failed
  t7 (R32_UINT 4x1), element 3: device 00000000 (0), reference 01000000 (1); 1 of 4 differ
  pictures: t7.*.png
  t10 (R32_UINT 4x1), element 0: device 02000000 (2), reference 03000000 (3); int t10 = 2; 4 of 4 differ
[  FAILED  ] glsl.x
"""

# What it is a trace of, a line that is not needed, a register that is written twice, a store of another value.
TRACE = """vitrine: trace: compute 1,0,0 (workgroup 0,0,0, lane 1)
preamble
    0  IAdd              u9 = 00000007 7 <- u1 00000003 3, u2 00000004 4  ; %1
code
    0  FAdd              r1 = 40000000 2 <- r0 3f800000 1, r0 3f800000 1  ; %2
    1  FMul              r2 = 40800000 4 <- r1 40000000 2, r1 40000000 2  ; %3
    2  IAdd              r1 = 0000000e 14 <- u9 00000007 7, u9 00000007 7  ; %4
    3  Select            r3 = 0000000e 14 <- m0 1, r1 0000000e 14, r9 00000000 0  ; %5
    4  store_storage     <- r0 00000040 64, r2 40800000 4, r3 0000000e 14  set 0 slot 4
    5  store_storage     <- r0 00000040 64, r2 40800000 4, r2 40800000 4  set 0 slot 4 +64"""


class Bisect(unittest.TestCase):
    def test_steps_of_shaders(self):
        shaders = logs.read_steps(LOG)
        self.assertEqual([(s.number, s.round, s.name) for s in shaders[1]],
                         [(-1, 0, "front end"), (7, 2, "opt_dce"), (-1, 0, "final")])
        self.assertEqual(shaders[1][0].text, ["%0:1 = LoadInput  ; %5", "StoreOutput %0"])
        self.assertEqual(shaders[2][0].text, ["Return"])
        self.assertEqual(logs.changed_steps(shaders), {7: [(1, 1)]})

    def test_a_driver_that_logs_no_steps_is_refused(self):
        class Silent(bisect.Suite):
            def run(self, more=(), **environment):
                return "", "MESA: something else\n"
        told = io.StringIO()
        with contextlib.redirect_stderr(told), self.assertRaises(SystemExit) as stop:
            Silent(pathlib.Path("build"), "glsl.x", ["--seed=1"]).shaders(("--icd=/other.json",))
        self.assertEqual(stop.exception.code, 2)
        self.assertIn("--icd=/other.json wrote no steps of a shader", told.getvalue())

    def test_every_row_of_the_table_is_read(self):
        text = (pathlib.Path(__file__).parents[2] / "spirv/rewrite/passes.def").read_text()
        names = re.findall(r"^VITRINE_PASS\(\w+, \w+, \w+, (\w+),", text, re.MULTILINE)
        self.assertEqual(set(logs.read_rows()), set(names))

    def test_invocations_of_messages(self):
        def first(case, message):
            return next(logs.invocations(case, message))
        self.assertEqual(first("glsl.x.vertex/0", "o (R32_UINT 256x1), element 5: device 1"), "vertex:5")
        self.assertEqual(first("glsl.x", "o (R8_UINT 4x4), pixel (3, 2): device 1"), "fragment:3,2")

    def test_values_of_traces(self):
        values = logs.values(["    3  FAdd              r1 = 40000000 2 <- r0 3f800000 1, u0 3f800000 1  ; %9 line 4",
                                "    4  store_storage     <- r1 40000000 2  set 0 slot 0"])
        self.assertEqual({origin: value for origin, (value, _) in values.items()}, {"%9 line 4": "40000000"})

    def test_judgement_of_one_of_several_results(self):
        self.assertEqual(logs.judgement(TWO_RESULTS)[0], 1)
        self.assertEqual(logs.result_of(logs.judgement(TWO_RESULTS)[1]), "t7")
        self.assertEqual(logs.judgement(TWO_RESULTS, "t10")[0], 4)
        self.assertIsNone(logs.judgement(TWO_RESULTS, "t1"))
        self.assertIsNone(logs.judgement("[       OK ] glsl.x"))

    def test_judgement_without_texels(self):
        self.assertEqual(logs.judgement("Failed\n  device: VK_ERROR_DEVICE_LOST\n[  FAILED  ] glsl.x"),
                         (1, "device: VK_ERROR_DEVICE_LOST"))
        self.assertIsNone(logs.result_of("device: VK_ERROR_DEVICE_LOST"))

    def test_slice_of_a_trace(self):
        def kept(message):
            return [int(line.split()[0]) for line in logs.slice_of(TRACE.splitlines(), message)]
        self.assertEqual(kept("o (R32G32_UINT 9x1), element 1: device 000080400e000000 (1, 2), "
                              "reference 000080400f000000 (1, 2); 1 of 9 differ"), [0, 2, 3, 4])
        self.assertEqual(kept("o (R32G32_UINT 9x1), element 1: device 000080400e000000 (1, 2), "
                              "reference 000081400e000000 (1, 2); 1 of 9 differ"), [0, 1, 4])
        self.assertEqual(kept("o (R32G32_UINT 9x1), element 1: device 000080400f000000 (1, 2), "
                              "reference 000081400e000000 (1, 2); 1 of 9 differ"), [])

    def test_lines_of_an_origin(self):
        steps = logs.read_steps(LOG)[1]
        self.assertEqual([(step.name, lines) for step, lines in logs.lines_of("%5", steps)],
                         [("front end", ["%0:1 = LoadInput  ; %5"]), ("opt_dce", [])])
        self.assertEqual(logs.lines_of("%55", steps), [])


if __name__ == "__main__":
    unittest.main()
