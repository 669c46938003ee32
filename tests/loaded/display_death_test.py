#!/usr/bin/env python3
"""Kills the display server of programs that present: they get an error, and neither crash in the driver nor hang.

usage: display_death_test.py MANIFEST
"""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

MANIFEST = sys.argv.pop(1) if len(sys.argv) > 1 else ""
FRAMES = "1000000"
# vkcube asserts that there is no error, and so ends by SIGABRT.
OWN_ENDS = (0, 1, -signal.SIGABRT)


class DisplayDeath(unittest.TestCase):
    def end_of(self, program, server, variables, seconds):
        """How the program ends when the server is killed after a while."""
        application = subprocess.Popen([program, "--c", FRAMES], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                       env=dict(os.environ, VK_DRIVER_FILES=MANIFEST) | variables)
        try:
            time.sleep(seconds)
            self.assertIsNone(application.poll(), "it ended before the server did")
            server.kill()
            return application.wait(60)
        finally:
            application.kill()
            application.wait()

    def serve(self, *command, **settings):
        server = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **settings)
        self.addCleanup(server.wait)
        self.addCleanup(server.kill)
        return server

    def test_x(self):
        if not shutil.which("Xvfb") or not shutil.which("vkcube"):
            self.skipTest("needs Xvfb and vkcube")
        for seconds in (1.5, 1.6, 1.8, 1.9, 2.1, 2.2):
            read, write = os.pipe()
            server = self.serve("Xvfb", "-displayfd", str(write), "-screen", "0", "640x480x24", pass_fds=[write])
            display = os.read(read, 20).decode().strip()
            self.assertIn(self.end_of("vkcube", server, {"DISPLAY": f":{display}"}, seconds), OWN_ENDS)

    def test_wayland(self):
        if not shutil.which("weston") or not shutil.which("vkcube-wayland"):
            self.skipTest("needs weston and vkcube-wayland")
        for seconds in (1.5, 1.8, 2.2):
            folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
            variables = {"XDG_RUNTIME_DIR": str(folder), "WAYLAND_DISPLAY": "of-test"}
            server = self.serve("weston", "--backend=headless-backend.so", "--socket=of-test", "--idle-time=0",
                                env=dict(os.environ, XDG_RUNTIME_DIR=str(folder)))
            while not (folder / "of-test").exists():
                self.assertIsNone(server.poll(), "weston does not start")
                time.sleep(0.05)
            self.assertIn(self.end_of("vkcube-wayland", server, variables, seconds), OWN_ENDS)


unittest.main()
