#!/usr/bin/env python3
"""Runs cases with a library in front of the loader that puts something else in the place of the pipelines that they
make (layer/as_shader_objects.cpp, layer/as_pipeline_binaries.cpp), against the reference as ever.

compare_layer.py --library FILE --out DIR -- cts_subset ARGS...
Exit status: that of the suite; 1 where too many pipelines stayed as they were; 77 where the driver has not what the
library needs.
"""
import argparse
import os
import pathlib
import subprocess
import sys

# Some cannot be replaced: which ones, each library tells.
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
    env = {**os.environ, "LD_PRELOAD": arguments.library, "LAYER_COUNTS": str(counts)}
    status = subprocess.run([*arguments.command, f"--results={arguments.out}"], env=env).returncode
    if not counts.exists():
        print("no pipeline was made on a device that has what it needs")
        return 77
    rows = [tuple(map(int, line.split())) for line in counts.read_text().splitlines()]
    replaced, left = (sum(column) for column in zip(*rows))
    print(f"{replaced} pipelines were replaced, {left} stayed")
    return status or int(replaced < LEAST_SHARE * (replaced + left))


if __name__ == "__main__":
    sys.exit(main())
