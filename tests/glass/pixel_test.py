#!/usr/bin/env python3
"""Tests the tool `pixel` and the command `vitrine pixel` with a small application (tests/glass/app/pixels.cpp) that draws
fragments of all fates and moves what they leave through copies, blits, a resolve, a second pass and a compute shader.

usage: pixel_test.py VITRINE APPLICATION
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

FATES = {"written", "not written", "scissor", "depth", "stencil", "depth bounds", "discarded", "shader mask",
         "sample mask", "alpha to coverage"}
KINDS = {"clear", "undefined", "fragment", "store", "copy", "blit", "resolve", "upload"}


class Pixel(unittest.TestCase):
    vitrine, application = "", ""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def run_it(self, *words, application=None, arguments=(), **environment):
        return subprocess.run([self.vitrine, "pixel", *words, "--", application or self.application, *arguments],
                              capture_output=True, text=True, check=False, cwd=self.path,
                              env={**os.environ, "TMPDIR": self.folder.name, **environment})

    def story(self, *words, **environment):
        """What the command tells, without what the application prints."""
        result = self.run_it(*words, **environment)
        self.assertEqual(result.returncode, 0, result.stderr)
        printed = re.compile(r"[a-z]+ \d+ \d+ \d+ 0x[0-9a-f]{8}$")
        return "\n".join(line for line in result.stdout.splitlines() if not printed.match(line))

    def record(self, requests, **environment):
        """What the tool alone records, and what the application prints."""
        file = self.path / "history.json"
        result = subprocess.run([self.vitrine, "run", "--", self.application], capture_output=True, text=True, check=True,
                                env={**os.environ, "VITRINE_TOOLS": "pixel", "VITRINE_PIXEL": requests,
                                     "VITRINE_PIXEL_HISTORY": str(file), **environment})
        return json.loads(file.read_text()), result.stdout, file.read_bytes()

    def test_last_event_of_every_texel_is_what_the_texel_holds(self):
        history, printed, _ = self.record("0,0-15,15:image=*;0,0-15,15:image=*:level=1")
        names = {image["number"]: image.get("name", "") for image in history["images"]}
        values = {}
        for texel in history["texels"]:
            key, last = texel["texel"], None
            for event in texel["events"]:
                self.assertNotEqual(event["kind"], "unknown", (key, event))
                if "before" in event and last is not None:
                    self.assertEqual(event["before"], last, (key, event))
                last = event.get("after", last)
            if key["aspect"] == "color" and key["sample"] == 0:
                values[names[key["image"]], key["level"], key["x"], key["y"]] = last
        lines = printed.split("\n")[:-1]
        self.assertEqual(len(lines), 8 * 256 + 64)
        for line in lines:
            name, level, x, y, value = line.split()
            self.assertTrue(values[name, int(level), int(x), int(y)].endswith(value), line)

    def test_the_application_draws_the_same(self):
        plain = subprocess.run([self.vitrine, "run", "--", self.application], capture_output=True, text=True, check=True)
        for requests in ("0,0-15,15:image=*", "5,5:image=target", "900,900:image=target"):
            self.assertEqual(self.record(requests)[1], plain.stdout)

    def test_every_fate_and_kind_of_event_is_told(self):
        history, _, _ = self.record("5,5:image=*;2,2:image=mips:level=1")
        events = [event for texel in history["texels"] for event in texel["events"]]
        self.assertEqual({event["fate"] for event in events if "fate" in event}, FATES)
        self.assertEqual({event["kind"] for event in events}, KINDS)

    def test_histories_do_not_depend_on_threads_or_other_tools(self):
        requests = "0,0-15,15:image=*"
        one = self.record(requests, VITRINE_THREADS="1")[2]
        self.assertEqual(one, self.record(requests, VITRINE_THREADS="4")[2])
        both = self.record(requests, VITRINE_TOOLS="count,pixel", VITRINE_COUNTS=str(self.path / "c.json"))[2]
        self.assertEqual(one, both)

    def test_fragments_are_told_of_with_their_tests_and_places(self):
        text = self.story("5,5", "--image", "target")
        self.assertIn("is discarded by the shader\n     17 |     discard;", text)
        self.assertIn("tests/glass/app/pixels.frag:17: fragment of primitive 0", text)
        self.assertRegex(text, r"fails the depth test\n.*\n.*\n     depth 0.75\n     stored depth \(0.25\)")
        self.assertIn("in 'scene' > 'fates', pipeline 'blended'", text)
        self.assertIn("output (0, 0, 1, 0.5)", text)
        self.assertIn("(1, 0, 0, 1) = 0xff0000ff -> (0.498039246, 0, 0.501960814, 1) = 0xff80007f", text)
        self.assertIn("cleared\n     at submission 1", self.story("1,1", "--image", "target"))

    def test_instances_are_told_of_draws_with_several(self):
        text = self.story("5,5", "--image", "samples", "--sample", "1")
        self.assertIn("fragment of primitive 0 (back-facing triangle) is written", text)
        self.assertLess(text.index("fragment of primitive 0 of instance 5 (back-facing triangle) is written"),
                        text.index("fragment of primitive 0 of instance 6 (back-facing triangle) is written"))

    def test_instances_are_told_behind_tessellation_and_geometry_shaders(self):
        for image, primitive in (("tessellated", 0), ("emitted", 10)):
            text = self.story("5,5", "--image", image, "--depth=0")
            places = [text.index(f"fragment of primitive {primitive} of instance {instance} (") for instance in (4, 5, 6)]
            self.assertEqual(places, sorted(places))
            self.assertEqual(text.count("fragment of"), 3)

    def test_depth_has_a_history_of_its_own(self):
        text = self.story("5,5", "--image=depth", "--aspect=depth")
        self.assertIn("(0.5) = 0x3f000000 -> (0.25) = 0x3e800000", text)

    def test_sources_are_followed_to_the_shaders_that_made_them(self):
        text = self.story("5,5", "--image", "last", "--depth", "6")
        for part in ("from [a] texel (2, 2), level 1 of image #5 'mips'", "texel (5, 5) of image #3 'resolved'",
                     "blitted from other texels", "weight 0.25", "resolved from the samples of an attachment",
                     "copied from another texel", "pipeline 'few samples'", "pipeline 'blended'"):
            self.assertIn(part, text)
        self.assertNotIn("does not do the same", text)
        self.assertNotIn("not all sources", text)

    def test_depth_limits_how_far_sources_are_followed(self):
        self.assertNotIn("[a]", self.story("5,5", "--image", "last", "--depth", "0"))
        text = self.story("5,5", "--image", "last", "--depth", "1")
        self.assertIn("[a]", text)
        self.assertNotIn("'copy' (", text)

    def test_stores_name_their_line(self):
        text = self.story("5,5", "--image", "stored")
        self.assertIn("tests/glass/app/pixels.comp:9: store of a shader\n     9 |   imageStore(to, at, texel.bgra);", text)
        self.assertIn("invocation (5, 5, 0)", text)
        self.assertIn("copied from bytes at offset 340 of buffer", text)

    def test_chains_lead_through_buffers(self):
        text = self.story("5,6", "--image", "staged", "--depth", "3")
        self.assertRegex(text, r"copied from bytes at offset \d+ of buffer")
        self.assertRegex(text, r"copied to the buffer at submission 1, command \d+ \(vkCmdCopyImageToBuffer\)")
        self.assertIn("from [a] texel (5, 6) of image #6 'last'", text)
        self.assertIn("[a] texel (5, 6) of image #6 'last'", text)
        self.assertIn("pipeline 'sampling'", text)
        self.assertNotIn("undefined", text[text.index("\n[a]"):text.index("\n[b]")].split("cleared")[1])

    def test_inputs_of_shaders_are_told(self):
        text = self.story("5,5", "--image", "target")
        self.assertIn("input place (-0.3125, -0.3125)\n     input numbers.y (0)\n", text)
        self.assertNotIn("no shader ran", text[text.index("is discarded by the shader"):text.index("pipeline 'masked'")])

    def test_inputs_have_their_names_in_files_too(self):
        self.story("5,5", "--image", "target", "--depth=0", "--json", "story.json", "--html", "story.html")
        history = json.loads((self.path / "story.json").read_text())
        facts = [fact for texel in history["texels"] for event in texel["events"] for fact in event.get("facts", [])]
        for fact in (["input place", "(-0.3125, -0.3125)"], ["input numbers.y", "(0)"], ["input gl_FragCoord", "(5.5, 5.5)"]):
            self.assertIn(fact, facts)
        self.assertIn('<li>input numbers.y <span class="v">(0)</span></li>', (self.path / "story.html").read_text())

    def test_inputs_are_told_of_fragments_that_no_shader_runs_for(self):
        text = self.story("5,5", "--image", "target", "--depth=0")
        told = "no shader ran for it; its inputs would be\n     input place (-0.3125, -0.3125)\n     input numbers.y (0)\n"
        for fate in ("is outside of the scissor", "fails the depth test"):
            self.assertIn(told, text[text.index(fate):].split("fragment of")[0], fate)
        alone = text[text.index("pipeline 'depth alone'"):].split("cleared")[0]
        self.assertIn("no shader ran as the draw has none", alone)
        self.assertNotIn("input", alone)
        few = self.story("5,5", "--image", "samples", "--sample=0", "--depth=0")
        few = few[few.index("is not in the pipeline's sample mask"):]
        self.assertNotIn("no shader ran", few.split("fragment of")[0])


    def test_an_application_that_draws_something_else_every_time_is_found_out(self):
        result = self.run_it("5,5", "--image=last", arguments=["runs"])
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("does not draw the same in every run", result.stderr)
        self.assertNotIn("does not draw the same", self.run_it("5,5", "--image=last").stderr)

    def test_why_not(self):
        text = self.story("5,5", "--image=target", "--why-not=0", "--depth=0")
        text = text[text.index("why not primitive 0:"):]
        self.assertIn("primitive 0 is rasterized", text)
        self.assertIn("fails the depth test; depth 0.75; stored depth (0.25)", text)
        self.assertIn("is outside of the scissor", text)
        self.assertIn("no draw to the pixel's image has primitive 7",
                      self.story("5,5", "--image=target", "--why-not=7", "--depth=0"))
        facing = self.story("5,5", "--image=culled", "--why-not=0", "--depth=0")
        self.assertIn("primitive 0 is culled because of where it faces", facing)
        self.assertIn("primitive 0 is rasterized, 3 times\n     at submission 1", facing)
        self.assertIn("but does not cover the pixel", facing)

    def test_why_not_names_instances(self):
        def why(image, primitive):
            text = self.story("5,5", f"--image={image}", f"--why-not={primitive}", "--depth=0",
                              f"--sample={int(image == 'samples')}")
            return text[text.index("why not primitive"):]
        text = why("samples", 0)
        self.assertIn("primitive 0 of instances 5, 6 is rasterized, 4 times", text)
        self.assertIn("fragment of primitive 0 of instance 5 (back-facing triangle) is written", text)
        self.assertIn("  primitive 0 is rasterized, 2 times\n", text)  # of the draws of instance 0 alone
        text = why("samples", "0@6")
        self.assertIn("why not primitive 0 of instance 6:", text)
        self.assertIn("  primitive 0 of instance 6 is rasterized, 2 times\n", text)
        self.assertNotIn("instance 5", text)
        self.assertNotIn("primitive 0 is", text)
        text = why("samples", "0@0")
        self.assertIn("  primitive 0 is rasterized, 2 times\n", text)
        self.assertIn("fragment of primitive 0 (back-facing triangle)", text)
        self.assertNotIn("of instance 5", text)
        self.assertIn("no draw to the pixel's image has primitive 0 of instance 9", why("samples", "0@9"))
        self.assertRegex(why("tessellated", 0), r"primitive 0 of instances 4 to 6 is \w+")
        self.assertIn("primitive 10 of instances 4 to 6 is rasterized", why("emitted", 10))
        self.assertIn("primitive 10 of instance 5 is rasterized", why("emitted", "10@5"))
        result = self.run_it("5,5", "--image=target", "--why-not=x")
        self.assertEqual(result.returncode, 2)
        self.assertIn("'x' is no primitive", result.stderr)

    def test_files(self):
        self.story("5,5", "--image=last", "--html=page.html", "--json=history.json")
        page = (self.path / "page.html").read_text()
        self.assertIn("<a href=\"#a\">[a]</a>", page)
        self.assertIn("fragment of primitive", page)
        self.assertNotIn("http", page)
        self.assertEqual(json.loads((self.path / "history.json").read_text())["format"], "vitrine-pixel")

    def test_wrong_use(self):
        for words in (["x"], ["1;2"], ["-1,2"], ["1,2,3"]):
            self.assertEqual(self.run_it(*words).returncode, 2, words)
        result = self.run_it("5,5", "--image", "no such image")
        self.assertEqual(result.returncode, 2)
        self.assertIn("#1 'target': R8G8B8A8_UNORM, 16 x 16 x 1", result.stderr)
        self.assertEqual(self.run_it("16,5", "--image", "target").returncode, 2)
        self.assertEqual(self.run_it("5,5", application="true").returncode, 2)
        self.assertEqual(self.run_it("5,5").returncode, 2)  # it has no swapchain

    def test_requests_that_cannot_be_read_are_said(self):
        for requests in ("5", "5,5:image", "5,5:level=x", "5,5:aspect=blue", "5,5-"):
            result = subprocess.run([self.vitrine, "run", "--", self.application], capture_output=True, text=True,
                                    check=True, cwd=self.path,
                                    env={**os.environ, "VITRINE_TOOLS": "pixel", "VITRINE_PIXEL": requests})
            self.assertIn("names no texels", result.stderr)


if __name__ == "__main__":
    Pixel.vitrine, Pixel.application = sys.argv[1:3]
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
