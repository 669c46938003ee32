#!/usr/bin/env python3
"""Grows and minimises the corpora of the fuzzers, which lie packed in the folder "corpus" beside it.

    tests/fuzz/corpus.py BUILD [--seconds N] [--add FOLDER] [FUZZER...]

BUILD: a build with VITRINE_LIBFUZZER=ON (tests/fuzz/CMakeLists.txt). Each fuzzer (module, api, object, peer, reader; all without
names) starts from its corpus, runs N seconds (0: does not), and keeps the fewest inputs that reach all that it has
reached. Findings stop it: their inputs lie in BUILD/corpus. The same inputs give the same archive."""

import argparse
import io
import pathlib
import shutil
import subprocess
import sys
import tarfile

PACKED = pathlib.Path(__file__).resolve().parent / "corpus"
# The longest input, in bytes.
LONGEST = {"module": 40000, "api": 2048, "object": 2048, "peer": 2048, "reader": 20000}


def program(build, name):
    return build / "tests/fuzz" / ("vitrine_libfuzzer" if name == "module" else f"vitrine_{name}_libfuzzer")


def unpack(archive, folder):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    if archive.exists():
        with tarfile.open(archive) as packed:
            packed.extractall(folder, filter="data") if hasattr(tarfile, "data_filter") else packed.extractall(folder)


def pack(folder, archive):
    """In the order of names, with nothing of whoever packs and when."""
    with tarfile.open(archive, "w:xz", format=tarfile.USTAR_FORMAT, preset=9) as packed:
        for file in sorted(folder.iterdir()):
            data = file.read_bytes()
            entry = tarfile.TarInfo(file.name)
            entry.size, entry.mode = len(data), 0o644
            packed.addfile(entry, io.BytesIO(data))


def run(command, folder):
    # In its own folder: what ends the process leaves its input there.
    done = subprocess.run([str(part) for part in command], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                          errors="replace", check=False)
    if done.returncode:
        sys.exit(f"{done.stderr[-4000:]}\n{command[0]} ended with {done.returncode}; inputs are in {folder}")
    return done.stderr


def grow(build, name, seconds, added):
    work = build / "corpus" / name
    inputs, least = work / "inputs", work / "least"
    unpack(PACKED / f"{name}.tar.xz", inputs)
    # Without its statistics of rare features, which take most of the time where inputs are many and runs are short.
    common = ["-len_control=0", "-entropic=0", f"-max_len={LONGEST[name]}", "-timeout=100", "-rss_limit_mb=6000", "-malloc_limit_mb=10000000"]
    if seconds:
        report = run([program(build, name), *common, f"-max_total_time={seconds}", "-print_final_stats=1", inputs], work)
        print("\n".join(f"{name}: {line}" for line in report.splitlines() if line.startswith("stat::number_of_exec")))
    shutil.rmtree(least, ignore_errors=True)
    least.mkdir()
    run([program(build, name), *common, "-merge=1", least, inputs, *added], work)
    archive = PACKED / f"{name}.tar.xz"
    pack(least, archive)
    count = len(list(least.iterdir()))
    print(f"{name}: {count} inputs, {sum(f.stat().st_size for f in least.iterdir())} bytes, packed {archive.stat().st_size}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--seconds", type=int, default=0)
    parser.add_argument("--add", type=pathlib.Path, action="append", default=[], help="a folder of inputs to be merged, too")
    parser.add_argument("fuzzers", nargs="*", metavar="FUZZER", help=", ".join(LONGEST))
    arguments = parser.parse_intermixed_args()
    for name in arguments.fuzzers or LONGEST:
        if name not in LONGEST:
            parser.error(f"no fuzzer is called {name}")
    PACKED.mkdir(exist_ok=True)
    for name in arguments.fuzzers or LONGEST:
        grow(arguments.build.resolve(), name, arguments.seconds, [folder.resolve() for folder in arguments.add])


if __name__ == "__main__":
    main()
