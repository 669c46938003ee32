#!/usr/bin/env python3
"""Windows of Xlib where libX11-xcb is not installed, as on a bare Debian 11: vulkaninfo makes one and asks about it.

usage: xlib_alone_test.py MANIFEST
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from display_servers import x_server

MANIFEST = sys.argv.pop(1) if len(sys.argv) > 1 else ""


class XlibAlone(unittest.TestCase):
    def test_a_window_has_a_surface(self):
        if not shutil.which("Xvfb") or not shutil.which("vulkaninfo"):
            self.skipTest("needs Xvfb and vulkaninfo")
        _, variables = self.enterContext(x_server())
        with tempfile.TemporaryDirectory() as folder:
            # What is no library hides the one that the system has.
            (pathlib.Path(folder) / "libX11-xcb.so.1").touch()
            result = subprocess.run(["vulkaninfo"], capture_output=True, text=True, check=False,
                                    env={**os.environ, **variables, "VK_DRIVER_FILES": MANIFEST, "LD_LIBRARY_PATH": folder,
                                         "XDG_RUNTIME_DIR": folder, "WAYLAND_DISPLAY": ""})
        self.assertEqual(result.returncode, 0, result.stdout[:300] + result.stderr)
        surfaces = result.stdout.partition("Presentable Surfaces:")[2].partition("Groups:")[0]
        self.assertIn("VK_KHR_xlib_surface", surfaces)
        self.assertIn("FORMAT_B8G8R8A8_UNORM", surfaces)


if __name__ == "__main__":
    unittest.main()
