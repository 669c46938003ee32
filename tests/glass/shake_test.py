#!/usr/bin/env python3
"""Programs whose results depend on the order of their invocations, each with a twin whose result does not: vitrine shake finds all
of the former within 20 seeds, at their command, and nothing in the latter. Usage: shake_test.py VITRINE APPLICATION GLSLANG"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

VITRINE, APPLICATION, GLSLANG = map(os.path.abspath, sys.argv[-3:]) if __name__ == "__main__" else ("", "", "")

HEAD = """#version 450
#extension GL_KHR_memory_scope_semantics : require
layout(local_size_x = SIZE) in;
layout(binding = 0) buffer B { uint data[]; };
layout(binding = 1, r32ui) uniform uimage2D texels;
shared uint s[SIZE];
"""
BODY_LINE = 8
# Name, body that depends on the order, body of the twin. i: the invocation, l: in its workgroup, g: the workgroup.
BODIES = [
    ("last_group_wins", "if (l == 0) data[0] = g;", "if (l == 0) data[g] = g;"),
    ("last_invocation_wins", "data[1] = i;", "data[i] = i;"),
    ("first_to_exchange", "if (atomicCompSwap(data[0], 0u, i + 1) == 0) data[1] = i;", "atomicMax(data[0], i + 1);"),
    ("append", "data[1 + atomicAdd(data[0], 1u)] = i;", "atomicAdd(data[0], 1u); data[1 + i] = i;"),
    ("exchange", "data[1 + i] = atomicExchange(data[0], i);", "data[1 + i] = i; atomicXor(data[0], i);"),
    ("reads_what_others_write", "data[i] = i + data[(i * 7 + 3) % (SIZE * gl_NumWorkGroups.x)];",
     "data[2048 + i] = i + data[(i * 7 + 3) % (SIZE * gl_NumWorkGroups.x)];"),
    ("no_barrier", "s[l] = i + 1; data[i] = s[(l + 1) % SIZE];", "s[l] = i + 1; barrier(); data[i] = s[(l + 1) % SIZE];"),
    ("no_second_barrier", "s[l] = i; barrier(); uint x = s[(l + 5) % SIZE]; s[l] = x * 3; data[i] = s[(l + 3) % SIZE];",
     "s[l] = i; barrier(); uint x = s[(l + 5) % SIZE]; barrier(); s[l] = x * 3; barrier(); data[i] = s[(l + 3) % SIZE];"),
    ("lost_updates", "data[i % 3] = data[i % 3] * 3 + i;", "atomicAdd(data[i % 3], i);"),
    ("texel", "imageStore(texels, ivec2(g % 2, 0), uvec4(i));", "imageStore(texels, ivec2(i % 64, i / 64), uvec4(i));"),
    ("texel_exchange", "data[i] = imageAtomicExchange(texels, ivec2(3, 4), i);", "imageAtomicMin(texels, ivec2(3, 4), i);"),
    ("random_from_a_counter", "uint n = atomicAdd(data[0], 1u); data[1 + i] = n * 1664525u + 1013904223u;",
     "atomicAdd(data[0], 1u); data[1 + i] = i * 1664525u + 1013904223u;"),
    ("last_one_sums", "atomicAdd(data[0], 1u); if (data[0] > SIZE) data[1] += i;", "atomicAdd(data[0], 1u); atomicAdd(data[1], i);"),
]
# Invocations of a workgroup, workgroups.
SHAPES = [(64, 8), (32, 16), (128, 4), (1, 64)]
NEED_WORKGROUPS = ("last_group_wins", "texel")
NEED_INVOCATIONS = ("no_barrier", "no_second_barrier")


def programs():
    for name, bad, good in BODIES:
        for size, groups in SHAPES:
            if size == 1 and name in NEED_INVOCATIONS:
                continue
            yield f"{name}_{size}", size, groups, bad, good


class Shake(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def compile(self, name, size, body):
        source = HEAD.replace("SIZE", str(size)) + "void main() { uint i = gl_GlobalInvocationID.x, l = gl_LocalInvocationID.x, " \
            "g = gl_WorkGroupID.x;\n" + body.replace("SIZE", f"{size}u") + "\n}\n"
        path = self.folder / f"{name}.comp"
        path.write_text(source)
        subprocess.run([GLSLANG, "--quiet", "-V", "-g", "--target-env", "vulkan1.2", str(path), "-o", f"{path}.spv"], check=True)
        return f"{path}.spv"

    def shake(self, *words):
        return subprocess.run([VITRINE, "shake", *words], capture_output=True, text=True, check=False, timeout=600)

    def test_what_depends_on_the_order_is_found(self):
        count = 0
        for name, size, groups, bad, _ in programs():
            with self.subTest(name):
                result = self.shake(f"--json={self.folder}/found.json", "--", APPLICATION,
                                    f"{self.compile(name, size, bad)}:{groups}")
                self.assertEqual(result.returncode, 1, result.stderr)
                (finding,) = json.loads((self.folder / "found.json").read_text())["findings"]
                self.assertEqual(finding["rule"], "order-dependent")
                self.assertEqual(finding["address"]["commandName"], "vkCmdDispatch")
                if name.startswith("texel_") and "exchange" not in name:
                    self.assertIn("of memory at offset", finding["message"])
                else:
                    self.assertIn("of buffer (4 bytes", finding["message"])
                    self.assertIn("written last by invocation", finding["message"])
                    self.assertEqual(finding["address"]["frames"][0]["line"], BODY_LINE)
                count += 1
        self.assertGreaterEqual(count, 50)

    def test_the_last_writer_is_told(self):
        # The tool by itself: word 3 of the first allocation, written by invocations 3 and 67 in this order, and word 100 by none.
        shader = f"{self.compile('writer', 64, 'data[l] = i;')}:2"
        for word, rules in (12, ["last-writer"]), (400, []):
            subprocess.run([VITRINE, "run", "--", APPLICATION, shader], check=True, env={
                **os.environ, "VITRINE_THREADS": "1", "VITRINE_TOOLS": "digest,writers", "VITRINE_DIGEST": f"{self.folder}/d",
                "VITRINE_DIGEST_AT": f"1:8:1:{word}", "VITRINE_REPORT": f"{self.folder}/{word}.json"})
            findings = json.loads((self.folder / f"{word}.json").read_text())["findings"]
            self.assertEqual([finding["rule"] for finding in findings], rules)
            if findings:
                self.assertEqual(findings[0]["address"]["invocation"]["id"], [67, 0, 0])

    def test_twins_are_silent(self):
        words = [f"{self.compile(name, size, good)}:{groups}" for name, size, groups, _, good in programs()]
        result = self.shake("--", APPLICATION, *words)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("with 20 seeds", result.stderr)

    def test_one_seed_runs_once(self):
        result = self.shake("--seed", "7", "--", APPLICATION, f"{self.compile('append', 64, BODIES[3][1])}:8")
        self.assertEqual((result.returncode, result.stderr), (0, "vitrine: seed 7\n"))

    def test_allocations_fail_now_and_then(self):
        shader = f"{self.compile('append', 64, BODIES[3][2])}:8"
        results = [self.shake("--seed", str(seed), "--kinds", "errors", "--", APPLICATION, shader) for seed in range(1, 41)]
        failed = [result for result in results if result.returncode != 0]
        self.assertTrue(0 < len(failed) < len(results))
        for result in failed:
            self.assertIn("vkAllocateMemory: VkResult -2", result.stderr)

    def test_fresh_memory_holds_noise(self):
        def last_digest(seed, body):
            shader = f"{self.compile('fresh', 64, body)}:1"
            subprocess.run([VITRINE, "run", "--", APPLICATION, shader], check=True, env={
                **os.environ, "VITRINE_SHAKE": f"{seed},poison", "VITRINE_TOOLS": "digest", "VITRINE_DIGEST": f"{self.folder}/d"})
            return json.loads((self.folder / "d").read_text().splitlines()[-1])["memory"]["1"]
        for body, same in ("data[i] = s[l];", False), ("s[l] = i; data[i] = s[l];", True):
            self.assertEqual(last_digest(1, body) == last_digest(2, body), same)

    def test_what_cannot_be_shaken_is_told(self):
        result = self.shake("--kinds", "poison", "--", APPLICATION)
        self.assertEqual(result.returncode, 2)
        result = self.shake("--kinds", "order,waves", "--", APPLICATION)
        self.assertEqual(result.returncode, 2)
        self.assertIn("nothing to be shaken is called 'waves'", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
