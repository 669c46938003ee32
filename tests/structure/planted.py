#!/usr/bin/env python3
"""Checks that every rule of the tools (glass/rules.def) is planted: a fault that breaks it, and a correct twin that nothing is
said of, in the catalogues (tests/glass/catalogue_*_test.cpp, race_*_test.cpp, tests/icd/sync_*_test.cpp), or in the tests that are named here.

usage: planted.py SOURCE_FOLDER
"""
import pathlib
import re
import sys

VERTICES, COMMANDS = "tests/glass/vertices_test.cpp Vertices.", "tests/icd/sanitized_commands_test.cpp SanitizedCommands."
SHAKE = "tests/glass/shake_test.py Shake."
PRINTF = "tests/glass/printf_test.cpp Printf."
# What no shader alone can do, by rule: the test of the fault and that of the twin. One test may have both.
ELSEWHERE = {
    "out-of-bounds-vertex": (VERTICES + "OfWhichTheLastByteIsMissing", VERTICES + "AreFineUpToTheLastByte"),
    "out-of-bounds-index": (VERTICES + "IndicesOutsideAreTold", VERTICES + "IndicesUpToTheLastByteAreFine"),
    "null-descriptor": (VERTICES + "WithoutABufferAreTold", VERTICES + "MayBeMissingWhereFeaturesSaySo"),
    "out-of-bounds-arguments": (COMMANDS + "ArgumentsOutsideOfTheirBuffer", COMMANDS + "ArgumentsOutsideOfTheirBuffer"),
    "endless-shader": ("tests/icd/device_fault_test.cpp DeviceFault.TheVendorBinaryIsAHeaderAndAReport",
                       "tests/spirv/exec/budget_test.cpp Budget.LongBodiesSpendItSooner"),
    "order-dependent": (SHAKE + "test_what_depends_on_the_order_is_found", SHAKE + "test_twins_are_silent"),
    "last-writer": (SHAKE + "test_the_last_writer_is_told", SHAKE + "test_the_last_writer_is_told"),
    "printf": (PRINTF + "AssertionsAreErrors", PRINTF + "FilterNamesInvocations"),
    "assertion": (PRINTF + "AssertionsAreErrors", PRINTF + "AssertionsAreErrors"),
}


def faults_of(root):
    rules = re.findall(r'VITRINE_RULE\("([^"]+)"', (root / "glass/rules.def").read_text())
    planted = set()
    catalogues = [(root / "tests" / room).glob(f"{name}_*_test.cpp")
                  for room, name in (("glass", "catalogue"), ("glass", "race"), ("icd", "sync"))]
    for path in sorted(p for paths in catalogues for p in paths):
        planted.update(re.findall(r'\{\s*"\w+",\s*"([a-z-]+)",', path.read_text()))
    for rule in rules:
        if (rule in planted) == (rule in ELSEWHERE):
            yield f"glass/rules.def: {rule} is " + ("planted in the catalogue and elsewhere" if rule in planted else "not planted")
    for rule, tests in ELSEWHERE.items():
        if rule not in rules:
            yield f"{rule} is no rule"
        if rule not in (root / tests[0].split()[0]).read_text():
            yield f"{tests[0]}: nothing is said of {rule}"
        for name, suite, test in (re.fullmatch(r"(\S+) (\w+)\.(\w+)", test).groups() for test in tests):
            text = (root / name).read_text()
            here = re.search(rf"class {suite}\(", text) and f"def {test}(" in text if name.endswith(".py") else \
                re.search(rf"TEST(_F)?\({suite}, {test}\)", text)
            if not here:
                yield f"{name}: there is no {suite}.{test}"


def main():
    faults = list(faults_of(pathlib.Path(sys.argv[1])))
    print("\n".join(faults) if faults else "every rule is planted")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
