#!/usr/bin/env python3
"""Bug files from the outside: what applications and scenes of the suite draw and dispatch is captured, replayed (the same
bytes, the same findings), reduced and exported; what is no bug file is an error.

usage: bugfile_test.py VITRINE CTS_SUBSET APPLICATION ORDERS PIXELS GLSLANG
"""
import gzip
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

VITRINE, SUITE, APPLICATION, ORDERS, PIXELS, GLSLANG = (str(pathlib.Path(path).resolve()) for path in sys.argv[-6:])
MANIFEST = str(pathlib.Path(VITRINE).parent.parent / "icd" / "vitrine_icd.x86_64.json")
REFERENCE = "/usr/share/vulkan/icd.d/lvp_icd.x86_64.json"
SCENES = ("compute.*:rasterization.random_triangles*:pipeline.random_depth_bounds*:pipeline.random_dynamic_state:"
          "texture.minmax.*:geometry.random*:tessellation.random*:draw.indirect_count.*:draw.multi_draw.*:"
          "draw.random_instance_divisor:descriptors.*:dynamic_rendering.*:renderpass.random*")
NONE = 2**32 - 1  # glass::bug::kNone
MUTABLE = 1000351000  # VK_DESCRIPTOR_TYPE_MUTABLE_EXT
ENDLESS = "#version 450\nlayout(local_size_x = 4) in;\nlayout(binding = 0) buffer B { uint data[]; };\n" \
          "void main() {\n  while (data[0] == 0u) data[1] += 1u;\n}\n"


class BugFileTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_it(self, *words, code=0, **environment):
        result = subprocess.run([str(word) for word in words], capture_output=True, text=True, cwd=self.folder, check=False,
                                env={**os.environ, "VK_DRIVER_FILES": MANIFEST, **environment})
        if code is not None:
            self.assertEqual(result.returncode, code, f"{words}\n{result.stdout}{result.stderr}")
        return result

    def capture(self, what, *words, code=0, **environment):
        """The files of a run, in their order."""
        self.run_it(*words, code=code, VITRINE_CAPTURE=what, VITRINE_CAPTURE_FILE="bug-%n.vitrine", **environment)
        files = sorted(self.folder.glob("bug-*.vitrine"), key=lambda path: int(re.findall(r"\d+", path.name)[0]))
        return files

    def exported(self, file):
        self.run_it(VITRINE, "export", file, "--files", self.folder / "parts")
        return json.loads((self.folder / "parts" / "bug.json").read_text())

    def test_a_dispatch_on_demand_gives_the_same_bytes(self):
        self.run_it(APPLICATION, VITRINE_CAPTURE="1:3")
        bug = self.folder / "bug-1-3.vitrine"
        result = self.run_it(VITRINE, "replay", bug)
        self.assertIn("the same bytes as when it was captured: 32, of which the command changed some", result.stdout)
        self.assertEqual(self.exported(bug)["command"]["groups"], [1, 1, 1])
        self.assertEqual((self.folder / "parts" / "buffer0.after").read_bytes(), bytes(sum(([i, 0, 0, 0] for i in range(8)), [])))

    def test_other_bytes_are_told(self):
        bug, = self.capture("1:3", APPLICATION)
        contents = bytearray(gzip.decompress(bug.read_bytes()))
        length = int.from_bytes(contents[14:22], "little")
        offset, size = json.loads(contents[22:22 + length])["memories"][0]["pieces"][0]["after"]
        self.assertEqual(size, 32)
        contents[22 + length + offset + 4] ^= 255
        bug.write_bytes(gzip.compress(contents))
        result = self.run_it(VITRINE, "replay", bug, code=1)
        self.assertIn("buffer 0 differs: 1 of 32 bytes, the first at offset 4: 01 here, fe in the file", result.stdout)

    def test_a_finding_makes_a_file_and_is_found_again(self):
        command = (VITRINE, "check", "--sanitize", "--json", self.folder / "first.json", APPLICATION, "1", "16")
        bug, = self.capture("finding", *command, code=1)
        self.run_it(VITRINE, "replay", bug, "check", "--sanitize", "--json", self.folder / "again.json", code=1)
        first, again = (json.loads((self.folder / name).read_text())["findings"] for name in ("first.json", "again.json"))
        for finding in first + again:
            finding["address"].pop("submission")
            finding["address"].pop("command")
        self.assertEqual(first, again)
        self.assertEqual(self.exported(bug)["findings"][0]["rule"], "out-of-bounds-store")

    def test_check_writes_files_into_a_folder(self):
        self.run_it(VITRINE, "check", "--sanitize", "--bugs", "bugs", APPLICATION, "1", "16", code=1)
        self.assertEqual([path.name for path in (self.folder / "bugs").iterdir()], ["bug-1-3.vitrine"])

    def test_no_finding_makes_no_file(self):
        self.assertEqual(self.capture("finding", VITRINE, "check", "--sanitize", APPLICATION), [])

    def test_every_draw_of_an_application_gives_the_same_bytes(self):
        bugs = self.capture("all", PIXELS)
        self.assertGreater(len(bugs), 5)
        for bug in bugs:
            self.assertIn("the same bytes", self.run_it(VITRINE, "replay", bug).stdout)

    def test_images_of_several_samples_give_the_same_bytes(self):
        # One draws to all samples, one to some, over what is there.
        drawn = []
        for bug in self.capture("all", PIXELS):
            exported = self.exported(bug)
            images = [image for image in exported["images"] if image["samples"] == 4]
            for image in images if exported["commandName"] == "vkCmdDraw" else []:
                texels, = image["texels"]
                self.assertEqual(texels["before"][1], 4 * 16 * 16 * 4)
                drawn.append(exported["pipeline"])
                self.assertIn("the same bytes as when it was captured: 4096",
                              self.run_it(VITRINE, "replay", bug).stdout)
                self.assertIn("the same bytes", self.run_it(VITRINE, "replay", bug, "check", "--sanitize").stdout)
                if os.path.exists(REFERENCE):
                    self.assertIn("on the device alone that they were captured on",
                                  self.run_it(VITRINE, "replay", bug, "--driver", REFERENCE, code=2).stderr)
        self.assertEqual(drawn, ["samples", "few samples", "by alpha"])

    def test_scenes_of_the_suite_give_the_same_bytes(self):
        bugs = self.capture("all", SUITE, f"--gtest_filter={SCENES}", "--count=1")
        self.assertGreater(len(bugs), 100)
        for bug in bugs[::max(1, len(bugs) // 150)]:
            self.assertIn("the same bytes", self.run_it(VITRINE, "replay", bug).stdout, bug)

    def test_mutable_descriptors_are_what_they_were(self):
        bugs = self.capture("all", SUITE, "--gtest_filter=descriptor_indexing.mutable*", "--count=6")
        changing = 0
        for bug in bugs:
            exported = self.exported(bug)
            self.assertIn("the same bytes", self.run_it(VITRINE, "replay", bug).stdout, bug)
            kinds = {binding["binding"]: binding["type"] for binding in exported["sets"][0]["bindings"]}
            types = {d["binding"]: d["type"] if kinds[d["binding"]] == MUTABLE else kinds[d["binding"]]
                     for d in exported["descriptors"]}
            # A uniform and a storage buffer, a sampled and a storage image, texels and a sampler.
            self.assertEqual(types, {0: 6, 1: 7, 2: 2, 3: 3, 4: 4, 5: 0})
            changing += sum(kind == MUTABLE for kind in kinds.values())
            self.run_it(VITRINE, "export", bug, "--amber", "bug.amber")
            if os.path.exists(REFERENCE):
                self.assertIn("the same bytes", self.run_it(VITRINE, "replay", bug, "--driver", REFERENCE).stdout, bug)
        self.assertGreater(changing, 6)

    def test_rates_of_an_attachment_are_what_they_were(self):
        # Of render passes and of dynamic rendering; the reference has none.
        attached = 0
        for bug in self.capture("all", SUITE, "--gtest_filter=rasterization.random_shading_rate*", "--count=12"):
            exported = self.exported(bug)
            self.assertIn("the same bytes", self.run_it(VITRINE, "replay", bug).stdout, bug)
            rendering = exported.get("rendering")  # none of dispatches
            if not rendering or rendering["rate"] == NONE:
                continue
            attached += 1
            image = exported["images"][exported["views"][rendering["rate"]]["image"]]
            self.assertEqual(image["format"], 13)  # VK_FORMAT_R8_UINT
            self.assertGreaterEqual(rendering["rateTexelWidth"], 8)
            if os.path.exists(REFERENCE):
                self.assertIn("needs VK_KHR_fragment_shading_rate, which this driver lacks",
                              self.run_it(VITRINE, "replay", bug, "--driver", REFERENCE, code=2).stderr)
        self.assertGreater(attached, 2)

    def test_transform_feedback_goes_on_where_it_stood(self):
        # Of the suite on this device and on the reference, some resumed by counters, some drawn by them.
        bugs = self.capture("all", SUITE, "--gtest_filter=transform_feedback.*", "--count=2")
        feeding = {bug: exported["feedback"] for bug in bugs if (exported := self.exported(bug))["feedback"]}
        self.assertGreater(len(feeding), 10)
        self.assertTrue(any(stream["offset"] > 0 for streams in feeding.values() for stream in streams))
        commands = {self.exported(bug)["commandName"] for bug in bugs}
        self.assertIn("vkCmdDrawIndirectByteCountEXT", commands)
        for bug in bugs:
            self.assertRegex(self.run_it(VITRINE, "replay", bug).stdout, "the same bytes", bug)
        if os.path.exists(REFERENCE):
            for bug in list(feeding)[:5]:
                self.assertIn("the same bytes", self.run_it(VITRINE, "replay", bug, "--driver", REFERENCE).stdout, bug)

    def test_a_pixel_makes_a_file_of_what_made_its_value(self):
        # Drawn; copied to what is drawn with; drawn with that.
        for image, command in ("target", "vkCmdDraw"), ("last", "vkCmdDraw"), ("copy", "vkCmdDraw"), ("stored", "vkCmdDispatch"):
            result = self.run_it(VITRINE, "pixel", "5,5", "--image", image, "--bug", "pixel.vitrine", "--", PIXELS)
            told = re.findall(r"\n +at submission (\d+), command (\d+)", result.stdout)
            bug = self.exported(self.folder / "pixel.vitrine")
            self.assertEqual(bug["commandName"], command)
            self.assertIn((str(bug["submission"]), str(bug["commandNumber"])), told)
            self.assertIn("the same bytes", self.run_it(VITRINE, "replay", "pixel.vitrine").stdout)
        # Cleared.
        self.run_it(VITRINE, "pixel", "0,0", "--image", "culled", "--bug", "none.vitrine", "--",
                             PIXELS, code=2)
        self.assertFalse((self.folder / "none.vitrine").exists())

    def test_reduced_shaders_keep_the_place(self):
        bug, = self.capture("finding", VITRINE, "check", "--sanitize", APPLICATION, "1", "16", code=1)
        self.run_it(VITRINE, "reduce", bug, "-o", "small.vitrine", "--tools", "sanitize", "--runs", "60")
        result = self.run_it(VITRINE, "replay", "small.vitrine", "--sanitize", code=1)
        self.assertRegex(result.stderr, r"fill\.comp:8: error: store")
        self.run_it(VITRINE, "reduce", bug, "-o", "smaller.vitrine", "--tools", "sanitize", "--runs", "60", "--any-place")
        self.assertLessEqual((self.folder / "smaller.vitrine").stat().st_size, (self.folder / "small.vitrine").stat().st_size)

    def test_any_tool_looks_at_it(self):
        bug = self.capture("all", PIXELS)[0]
        result = self.run_it(VITRINE, "replay", bug, "count", "-o", self.folder / "counts.json")
        self.assertTrue((self.folder / "counts.json").exists(), result.stderr)

    def test_a_lost_device_makes_a_file_that_loses_it_again(self):
        (self.folder / "endless.comp").write_text(ENDLESS)
        self.run_it(GLSLANG, "-V", "-g", "-o", "endless.spv", "endless.comp")
        bug, = self.capture("lost", ORDERS, "endless.spv:1", code=None, VITRINE_SHADER_BUDGET="100000")
        result = self.run_it(VITRINE, "replay", bug, VITRINE_SHADER_BUDGET="100000")
        self.assertIn("the device is lost, as it was", result.stdout)
        self.run_it(VITRINE, "reduce", bug, "-o", "small.vitrine", VITRINE_SHADER_BUDGET="100000")
        self.assertLess((self.folder / "small.vitrine").stat().st_size, bug.stat().st_size)
        result = self.run_it(VITRINE, "replay", "small.vitrine", VITRINE_SHADER_BUDGET="100000")
        self.assertIn("the device is lost, as it was", result.stdout)

    def test_it_becomes_smaller_and_what_was_found_stays(self):
        bug, = self.capture("finding", VITRINE, "check", "--sanitize", APPLICATION, "1", "16", code=1)
        result = self.run_it(VITRINE, "reduce", bug, "-o", "small.vitrine", "--tools", "sanitize")
        self.assertIn("'out-of-bounds-store' stays", result.stderr)
        small = self.folder / "small.vitrine"
        self.assertLess(small.stat().st_size, bug.stat().st_size)
        result = self.run_it(VITRINE, "replay", small, "--sanitize", code=1)
        self.assertIn("[vitrine/out-of-bounds-store]", result.stderr)
        self.assertIn("the same bytes", result.stdout)

    def test_names_can_be_left_out(self):
        bug, = self.capture("1:3", APPLICATION)
        self.run_it(VITRINE, "export", bug, "--no-names", "-o", "nameless.vitrine")
        self.exported(self.folder / "nameless.vitrine")
        self.assertNotIn(b"fill.comp", (self.folder / "parts" / "comp.spv").read_bytes())
        self.assertIn("the same bytes", self.run_it(VITRINE, "replay", "nameless.vitrine").stdout)

    def test_amber_gets_a_script(self):
        bug, = self.capture("1:3", APPLICATION)
        self.run_it(VITRINE, "export", bug, "--amber", "bug.amber")
        self.assertIn("RUN pipeline 1 1 1", (self.folder / "bug.amber").read_text())

    def test_another_driver_gives_the_same_bytes(self):
        if not os.path.exists(REFERENCE):
            self.skipTest("the reference is not installed")
        bug, = self.capture("1:3", APPLICATION)
        self.assertIn("the same bytes", self.run_it(VITRINE, "replay", bug, "--driver", REFERENCE).stdout)

    def test_a_driver_without_a_feature_says_so(self):
        if not os.path.exists(REFERENCE):
            self.skipTest("the reference is not installed")
        bugs = self.capture("all", SUITE, "--gtest_filter=pipeline.random_depth_bounds/*", "--count=1")
        self.assertTrue(bugs)
        said = [self.run_it(VITRINE, "replay", bug, "--driver", REFERENCE, code=None) for bug in bugs]
        self.assertTrue(any("needs depthBounds, which this driver lacks" in result.stderr for result in said))
        for result in said:
            self.assertIn("the same bytes" if result.returncode == 0 else "lacks", result.stdout + result.stderr)

    def test_what_is_no_bug_file_is_an_error(self):
        bug, = self.capture("1:3", APPLICATION)
        contents = bug.read_bytes()
        broken = self.folder / "broken.vitrine"
        for what in (b"", b"x" * 100, contents[:-9], contents[:20] + b"\0" + contents[21:], contents + b"more"):
            broken.write_bytes(what)
            for words in (["replay"], ["reduce", "-o", "small.vitrine"], ["export", "--amber", "x.amber"]):
                result = self.run_it(VITRINE, words[0], broken, *words[1:], code=2)
                self.assertIn("broken.vitrine: ", result.stderr)
        self.run_it(VITRINE, "replay", self.folder / "nothing.vitrine", code=2)

    def test_wrong_requests_are_told(self):
        result = self.run_it(APPLICATION, VITRINE_CAPTURE="1:3,nonsense")
        self.assertIn("'nonsense' is no command", result.stderr)


if __name__ == "__main__":
    del sys.argv[1:]
    unittest.main()
