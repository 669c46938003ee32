#!/usr/bin/env python3
"""Bug files that were altered or cut off, replayed: they are refused, or run, and never end the process.

usage: altered_bugs_test.py [--seconds N] [--seed N] [--jobs N] [--captured-by MANIFEST] REPLAYER MANIFEST CTS_SUBSET [FILTER]

Every command that cases of the suite record becomes a bug file (FILTER: cases, as GoogleTest has them). Alterations are of
the bytes within the stream, whose sum is made anew, so that the header's members, modules and contents are met; some
files are cut off or altered as they lie. Worth most with a driver and a replayer of the preset asan. What ends a process is
kept in the working folder. --captured-by: the driver that writes the files (default: MANIFEST's), since the suite cannot load
that preset's.
"""
import argparse
import collections
import concurrent.futures
import gzip
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import time

# One of each family of random cases.
FILTER = "*/1"
MOST_FILES = 600
# A dispatch of an altered size may run for hours.
LONGEST = 20
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def another(number, at_random):
    """One near to this, or what programs do not expect."""
    if at_random.randrange(2):
        return str(max(at_random.choice([int(number) + 1, int(number) - 1, int(number) * 2, int(number) // 2]), 0)).encode()
    return at_random.choice([b"0", b"1", b"2", b"3", b"7", b"64", b"255", b"65536", b"4294967295", b"4294967296",
                             b"18446744073709551615", b"-1", b"1e300", b"null", b"[]", b"{}", b'"x"', b"true"])


def altered(stream, at_random):
    """A stream, of which some bytes or numbers are others."""
    data = bytearray(stream)
    # "vitrine-bug N", a line's end, the length of the header.
    begin = data.index(b"\n") + 9
    end = begin + int.from_bytes(data[begin - 8:begin], "little")
    header, rest = bytes(data[begin:end]), bytearray(data[end:])
    for _ in range(at_random.randint(1, 3)):
        kind = at_random.randrange(4)
        if kind == 0 or not rest:  # a number of the header
            found = list(re.finditer(rb"-?\d+", header))
            one = at_random.choice(found)
            header = header[:one.start()] + another(one[0], at_random) + header[one.end():]
        elif kind == 1:  # two numbers change places
            found = list(re.finditer(rb"\d+", header))
            a, b = sorted(at_random.sample(found, 2), key=lambda match: match.start())
            header = header[:a.start()] + b[0] + header[a.end():b.start()] + a[0] + header[b.end():]
        elif kind == 2:  # a byte of what the header names
            at = at_random.randrange(len(rest))
            rest[at] = at_random.choice([0, 1, 255, rest[at] ^ (1 << at_random.randrange(8)), at_random.randrange(256)])
        else:  # a member less
            found = list(re.finditer(rb'"\w+":(\d+|"[^"]*"),', header))
            if found:
                one = at_random.choice(found)
                header = header[:one.start()] + header[one.end():]
    return bytes(data[:begin - 8]) + len(header).to_bytes(8, "little") + header + bytes(rest)


def altered_file(original, at_random):
    if at_random.randrange(10) == 0:
        data = bytearray(original)
        data[at_random.randrange(len(data))] ^= 1 << at_random.randrange(8)
        return bytes(data[:at_random.randrange(1, len(data))] if at_random.randrange(2) else data)
    return gzip.compress(altered(gzip.decompress(original), at_random), 1)


class Rounds:
    def __init__(self, options, folder, files):
        self.options, self.folder, self.files = options, folder, files
        self.end = time.monotonic() + options.seconds
        self.faults = []

    def run(self, job):
        """How often each outcome came."""
        outcomes = collections.Counter()
        at_random = random.Random(self.options.seed * 1000 + job)
        number = 0
        while time.monotonic() < self.end:
            number += 1
            file = self.folder / f"altered-{job}-{number}.vitrine"
            file.write_bytes(altered_file(at_random.choice(self.files), at_random))
            outcomes[self.replay(file)] += 1
            file.unlink(missing_ok=True)
            file.with_suffix(".said").unlink(missing_ok=True)
        return outcomes

    def replay(self, file):
        said = file.with_suffix(".said")
        try:
            with open(said, "wb") as errors:
                code = subprocess.run([self.options.replayer, str(file)], stdout=subprocess.DEVNULL, stderr=errors, check=False,
                                      timeout=LONGEST, cwd=self.folder,
                                      env={**os.environ, "VK_DRIVER_FILES": self.options.manifest, "VITRINE_THREADS": "1"}).returncode
        except subprocess.TimeoutExpired:
            return "runs long"
        with open(said, errors="replace", encoding="utf-8") as errors:
            text = errors.read(100000)
        if code in (0, 1, 2) and "Sanitizer" not in text and "runtime error" not in text:
            return {0: "the same bytes", 1: "other bytes", 2: "refused"}[code]
        kept = pathlib.Path.cwd() / file.name
        kept.write_bytes(file.read_bytes())
        self.faults.append(f"{kept}: {code}\n{text[:3000]}")
        return "faults"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=1200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--captured-by", type=os.path.abspath)
    for name in "replayer", "manifest", "suite":
        parser.add_argument(name, type=lambda path: str(pathlib.Path(path).resolve()))
    parser.add_argument("filter", nargs="?", default=FILTER)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        folder = pathlib.Path(name)
        subprocess.run([options.suite, f"--icd={options.captured_by or options.manifest}", "--validation=0",
                        f"--recorded={ROOT / 'cts-subset/recorded-reference.txt'}",
                        f"--gtest_filter={options.filter}"], cwd=folder, stdout=subprocess.DEVNULL, check=False,
                       env={**os.environ, "VITRINE_CAPTURE": "all", "VITRINE_CAPTURE_FILE": str(folder / "%n.vitrine")})
        paths = sorted(folder.glob("*.vitrine"))
        random.Random(options.seed).shuffle(paths)
        rounds = Rounds(options, folder, [path.read_bytes() for path in paths[:MOST_FILES]])
        print(f"{len(paths)} bug files, {len(rounds.files)} of them are altered", flush=True)
        assert len(rounds.files) > 20
        outcomes = sum(pool.map(rounds.run, range(options.jobs)), collections.Counter())
    for outcome, count in outcomes.most_common():
        print(f"{outcome}: {count}")
    print("\n".join(rounds.faults))
    return 1 if rounds.faults else 0


if __name__ == "__main__":
    sys.exit(main())
