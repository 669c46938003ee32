#!/usr/bin/env python3
"""Which lines and branches of the rooms the tests and the fuzzers run: builds the preset coverage (clang), runs the tests
without the labels heavy and style and each fuzzer for a while, and writes the tables of docs/coverage.md. The driver counts
also where the loader loads it.

usage: coverage.py ROOT [--jobs N] [--seconds N] [--tests REGEX] [--without REGEX] [--no-build] [--no-run] [--uncalled]

--tests, --without: ctest's -R and -E. --seconds: of each fuzzer (60). --no-run: tables of the profiles that are there.
--uncalled: prints the functions that nothing called, too.
Exit code 1: a file of the second table has no explanation in the page.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOMS = ("base", "texel", "spirv", "raster", "glass", "icd", "cts-subset")
LEAST = 90  # percent of lines; rooms and files below are explained
BIG = 100  # lines of files that are
# What runs the same code again, or another build.
WITHOUT = "^(sanitized_driver|cts_sanitized|cts_sse4|cts_same_bytes|package_stranger)$"
FUZZERS = ("tests/fuzz/vitrine_fuzz", "tests/fuzz/vitrine_api_fuzz", "tests/fuzz/vitrine_object_fuzz", "tests/fuzz/vitrine_reader_fuzz",
           "tests/fuzz/vitrine_peer_fuzz")
OBJECTS = ("icd/libvitrine_icd.so", *(f"tests/{room}_test" for room in ROOMS[:-1]), *FUZZERS, "bin/vitrine", "bin/vitrine-replay", "tests/vitrine_step",
           "cts-subset/cts_subset")


def tool(name):
    """LLVM's program of this name, of the newest version that is there."""
    names = [f"{name}-{version}" for version in range(30, 13, -1)] + [name]
    found = next((path for path in map(shutil.which, names) if path), None)
    return found or sys.exit(f"{name} is missing (Debian: apt-get install clang llvm)")


def room_of(name, root):
    """The room and the path in the tree of a file that was compiled; none: it is none of ours, or generated."""
    path = os.path.relpath(os.path.normpath(name), root)
    room = path.split("/")[0]
    return (room, path) if room in ROOMS else None


class Counts:
    def __init__(self):
        self.lines, self.run, self.branches, self.taken = 0, 0, 0, 0

    def add(self, summary):
        self.lines += summary["lines"]["count"]
        self.run += summary["lines"]["covered"]
        self.branches += summary["branches"]["count"]
        self.taken += summary["branches"]["covered"]

    def percent(self):
        """Of lines that ran."""
        return 100 * self.run / self.lines if self.lines else 100


def share(part, whole):
    return f"{100 * part / whole:.1f} %" if whole else "-"


def gathered(export, root):
    """Of llvm-cov's export the counts of each room, and of each file by its path."""
    rooms, files = {room: Counts() for room in ROOMS}, {}
    for file in export["data"][0]["files"]:
        known = room_of(file["filename"], root)
        if not known:
            continue
        rooms[known[0]].add(file["summary"])
        files.setdefault(known[1], Counts()).add(file["summary"])
    return rooms, files


def rooms_table(rooms):
    rows = ["| room | lines | of them run | branches | of them taken |", "|---|---:|---:|---:|---:|"]
    for room, counts in rooms.items():
        if counts.lines:
            rows.append(f"| `{room}/` | {counts.lines} | {share(counts.run, counts.lines)} | {counts.branches} | {share(counts.taken, counts.branches)} |")
    return "\n".join(rows)


def reasons_of(page):
    """The last column of the rows of files, by path."""
    return {row[0]: row[1] for row in re.findall(r"^\| `([^`]*\.\w+)` \|.*\| ([^|]*) \|$", page, re.M)}


def files_table(files, reasons):
    """Big files below LEAST with their explanations; "?": it has none yet."""
    rows = ["| file | lines | of them run | what does not run, and why |", "|---|---:|---:|---|"]
    for path, counts in sorted(files.items()):
        if counts.lines >= BIG and counts.percent() < LEAST:
            rows.append(f"| `{path}` | {counts.lines} | {share(counts.run, counts.lines)} | {reasons.get(path, '?')} |")
    return "\n".join(rows)


def with_table(page, heading, table):
    """The page with the table in the place of the first one below this heading."""
    start = page.index(f"\n## {heading}\n")
    found = re.compile(r"^\|.*(?:\n\|.*)*", re.M).search(page, start)
    return page[: found.start()] + table + page[found.end():]


def uncalled(export, root):
    """Names and places of functions that no process called, by path."""
    called, places = set(), {}
    for function in export["data"][0]["functions"]:
        known = room_of(function["filenames"][0], root)
        if not known or known[0] == "cts-subset":
            continue
        place = (known[1], function["regions"][0][0])
        places.setdefault(place, function["name"])
        if function["count"]:
            called.add(place)
    return sorted((path, line, name) for (path, line), name in places.items() if (path, line) not in called)


def run_everything(build, profiles, options):
    shutil.rmtree(profiles, ignore_errors=True)
    profiles.mkdir(parents=True)
    # Four files a program, to which its processes add in turn.
    environment = os.environ | {"LLVM_PROFILE_FILE": str(profiles / "%4m.profraw")}
    words = ["ctest", "--test-dir", str(build), "-LE", "heavy|style", "-E", options.without, "-j", str(options.jobs), "--output-on-failure"]
    if options.tests:
        words += ["-R", options.tests]
    # Tests of the built driver's shape fail with counters inside; what ran has been counted.
    subprocess.run(words, env=environment, check=False)
    for fuzzer in FUZZERS:
        subprocess.run([build / fuzzer, str(options.seconds)], env=environment, cwd=profiles, check=False)


def export_of(build, profiles, *more):
    merged = profiles / "all.profdata"
    subprocess.run([tool("llvm-profdata"), "merge", "-sparse", "-o", merged, *profiles.glob("*.profraw")], check=True)
    objects = [build / name for name in OBJECTS if (build / name).exists()]
    words = [tool("llvm-cov"), "export", f"-instr-profile={merged}", *more, objects[0]]
    for name in objects[1:]:
        words += ["-object", name]
    return json.loads(subprocess.run(words, check=True, stdout=subprocess.PIPE).stdout)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("root", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--seconds", type=int, default=60)
    parser.add_argument("--tests", default="")
    parser.add_argument("--without", default=WITHOUT)
    for flag in ("--no-build", "--no-run", "--uncalled"):
        parser.add_argument(flag, action="store_true")
    options = parser.parse_args()
    root = options.root.resolve()
    build = root / "build/coverage"
    if not options.no_build:
        subprocess.run(["cmake", "--preset", "coverage", "-DVITRINE_TESTS=ON"], cwd=root, check=True, stdout=subprocess.DEVNULL)
        subprocess.run(["cmake", "--build", build, "-j", str(options.jobs)], check=True)
    profiles = build / "profiles"
    if not options.no_run:
        run_everything(build, profiles, options)
    rooms, files = gathered(export_of(build, profiles, "-summary-only"), root)
    page = root / "docs/coverage.md"
    text = page.read_text()
    table = files_table(files, reasons_of(text))
    page.write_text(with_table(with_table(text, "Rooms", rooms_table(rooms)), "Files below 90 %", table))
    print(rooms_table(rooms), table, sep="\n\n")
    if options.uncalled:
        for path, line, name in uncalled(export_of(build, profiles), root):
            print(f"{path}:{line}: {name}")
    return 1 if "| ? |" in table else 0


if __name__ == "__main__":
    sys.exit(main())
