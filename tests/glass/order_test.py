#!/usr/bin/env python3
"""What tools write is the same with any number of threads and on every SIMD target: findings, coverage and counters (by
line, by draw) of a part of the conformance suite, messages and counters of pipelines that speak; byte by byte. The
timeline is about time and left out. Usage: order_test.py [--all] CTS_SUBSET SPEAKER MANIFEST; --all: every setting, and
cases of all groups"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ALL = "--all" in sys.argv
SUITE, SPEAKER, MANIFEST = (str(pathlib.Path(path).resolve()) for path in sys.argv[-3:])
CASES = ["--gtest_filter=compute.*:glsl.random_control_flow*:glsl.random_arithmetic*:tessellation.*:geometry.*:"
         "rasterization.random_triangles*:pipeline.random_depth_bounds*"]
SETTINGS = {"one thread": {"VITRINE_THREADS": "1"},
            "two threads, the oldest SIMD target": {"VITRINE_THREADS": "2", "VITRINE_TARGET": "sse4"},
            "four threads": {"VITRINE_THREADS": "4"}}
if ALL:
    CASES = ["--count=2"]
    SETTINGS = {f"{threads} threads, {target or 'the best target'}":
                    {"VITRINE_THREADS": threads, **({"VITRINE_TARGET": target} if target else {})}
                for threads in ("1", "2", "4") for target in ("", "sse4", "avx2")}
HEAD = "#version 460\n#extension GL_EXT_debug_printf : require\n"
PIPELINES = {
    "compute": {"comp": "layout(local_size_x = 96) in;\nshared uint sum;\nvoid main() {\n  uint i = gl_GlobalInvocationID.x;\n"
                        "  if (i % 3u == 1u) debugPrintfEXT(\"%u of group %u\\n\", i, gl_WorkGroupID.x);\n  barrier();\n"
                        "  for (uint k = 0u; k < i % 5u; ++k) debugPrintfEXT(\"%u: %u\\n\", i, k);\n}\n"},
    "draw": {"vert": "void main() {\n  gl_Position = vec4(4.0 * vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) - 1.0, 0.5, 1.0);\n"
                     "  debugPrintfEXT(\"vertex %d of %d\\n\", gl_VertexIndex, gl_InstanceIndex);\n}\n",
             "frag": "void main() {\n  ivec2 at = ivec2(gl_FragCoord.xy);\n"
                     "  if ((at.x & 15) == 3 && (at.y & 7) == 5) debugPrintfEXT(\"pixel %v2d\\n\", at);\n"
                     "  if (at.x > 100) discard;\n}\n"},
    "patches of instances": {
        "vert": "layout(location = 0) out int instance;\nvoid main() {\n  gl_Position = vec4(0.1 * gl_VertexIndex);\n"
                "  instance = gl_InstanceIndex;\n}\n",
        "tesc": "layout(vertices = 3) out;\nlayout(location = 0) in int instance[];\nlayout(location = 0) out int next[];\nvoid main() {\n"
                "  gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = gl_TessLevelInner[0] = 12.0;\n"
                "  next[gl_InvocationID] = instance[gl_InvocationID];\n"
                "  debugPrintfEXT(\"vertex %d of %d\\n\", gl_InvocationID, instance[gl_InvocationID]);\n}\n",
        "tese": "layout(triangles) in;\nlayout(location = 0) in int instance[];\nvoid main() {\n  gl_Position = vec4(gl_TessCoord, sqrt(gl_TessCoord.x - 2.0));\n"
                "  debugPrintfEXT(\"point %v3f of %d\\n\", gl_TessCoord, instance[0]);\n}\n",
        "frag": "void main() {\n}\n"},
}


def outputs(folder, setting, command):
    """Runs a command with all tools; what the tools wrote, by file name."""
    files = {"VITRINE_REPORT": folder / "found.json", "VITRINE_COVERAGE": folder / "lines.info",
             "VITRINE_COUNTS": folder / "counts.json", "VITRINE_PRINTF": folder / "said.txt"}
    environment = {**os.environ, **setting, "VITRINE_TOOLS": "sanitize,race,sync,numbers,printf,coverage,count",
                   "VITRINE_COUNT_LINES": "1", "VITRINE_COUNT_DRAWS": "1", "VITRINE_SOURCES": str(folder / "sources"),
                   "VK_DRIVER_FILES": MANIFEST, **{name: str(file) for name, file in files.items()}}
    subprocess.run(command, check=True, capture_output=True, env=environment, cwd=folder)
    return {file.name: file.read_bytes().replace(str(folder).encode(), b"FOLDER") for file in files.values() if file.exists()}


class OrderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def assert_same(self, name, make_command):
        """What is written in the first setting, which is what is written in all."""
        expected = None
        for number, (setting, variables) in enumerate(SETTINGS.items()):
            place = self.folder / f"{name}{number}"
            place.mkdir()
            found = outputs(place, variables, make_command(place))
            expected = expected or found
            self.assertEqual(found.keys(), expected.keys(), setting)
            for file, text in found.items():
                self.assertEqual(text, expected[file], f"{file} of {name} with {setting}")
        return expected

    def test_cases_of_the_suite(self):
        written = self.assert_same("suite", lambda place: [SUITE, "--validation=0", f"--fingerprints={place / 'fingerprints'}", *CASES])
        for file in ("found.json", "lines.info", "counts.json"):
            self.assertGreater(len(written[file]), 1000, f"{file} has next to nothing in it")

    def test_messages_of_many_invocations(self):
        for name, shaders in PIPELINES.items():
            files = []
            for stage, text in shaders.items():
                source = self.folder / f"{name}.{stage}"
                source.write_text(HEAD + text)
                files.append(f"{source}.spv")
                subprocess.run(["glslangValidator", "-g", "--target-env", "vulkan1.1", "-V", source, "-o", files[-1]],
                               check=True, capture_output=True)
            written = self.assert_same(name, lambda place, files=files: [SPEAKER, "--many", *files])
            self.assertGreater(len(written["said.txt"].splitlines()), 1000)
            if "tese" in shaders:
                self.assertIn(b'"kind":"evaluation","id":[0,0,0]', written["found.json"].replace(b" ", b""))
            self.assertIn(b'"draws"' if "vert" in shaders else b'"lines"', written["counts.json"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
