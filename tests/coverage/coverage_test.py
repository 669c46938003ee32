#!/usr/bin/env python3
"""The tables of coverage.py, of exports as llvm-cov writes them.

usage: coverage_test.py
"""
import unittest

import coverage

ROOT = "/src/vitrine"


def file(name, lines, run, branches=0, taken=0):
    return {"filename": name, "summary": {"lines": {"count": lines, "covered": run}, "branches": {"count": branches, "covered": taken}}}


def function(name, line, count, filename=f"{ROOT}/icd/api/queries.cpp"):
    return {"name": name, "count": count, "filenames": [filename], "regions": [[line, 1, line + 2, 2, count, 0, 0, 0]]}


EXPORT = {"data": [{"files": [
    # As the compiler cache names them.
    file(f"{ROOT}/build/coverage/../../icd/api/queries.cpp", 200, 150, 40, 10),
    file(f"{ROOT}/icd/entry_points.h", 20, 5),
    file(f"{ROOT}/base/numeric.cpp", 100, 90, 10, 10),
    file(f"{ROOT}/build/coverage/generated/icd/tables.cpp", 500, 1),
    file(f"{ROOT}/tests/icd/a_test.cpp", 500, 1),
    file("/usr/include/c++/12/vector", 500, 1),
], "functions": [function("never", 3, 0), function("once", 9, 1), function("twice<int>", 20, 0), function("twice<long>", 20, 2),
                 function("other", 3, 0, "/usr/include/c++/12/vector")]}]}
PAGE = """# Coverage

## Rooms

Words.

| room | lines |
|---|---|
| `old/` | 1 |

More words.

## Files below 90 %

| file | lines | of them run | what does not run, and why |
|---|---:|---:|---|
| `icd/api/queries.cpp` | 1 | 1.0 % | Nobody has such a device. |
| `icd/api/drawing.cpp` | 1 | 1.0 % | It was so. |
"""


class Tables(unittest.TestCase):
    def setUp(self):
        self.rooms, self.files = coverage.gathered(EXPORT, ROOT)

    def test_rooms_are_the_projects_own(self):
        self.assertEqual(coverage.rooms_table(self.rooms).splitlines()[2:],
                         ["| `base/` | 100 | 90.0 % | 10 | 100.0 % |", "| `icd/` | 220 | 70.5 % | 40 | 25.0 % |"])

    def test_big_files_below_the_bar_keep_their_explanations(self):
        rows = coverage.files_table(self.files, coverage.reasons_of(PAGE)).splitlines()[2:]
        self.assertEqual(rows, ["| `icd/api/queries.cpp` | 200 | 75.0 % | Nobody has such a device. |"])
        self.assertIn("| ? |", coverage.files_table(self.files, {}))

    def test_the_page_gets_the_tables_in_their_places(self):
        page = coverage.with_table(PAGE, "Rooms", "| a |\n|---|")
        page = coverage.with_table(page, "Files below 90 %", "| b |\n|---|")
        self.assertEqual(page, "# Coverage\n\n## Rooms\n\nWords.\n\n| a |\n|---|\n\nMore words.\n\n## Files below 90 %\n\n| b |\n|---|\n")

    def test_a_template_is_called_if_one_of_its_kind_is(self):
        self.assertEqual(coverage.uncalled(EXPORT, ROOT), [("icd/api/queries.cpp", 3, "never")])


unittest.main()
