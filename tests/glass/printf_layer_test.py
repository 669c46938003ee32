#!/usr/bin/env python3
"""What shaders say is what the validation layer's DebugPrintf makes of it: a dozen pipelines that both can run, on this
driver, with our tool and without the layer, then the other way round. Lines are sorted: the layer has them in the order in
which invocations came by. Usage: printf_layer_test.py SPEAKER MANIFEST"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SPEAKER, MANIFEST = sys.argv[-2:] if __name__ == "__main__" else ("", "")
LAYER = pathlib.Path("/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json")
HEAD = "#version 460\n#extension GL_EXT_debug_printf : require\n#extension GL_ARB_gpu_shader_int64 : enable\n"
COMPUTE = "layout(local_size_x = 4) in;\nvoid main() {\n  int i = int(gl_LocalInvocationID.x);\n  uint u = uint(i);\n"
VERTEX = ("void main() {\n  gl_Position = vec4(4.0 * vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) - 1.0, 0.5, 1.0);\n")
CONTROL = ("layout(vertices = 3) out;\nvoid main() {\n  gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;\n"
           "  gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = gl_TessLevelOuter[2] = gl_TessLevelInner[0] = 2.0;\n")
EVALUATION = ("layout(triangles, equal_spacing) in;\nvoid main() {\n  gl_Position = gl_TessCoord.x * gl_in[0].gl_Position +\n"
              "    gl_TessCoord.y * gl_in[1].gl_Position + gl_TessCoord.z * gl_in[2].gl_Position;\n")
GEOMETRY = ("layout(triangles) in;\nlayout(points, max_vertices = 1) out;\nvoid main() {\n")
FRAGMENT = "void main() {\n"


def say(text, *arguments):
    return f'  debugPrintfEXT({", ".join([chr(34) + text + chr(92) + "n" + chr(34), *arguments])});\n'


def compute(*messages):
    return {"comp": COMPUTE + "".join(messages) + "}\n"}


PIPELINES = {
    "signed integers": compute(say("%d %i|%5d|%-5d|%+d|%05d|% d", *["i - 2"] * 7), say("%.3d|%6.3d", "i", "-i")),
    "unsigned integers": compute(say("%u %x %X %o", *["u * 1000u + 171u"] * 4), say("%8u|%-8u|%08x|%#x|%#o", *["u + 9u"] * 5)),
    "floats": compute(say("%f %e %g %a", *["float(i) * 1.25 - 1.0"] * 4), say("%F %E %G %A", *["float(i) / 3.0"] * 4)),
    "widths and precisions": compute(say("%1.2f|%10.3f|%-10.1f|%+.0f|%010.4f|%.8g", *["float(i) * 1.37 - 2.0"] * 6)),
    "vectors": compute(say("%v2f|%v3f|%v4f", "vec2(i, 0.5)", "vec3(i, 2, 3.5)", "vec4(0.25 * i)"),
                       say("%v2d|%v3d|%v4d", "ivec2(-i)", "ivec3(i, -1, 7)", "ivec4(i)")),
    "vectors with modifiers": compute(say("%1.2v4f|%6.1v2f", "vec4(i, 1, 2, 3)", "vec2(i)"), say("%v2u|%v3x|%v4u", "uvec2(u)", "uvec3(u + 170u)", "uvec4(u, 1, 2, 3)")),
    # Not "%ul": the layer has it in hexadecimal, against its own documentation.
    "64 bits": compute(say("%lu %lx", *["uint64_t(u) * 0x123456789aul + 5ul"] * 2)),
    "nothing but text": compute(say("plain"), say("100%% of it"), say("a %d%%", "i")),
    "one invocation": compute("  if (i == 2) {\n  " + say("only %d %f", "i", "float(i)") + "  }\n"),
    "booleans": compute(say("%d %u", "int(i < 2)", "uint(i == 3)")),
    "a loop": compute("  for (int k = 0; k < i; ++k)\n  " + say("%d of %d", "k", "i")),
    "vertices and fragments": {
        "vert": VERTEX + say("vertex %d at %v4f", "gl_VertexIndex", "gl_Position") + "}\n",
        "frag": FRAGMENT + say("fragment %v2f %u", "gl_FragCoord.xy", "uint(gl_FragCoord.x) * 4u") + "}\n"},
    "tessellation": {
        "vert": VERTEX + "}\n", "tesc": CONTROL + say("control %d of %d", "gl_InvocationID", "gl_PrimitiveID") + "}\n",
        "tese": EVALUATION + say("evaluation %1.3v3f", "gl_TessCoord") + "}\n", "frag": FRAGMENT + "}\n"},
    "geometry": {
        "vert": VERTEX + "}\n", "frag": FRAGMENT + "}\n",
        "geom": GEOMETRY + say("triangle %d from %v2f", "gl_PrimitiveIDIn", "gl_in[1].gl_Position.xy") +
                "  gl_Position = vec4(0.0);\n  gl_PointSize = 1.0;\n  EmitVertex();\n}\n"},
}
# Newer layers have their own names of variables.
WITH_LAYER = {"VK_INSTANCE_LAYERS": "VK_LAYER_KHRONOS_validation", "DEBUG_PRINTF_TO_STDOUT": "1", "VK_LAYER_PRINTF_TO_STDOUT": "1",
              "VK_LAYER_PRINTF_BUFFER_SIZE": "65536",
              "VK_LAYER_ENABLES": "VK_VALIDATION_FEATURE_ENABLE_DEBUG_PRINTF_EXT"}


def lines_of(files, environment):
    """Sorted; None if the layer does not know a format, as newer ones do not know all flags of printf()."""
    result = subprocess.run([SPEAKER, *files], capture_output=True, text=True, check=False,
                            env={**os.environ, "VK_DRIVER_FILES": MANIFEST, **environment})
    if result.returncode != 0:
        raise AssertionError(f"{files}: exit code {result.returncode}\n{result.stdout}{result.stderr}")
    # Newer layers say on the same way what they think of settings, in paragraphs.
    said = re.sub(r"(?ms)^Validation \w+: \[.*?^\n", "", result.stdout)
    if "DEBUG-PRINTF-FORMATTING" in result.stdout:
        return None
    return sorted(line for line in said.splitlines() if line)


@unittest.skipUnless(LAYER.exists(), "the validation layer is not installed")
class PrintfTest(unittest.TestCase):
    def test_texts_are_those_of_the_layer(self):
        compared = 0
        for name, shaders in PIPELINES.items():
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                files = []
                for stage, text in shaders.items():
                    source = pathlib.Path(folder) / f"shader.{stage}"
                    source.write_text(HEAD + text)
                    files.append(f"{source}.spv")
                    subprocess.run(["glslangValidator", "-V", "--quiet", "--target-env", "vulkan1.1", "-o", files[-1], str(source)],
                                   check=True)
                ours = lines_of(files, {"VITRINE_PRINTF": "stdout"})
                self.assertTrue(ours)
                theirs = lines_of(files, WITH_LAYER)
                if theirs is not None:
                    self.assertEqual(ours, theirs)
                    compared += 1
        self.assertGreaterEqual(compared, 8)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
