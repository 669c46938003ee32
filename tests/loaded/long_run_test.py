#!/usr/bin/env python3
"""Programs that present frame after frame hold what they held: memory, threads and files are flat. On X11 and on Wayland at
once, with and without a tool. Prints what each held at the first look and at most, and how much time it spent.

usage: long_run_test.py MANIFEST [--seconds N]
"""
import argparse
import contextlib
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

from display_servers import wayland_server, x_server

FRAMES = "1000000000"
# What the C library and the peer's buffers come and go by.
KIBIBYTES = 2048
# So long may others have the processors.
STILL_SECONDS = 60


class Program:
    def __init__(self, name, command, variables):
        self.name = name
        self.process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=dict(os.environ, **variables))
        self.first = self.most = None
        self.ticks, self.still_since = 0, time.monotonic()

    def look(self):
        """What is wrong, or None."""
        if self.process.poll() is not None:
            return f"{self.name}: ended with {self.process.returncode}"
        folder = pathlib.Path(f"/proc/{self.process.pid}")
        status = dict(line.split(":", 1) for line in (folder / "status").read_text().splitlines())
        held = (int(status["VmRSS"].split()[0]), int(status["Threads"]), len(list((folder / "fd").iterdir())))
        spent = sum(map(int, (folder / "stat").read_text().rpartition(")")[2].split()[11:13]))
        if spent != self.ticks:
            self.ticks, self.still_since = spent, time.monotonic()
        if time.monotonic() - self.still_since > STILL_SECONDS:
            return f"{self.name}: draws no more"
        self.first = self.first or held
        self.most = tuple(map(max, self.most or held, held))
        if self.most[0] > self.first[0] + KIBIBYTES or self.most[1:] != self.first[1:]:
            return f"{self.name}: holds {held} (KiB, threads, files), {self.first} at first"
        return None


def programs(stack, manifest):
    """Those that are there to run, running."""
    wanted = []
    if shutil.which("Xvfb"):
        _, display = stack.enter_context(x_server())
        wanted += [("vkcube", "", display), ("vkcube", "sanitize,sync,count", display), ("vkcubepp", "", display)]
    if shutil.which("weston"):
        _, display = stack.enter_context(wayland_server(stack.enter_context(tempfile.TemporaryDirectory())))
        wanted.append(("vkcube-wayland", "", display))
    return [Program(f"{command} under {tools or 'nothing'}", [command, "--c", FRAMES, "--suppress_popups"],
                    display | {"VK_DRIVER_FILES": manifest, "VITRINE_TOOLS": tools, "VITRINE_LOG": "error"})
            for command, tools, display in wanted if shutil.which(command)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("manifest")
    parser.add_argument("--seconds", type=int, default=3600)
    arguments = parser.parse_args()
    faults = []
    with contextlib.ExitStack() as stack:
        running = programs(stack, arguments.manifest)
        try:
            start = time.monotonic()
            time.sleep(min(30, arguments.seconds / 4))
            while running and not faults and time.monotonic() - start < arguments.seconds:
                faults = [fault for fault in (program.look() for program in running) if fault]
                time.sleep(5)
            for program in running:
                print(f"{program.name}: {program.first} KiB, threads, files at first, {program.most} at most,"
                      f" {program.ticks / os.sysconf('SC_CLK_TCK'):.0f} s of processor time in {time.monotonic() - start:.0f} s")
        finally:
            for program in running:
                program.process.kill()
                program.process.wait()
    if not running:
        print("skipped: neither Xvfb nor weston with vkcube")
        sys.exit(77)
    print(*faults, sep="\n", end="")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
