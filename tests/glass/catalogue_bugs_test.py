#!/usr/bin/env python3
"""Every fault and race of the catalogues as a bug file: its module runs through Vulkan, is captured, and replayed with the
same finding; is reduced with the finding at its place, and exported.

usage: catalogue_bugs_test.py [--all] [--jobs N] VITRINE GLASS_TEST CATALOGUE [AMBER]
Without --all: a sample. With AMBER, the program of https://github.com/google/amber, the scripts run in it.
"""
import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

REFERENCE = "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json"
SAMPLE = ("*Catalogue*Fault*/load_*:*Catalogue*Fault*/store_*:*Catalogue*Fault*gone*:*Catalogue*Fault*address*:*Catalogue*Fault*texel*"
          ":*CatalogueNumbers*Fault*zero*:*Race*Found*/no_barrier*:*Race*Found*word*")
# The least that there are of each.
LEAST = {True: {"sanitize": 1000, "numbers": 70, "race": 200}, False: {"sanitize": 100, "numbers": 5, "race": 5}}


class Catalogue:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.manifest = str(pathlib.Path(options.vitrine).parent.parent / "icd" / "vitrine_icd.x86_64.json")
        self.replayer = str(pathlib.Path(options.vitrine).with_name("vitrine-replay"))
        self.faults = []

    def run(self, *words, **environment):
        return subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, cwd=self.folder,
                              env={**os.environ, "VK_DRIVER_FILES": self.manifest, **environment})

    def fail(self, name, what):
        self.faults.append(f"{name}: {what}")

    def make_modules(self):
        modules = self.folder / "modules"
        modules.mkdir()
        wanted = "*Catalogue*Fault*:*Race*Found*" if self.options.all else SAMPLE
        result = self.run(self.options.glass_test, f"--gtest_filter={wanted}", VITRINE_TEST_CATALOGUE=str(modules))
        assert result.returncode == 0, result.stdout[-2000:]
        return modules

    def capture(self, modules, tool):
        """Name of the case, its file, what is expected."""
        folder = self.folder / tool
        folder.mkdir()
        result = self.run(self.options.catalogue, modules, tool, VITRINE_TOOLS=tool, VITRINE_REPORT=str(folder / "report.json"),
                          VITRINE_CAPTURE="finding", VITRINE_CAPTURE_FILE=str(folder / "%s.vitrine"))
        assert result.returncode == 0, result.stderr[-2000:]
        for line in result.stdout.splitlines():
            submission, name = line.split(" ")
            file = folder / f"{submission}.vitrine"
            if file.exists():
                yield name, file, (modules / f"{name}.case").read_text().splitlines()[1:]
            else:
                self.fail(name, "no bug file")

    @staticmethod
    def texts(report):
        """The findings of a report as the catalogue has them."""
        def line(address):
            frames = address.get("frames", [])
            return frames[0]["line"] if frames else 0
        found = []
        for finding in json.loads(report.read_text())["findings"]:
            text = f"{finding['rule']}, line {line(finding['address'])}"
            if finding["rule"].startswith("race"):
                text += f" behind line {line(finding['related'][0]['address'])}"
            found.append(text)
        return set(found)

    def check(self, tool, name, file, expected):
        if self.replay(tool, name, file, expected) and (self.options.reduce == 1 or hash_of(name) % self.options.reduce == 0):
            self.reduce(tool, name, file, expected)
        return self.export(name, file)

    def replay(self, tool, name, file, expected):
        report = file.with_suffix(".json")
        result = self.run(self.replayer, file, VITRINE_TOOLS=tool, VITRINE_REPORT=str(report))
        if not report.exists() or self.texts(report) != set(expected):
            found = self.texts(report) if report.exists() else result.stderr
            self.fail(name, f"replayed {file}: {found}, expected {expected}")
            return False
        # What races is one thing or another.
        if "the same bytes" not in result.stdout and tool != "race":
            self.fail(name, f"replayed {file}: {result.stdout}")
        return True

    def reduce(self, tool, name, file, expected):
        small, report = file.with_suffix(".small"), file.with_suffix(".small.json")
        result = self.run(self.options.vitrine, "reduce", file, "-o", small, "--tools", tool, "--runs", "30",
                          *([] if self.options.shaders else ["--keep-shaders"]))
        if result.returncode != 0:
            return self.fail(name, f"reduce {file}: {result.stderr}")
        self.run(self.replayer, small, VITRINE_TOOLS=tool, VITRINE_REPORT=str(report))
        if not report.exists() or not self.texts(report) & set(expected):
            self.fail(name, f"reduced {file}: {self.texts(report) if report.exists() else 'nothing'}, expected {expected}")
        return None

    def export(self, name, file):
        """Why there is no script; else what Amber says of it."""
        script = file.with_suffix(".amber")
        parts = file.with_suffix(".parts")
        if self.run(self.options.vitrine, "export", file, "--files", parts).returncode != 0 or not (parts / "bug.json").exists():
            self.fail(name, f"export --files {file}")
        result = self.run(self.options.vitrine, "export", file, "--amber", script)
        if result.returncode != 0:
            return "no script: " + result.stderr.strip()
        if not self.options.amber:
            return "written"
        words = []
        for driver, manifest in ("this device", self.manifest), ("the reference", REFERENCE):
            ran = self.run(self.options.amber, "-d", script, VK_DRIVER_FILES=manifest)  # without layers
            text = "passes" if ran.returncode == 0 else "fails: " + re.sub(r"\d+|\S*/\S*", "N", ran.stdout + ran.stderr)[:150]
            words.append(f"on {driver} it {text}")
        return "; ".join(words)


def hash_of(name):
    return sum(name.encode())


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--reduce", type=int, default=20, help="one of so many is reduced")
    parser.add_argument("--shaders", action="store_true", help="reduce shaders, too")
    for name in "vitrine", "glass_test", "catalogue":
        parser.add_argument(name, type=lambda path: str(pathlib.Path(path).resolve()))
    parser.add_argument("amber", nargs="?")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        catalogue = Catalogue(options, pathlib.Path(folder))
        modules = catalogue.make_modules()
        exported = collections.Counter()
        for tool, least in LEAST[options.all].items():
            cases = list(catalogue.capture(modules, tool))
            exported.update(pool.map(lambda case, tool=tool: catalogue.check(tool, *case), cases))
            print(f"{tool}: {len(cases)} files")
            if len(cases) < least:
                catalogue.fail(tool, f"only {len(cases)} files")
        for text, count in exported.most_common():
            print(f"AmberScript of {count}: {text}")
        print("\n".join(catalogue.faults))
        print(f"{len(catalogue.faults)} faults")
        return 1 if catalogue.faults else 0


if __name__ == "__main__":
    sys.exit(main())
