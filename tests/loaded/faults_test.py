#!/usr/bin/env python3
"""Whole programs whose driver is refused memory, a thread or a file, at the n-th call and at all from the n-th on: each
ends by itself, with the right result or with an error, and never by a fault of the driver. Prints what was refused how often.

usage: faults_test.py MANIFEST FAILING_CALLS BUILD_FOLDER [--points N] [--only TEXT]
FAILING_CALLS: the library of failing_calls.cpp. BUILD_FOLDER: where the programs of the tests are.
--points: how many calls of each kind fail one by one, in each program, about (100). --only: programs with this in their name
"""
import argparse
import collections
import contextlib
import os
import pathlib
import shutil
import signal
import struct
import subprocess
import sys
import tempfile

from display_servers import x_server

KINDS = ("memory", "threads", "files")
SECONDS = 120  # after which a program hangs
# Ends that an application chooses are an exit status, or abort() by an assertion of its own (vkcube's on results).
TERMINATED = "terminate called"
# Programs with tools that write JSON: the library for it allocates where it frees, and so ends the process if there is no
# memory then (docs/security.md). That is counted apart.
WRITES_JSON = ("compute, watched by eight tools", "every stage, history of a pixel", "every stage, all commands as bug files")


def programs(args, window, folder):
    """{name: (command, variables)} of what is there to run. `window`: the variables of a display, None without one."""
    tests, command = args.build / "tests", args.build / "bin/vitrine"
    (folder / "script").write_text("break workgroup 0,0,0\nrun\nstep\ninfo locals\nback\ncontinue\n")
    found = {
        "demo": ([tests / "vitrine_demo", "demo.png"], {}),
        "compute": ([tests / "vitrine_test_app"], {}),
        "compute, watched by eight tools": ([tests / "vitrine_test_app"], {
            "VITRINE_TOOLS": "sanitize,race,sync,numbers,coverage,count,timeline,printf", "VITRINE_REPORT": "found.txt",
            "VITRINE_COVERAGE": "lines.info", "VITRINE_COUNTS": "counts.json", "VITRINE_TIMELINE": "timeline.json"}),
        "every stage": ([tests / "vitrine_test_pixels"], {}),
        "every stage, history of a pixel": ([tests / "vitrine_test_pixels"], {
            "VITRINE_TOOLS": "pixel", "VITRINE_PIXEL": "10,6:image=*", "VITRINE_PIXEL_HISTORY": "history.json"}),
        "every stage, all commands as bug files": ([tests / "vitrine_test_pixels"], {"VITRINE_CAPTURE": "all"}),
        "debugger, scripted": ([command, "debug", "-x", "script", "--", tests / "vitrine_test_pixels"], {}),
        "bug file, replayed": ([command, "replay", *sorted(folder.glob("kept/*.vitrine"))[:1]], {}),
        "vulkaninfo": (["vulkaninfo"], {}),
    }
    if window:
        found["window"] = (["vkcube", "--c", "4", "--suppress_popups"], window)
        found["window, watched"] = (["vkcube", "--c", "4", "--suppress_popups"], window | {"VITRINE_TOOLS": "sanitize,sync"})
        found["window, C++"] = (["vkcubepp", "--c", "4", "--suppress_popups"], window)
        found["vulkaninfo with windows"] = (["vulkaninfo"], window)
    return {name: run for name, run in found.items() if shutil.which(run[0][0])}


class Run:
    """One program with one kind of call that fails."""

    def __init__(self, args, folder, command, variables, writes_json):
        self.folder = folder
        self.writes_json = writes_json
        self.said = ""
        self.command = [str(word) for word in command]
        self.count = folder / "count"
        self.environment = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
        self.environment |= {"VK_DRIVER_FILES": str(args.manifest), "LD_PRELOAD": str(args.library), "FAULTS_COUNT": str(self.count),
                             "XDG_RUNTIME_DIR": str(folder)} | {key: str(value) for key, value in variables.items()}

    def end(self, kind, at, further=False):
        """What is wrong with how it ends, or None; the number of calls it made; how it ended: "well", "error", "json"."""
        self.count.write_bytes(bytes(8))
        wanted = self.environment | {"FAULTS_KIND": kind, "FAULTS_AT": str(at), "FAULTS_ON": "1" if further else "0"}
        try:
            done = subprocess.run(self.command, env=wanted, cwd=self.folder, capture_output=True, timeout=SECONDS, check=False)
        except subprocess.TimeoutExpired:
            return "does not end", 0, "error"
        said = (done.stdout + done.stderr).decode(errors="replace")
        self.said = said
        calls = struct.unpack("q", self.count.read_bytes())[0]
        if done.returncode >= 0 or (done.returncode == -signal.SIGABRT and TERMINATED not in said):
            return None, calls, "well" if done.returncode == 0 else "error"
        if done.returncode == -signal.SIGABRT and self.writes_json and "bad_alloc" in said:
            return None, calls, "json"
        return f"ends by signal {-done.returncode}: {said[-300:]}", calls, "error"


def points(calls, wanted, first):
    """Numbers of calls: the first ones all, then ever fewer, about `wanted` in all. Not the very first one for memory: the
    C++ library's reserve, without which no exception can be thrown when there is no more."""
    result, at = [], first
    while at < calls:
        result.append(at)
        at += 1 + 3 * at // max(wanted, 1)
    return result


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("manifest", type=pathlib.Path)
    parser.add_argument("library", type=pathlib.Path)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--points", type=int, default=100)
    parser.add_argument("--only", default="")
    args = parser.parse_args()
    args.manifest, args.library, args.build = (path.resolve() for path in (args.manifest, args.library, args.build))
    faults = []
    with contextlib.ExitStack() as stack:
        folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory()))
        window = stack.enter_context(x_server())[1] if shutil.which("Xvfb") else None
        (folder / "kept").mkdir()
        subprocess.run([args.build / "tests/vitrine_test_app"], cwd=folder / "kept", check=True, stdout=subprocess.DEVNULL,
                       env=dict(os.environ, VK_DRIVER_FILES=str(args.manifest), VITRINE_CAPTURE="all"))
        print("| program | kind | calls | refused | ran all the same | ended with an error | ended in a report |\n|---|---|---|---|---|---|---|")
        for title, (command, variables) in programs(args, window, folder).items():
            if args.only not in title:
                continue
            run = Run(args, folder, command, variables, title in WRITES_JSON)
            for kind in KINDS:
                wrong, calls, end = run.end(kind, -1)
                if wrong or end != "well":
                    raise SystemExit(f"{title} does not run: {wrong or run.said}")
                ends = collections.Counter()
                for at in points(calls, args.points, 1 if kind == "memory" else 0):
                    for further in (False, True):
                        wrong, _, end = run.end(kind, at, further)
                        ends[end] += 1
                        if wrong:
                            faults.append(f"{title}: {kind} {at}{' and all further' if further else ''}: {wrong}")
                print(f"| {title} | {kind} | {calls} | {sum(ends.values())} | {ends['well']} | {ends['error']} | {ends['json']} |", flush=True)
    print(*faults, sep="\n")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
