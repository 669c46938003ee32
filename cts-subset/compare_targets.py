#!/usr/bin/env python3
"""Runs cases on this driver with every SIMD target, and with all tools on, and compares all bytes, those of NaNs too.

compare_targets.py --out DIR [--targets sse4,avx2,avx3] -- cts_subset ARGS...
Exit status: 0 equal, 1 different or failed.
"""
import argparse
import os
import subprocess
import sys

TOOLS = {"VITRINE_TOOLS": "sanitize,numbers,coverage,count,printf",
         **{name: "/dev/null" for name in ("VITRINE_REPORT", "VITRINE_COVERAGE", "VITRINE_COUNTS", "VITRINE_SOURCES")}}


def fingerprints(command, target, out):
    """Hash of every case's output by its name."""
    path = os.path.join(out, target + ".txt")
    if os.path.exists(path):
        os.remove(path)
    env = {**os.environ, **(TOOLS if target == "tools" else {"VITRINE_TARGET": target})}
    done = subprocess.run(command + [f"--fingerprints={path}", f"--results={out}"], env=env,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode:
        sys.exit(f"target {target}: {done.stdout.decode(errors='replace')}")
    with open(path) as file:
        return dict(line.split() for line in file)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--out", required=True)
    parser.add_argument("--targets", default="sse4,avx2,avx3,tools", help="tools: any target, with all tools on")
    parser.add_argument("command", nargs="+")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    targets = arguments.targets.split(",")
    found = [fingerprints(arguments.command, target, arguments.out) for target in targets]
    names = sorted(set().union(*found))
    differing = [name for name in names if len({hashes.get(name) for hashes in found}) > 1]
    for name in differing:
        hashes = "  ".join(f"{target} {hashes.get(name)}" for target, hashes in zip(targets, found))
        print(f"{name}: {hashes}")
    print(f"{len(names)} cases, {len(differing)} of them differ between {', '.join(targets)}")
    sys.exit(1 if differing or not names else 0)


main()
