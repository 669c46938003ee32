#!/usr/bin/env python3
"""Applications that are right run with every tool, and no tool finds a fault: Debian's demos in a window under Xvfb, and a capture
of one that gfxreconstruct replays. Usage: silence_test.py VITRINE MANIFEST
Exit status 77: the demos or Xvfb are not installed."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

VITRINE, MANIFEST = map(os.path.abspath, sys.argv[-2:]) if __name__ == "__main__" else ("", "")
TOOLS = "sanitize,race,sync,numbers,printf,coverage,count,timeline"
DISPLAY = ["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24"]


class Silence(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def run_it(self, *words, **environment):
        result = subprocess.run([*DISPLAY, *words], capture_output=True, text=True, check=False, cwd=self.folder, timeout=600,
                                env={**{k: v for k, v in os.environ.items() if k != "WAYLAND_DISPLAY"}, **environment})
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result.stderr

    def check_it(self, *application, tools=TOOLS):
        said = self.run_it(VITRINE, "check", "--tools", tools, "--json=found.json", "--", *application)
        self.assertEqual(json.loads((self.folder / "found.json").read_text())["findings"], [])
        self.assertIn("no findings in 1 process", said)

    def test_demos(self):
        for demo in ("vkcube", "vkcubepp"):
            with self.subTest(demo):
                self.check_it(demo, "--c", "300")

    def test_replay_of_a_capture(self):
        if not shutil.which("gfxrecon-replay"):
            self.skipTest("gfxreconstruct is missing")
        self.run_it("vkcube", "--c", "30", VK_DRIVER_FILES=MANIFEST, VK_INSTANCE_LAYERS="VK_LAYER_LUNARG_gfxreconstruct",
                    GFXRECON_CAPTURE_FILE="cube.gfxr", GFXRECON_CAPTURE_FILE_TIMESTAMP="false")
        # The program's own blit to the window lacks VK_ACCESS_TRANSFER_READ_BIT in its barrier, as the layer says, too.
        self.check_it("gfxrecon-replay", "cube.gfxr", tools=TOOLS.replace(",sync", ""))


if __name__ == "__main__":
    if not all(shutil.which(name) for name in ("xvfb-run", "vkcube", "vkcubepp")):
        print("xvfb-run, vkcube or vkcubepp is not installed")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
