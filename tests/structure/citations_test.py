#!/usr/bin/env python3
"""Tests citations.py on small trees: each citation that leads nowhere must be found, and its correct twin must not."""
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
import citations  # noqa: E402  beside this file

MATH = """# Arithmetic
## 1. Environment
## 4. Rewrites
### 4.1 Rules
### 4.2 More
1. first
2. second
# Part A. Sampling
## A3. Coordinates
"""
ROWS = "| id | what |\n|---|---|\n| float-to-uint | `glsl.deviation.to_uint` |\n| nine-vertices | two |\n"


class Citations(unittest.TestCase):
    def faults(self, files):
        """Of a tree with a document, a table of deviations and these files, without their places."""
        tree = {"docs/math.md": MATH, "cts-subset/deviations.md": ROWS, "base/lanes.h": "// Lanes.\n",
                "cts-subset/cases/a.cpp": '// A case.\nadd("deviation.to_uint");\n', "spirv/exec/chain.h": "// Chains.\n"}
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for place, words in {**tree, **files}.items():
                (root / place).parent.mkdir(parents=True, exist_ok=True)
                (root / place).write_text(words)
            return [fault.split(": ", 1)[1] for fault in citations.faults_of(root)]

    def check(self, words, *faults, place="spirv/exec/x.cpp"):
        self.assertEqual(self.faults({place: words}), list(faults), words)

    def test_documents(self):
        self.check("// See math.md, docs/math.md and deviations.md.\n")
        self.check("// See maths.md.\n", "there is no document maths.md")
        self.check("// See lavapipe/math.md.\n", "there is no document lavapipe/math.md")

    def test_sections(self):
        self.check("// math.md 4.1, 4.2 and A3; math.md section 1; math.md sections 1 and 4; math.md part A\n")
        self.check("// math.md 4.3\n", "docs/math.md has no section 4.3")
        self.check("// math.md 4.1, 4.4\n", "docs/math.md has no section 4.4")
        self.check("// math.md sections 1 and 5\n", "docs/math.md has no section 5")
        self.check("// math.md section\n// 7\n", "docs/math.md has no section 7")
        self.check("// math.md 4.1 to 4.7\n", "docs/math.md has no section 4.7")
        self.check("// math.md part B\n", "docs/math.md has no section B")
        self.check("// math.md 4.1-4.3, of 8-bit numbers\n", "docs/math.md has no section 4.3")

    def test_steps(self):
        self.check("// math.md 4.2 step 2\n")
        self.check("// math.md 4.2 step 3\n", "docs/math.md has no step 3 in section 4.2")

    def test_short_citations(self):
        self.check("// Rules of math.md.\nint a;\n/// One (4.1), another (section 1: all), a step (4.2 step 1).\n")
        self.check("// math.md\nint a;  ///< one (4.8)\n", "docs/math.md has no section 4.8")
        self.check("// math.md\nint a;  // (section 9)\n", "docs/math.md has no section 9")
        self.check("// One (4.1).\n", "4.1: the file names no document above")
        self.check("// In 2.8 ms (2.8 ms!), at (0.5, 0.5), f(1.5), vec2(4.7).\n")

    def test_code_is_no_comment(self):
        self.check('const char* a = "nothing.md // maths.md"; // math.md\nauto b = R"(// maths.md (9.9))";\n')

    def test_effects_of_tables(self):
        table = "// Rows. Sections cited are of math.md.\n"
        self.check(table + 'ROW(A, "4.1: by 0 -> 0")\nROW(B, "section 1 flush")\nROW(C, "0.5 * a")\n', place="spirv/x.def")
        self.check(table + 'ROW(A, "4.9")\n', "docs/math.md has no section 4.9", place="spirv/x.def")
        self.check(table + 'ROW("exec/chain.h", "nir.c: a, 4.1 and 4.2",\n    "why")\n', place="spirv/x.def")
        self.check(table + 'ROW("exec/chains.h", "nir.c: a, 4.1 and 4.6", "")\n', "there is no exec/chains.h",
                   "docs/math.md has no section 4.6", place="spirv/x.def")
        self.check('// Rows.\nROW(A, "4.1")\n', "4.1: the file names no document above", place="spirv/x.def")

    def test_rows_of_deviations(self):
        self.check("// deviations.md: float-to-uint, nine-vertices\n// and deviations.md, nine-vertices and float-to-uint.\n")
        self.check("// deviations.md: ten-vertices\n", "deviations.md has no row ten-vertices")
        self.check("// deviations.md, nine-vertices and\n// float-to-int\n", "deviations.md has no row float-to-int")
        rows = ROWS + "| lost-case | `glsl.deviation.lost` |\n"
        self.check(rows, "there is no case deviation.lost", place="cts-subset/deviations.md")

    def test_paths(self):
        self.check("// base/lanes.h, exec/chain.h, chain.h, spirv/exec, spirv/exec/chain*.h, either/or, min/max\n")
        self.check("// base/lines.h\n", "there is no base/lines.h")
        self.check("// exec/chains.h\n", "there is no exec/chains.h")
        self.check("// spirv/front/control\n", "there is no spirv/front/control")
        self.check("// spirv/exec/links*.h\n", "there is no spirv/exec/links*.h")
        self.check("// See chains.h.\n", "no file is called chains.h")
        self.check('"""Reads base/lines.h."""\n# and chains.h\n', "there is no base/lines.h", "no file is called chains.h",
                   place="tests/x.py")
        self.check("# base/lines.h\n", "there is no base/lines.h", place="base/CMakeLists.txt")

    def test_documents_cite(self):
        page = "# Page\n## 1. One\n[a](math.md#41-rules) [b](../base/lanes.h) `spirv/exec` section 1, math.md 4.1\n"
        self.check(page, place="docs/page.md")
        self.check("# Page\n[a](maths.md)\n", "the link maths.md leads nowhere", "there is no document maths.md",
                   place="docs/page.md")
        self.check("# Page\n[a](math.md#42-rules)\n", "docs/math.md has no heading #42-rules", place="docs/page.md")
        self.check("# Page\n```\nbase/lines.h\n```\nand `base/lines.h`\n", "there is no base/lines.h", place="docs/page.md")
        self.check("# Page\n## 1. One\nas in section 2\n", "no section 2 here", place="docs/page.md")
        self.check("# Page\n`math.md` section 6\n", "docs/math.md has no section 6", place="docs/page.md")

    def test_settings(self):
        page = {"docs/page.md": "# Page\n`VITRINE_LOG`\n", "base/log.cpp": '// Log.\nauto a = getenv("VITRINE_LOG");\n'}
        self.assertEqual(self.faults(page), [])
        self.check("# Page\n`VITRINE_LOGS`\n", "nothing reads VITRINE_LOGS", place="docs/page.md")

    def test_functions(self):
        files = {"base/a.h": "// A. See fill_all(), or std::sort() and GLSL's dFdx().\nvoid fill_all();  // not empty_all()\n"}
        self.assertEqual(self.faults(files), ["there is no empty_all()"])

    def test_lines(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "base/a.h"
            path.parent.mkdir()
            path.write_text("// One.\n\n// Two, and\n// maths.md\n")
            self.assertEqual(list(citations.faults_of(pathlib.Path(folder))), ["base/a.h:4: there is no document maths.md"])


if __name__ == "__main__":
    unittest.main()
