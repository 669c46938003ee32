#!/usr/bin/env python3
"""Runs cases with shader objects in place of the pipelines that they make (layer/as_shader_objects.cpp), against the
reference as ever.

compare_shader_objects.py --library FILE --out DIR -- cts_subset ARGS...
Exit status: that of the suite; 1 where too many pipelines stayed pipelines; 77 where the driver has no shader objects.
"""
import argparse
import os
import pathlib
import subprocess
import sys

# What shader objects cannot be: pipelines of libraries, with sample shading of their own, with some dynamic states.
LEAST_SHARE = 0.9


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--library", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("command", nargs="+")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    counts = pathlib.Path(arguments.out) / "pipelines.txt"
    counts.unlink(missing_ok=True)
    env = {**os.environ, "LD_PRELOAD": arguments.library, "AS_SHADER_OBJECTS_COUNT": str(counts)}
    status = subprocess.run([*arguments.command, f"--results={arguments.out}"], env=env).returncode
    if not counts.exists():
        print("no pipeline was made on a device with VK_EXT_shader_object")
        return 77
    rows = [tuple(map(int, line.split())) for line in counts.read_text().splitlines()]
    converted, left = (sum(column) for column in zip(*rows))
    print(f"{converted} pipelines became shader objects, {left} stayed")
    return status or int(converted < LEAST_SHARE * (converted + left))


if __name__ == "__main__":
    sys.exit(main())
