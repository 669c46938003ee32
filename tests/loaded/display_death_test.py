#!/usr/bin/env python3
"""Kills the display server of programs that present: they get an error, and neither crash in the driver nor hang.

usage: display_death_test.py MANIFEST
"""
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from display_servers import wayland_server, x_server

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

    def test_x(self):
        if not shutil.which("Xvfb") or not shutil.which("vkcube"):
            self.skipTest("needs Xvfb and vkcube")
        for seconds in (1.5, 1.6, 1.8, 1.9, 2.1, 2.2):
            server, variables = self.enterContext(x_server())
            self.assertIn(self.end_of("vkcube", server, variables, seconds), OWN_ENDS)

    def test_wayland(self):
        if not shutil.which("weston") or not shutil.which("vkcube-wayland"):
            self.skipTest("needs weston and vkcube-wayland")
        for seconds in (1.5, 1.8, 2.2):
            server, variables = self.enterContext(wayland_server(self.enterContext(tempfile.TemporaryDirectory())))
            self.assertIn(self.end_of("vkcube-wayland", server, variables, seconds), OWN_ENDS)


unittest.main()
