#!/usr/bin/env python3
"""Tests the prompt of `vitrine debug` with a small application (tests/glass/app/app.cpp).

usage: debug_prompt_test.py VITRINE APPLICATION
"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest


class Prompt(unittest.TestCase):
    vitrine, application = "", ""

    def debug(self, script, *words, arguments=(), typed=False):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "script"
            file.write_text("".join(line + "\n" for line in script))
            source = [] if typed else ["-x", str(file)]
            return subprocess.run([self.vitrine, "debug", *source, *words, "--", self.application, *arguments], text=True,
                                  capture_output=True, check=False, timeout=120,
                                  input=file.read_text() if typed else "", env={**os.environ, "TMPDIR": folder})

    def in_order(self, text, *parts):
        at = 0
        for part in parts:
            found = text.find(part, at)
            self.assertGreaterEqual(found, 0, f"'{part}' is missing behind {at} in\n{text}")
            at = found + len(part)

    def test_script(self):
        result = self.debug(["break fill.comp:8 if i == 5", "run", "print i", "backtrace", "list", "disassemble", "back",
                             "print data", "continue", "continue"])
        self.assertEqual(result.returncode, 0, result.stderr)
        self.in_order(result.stdout, "nothing has run yet", "breakpoint 1: fill.comp:8 if i == 5", "invocation (5, 0, 0)",
                      "submission 1, command 3 (vkCmdDispatch)", "put at tests/glass/app/fill.comp:8", "data[i] = i;",
                      "i = 5", "#0 put at", "#1 main at tests/glass/app/fill.comp:14", ">   data[i] = i;",
                      "fill.comp:8", "main at tests/glass/app/fill.comp:14", "data = {0, 0, 0, 0, 0, 0, 0, 0}", "breakpoint 1")

    def test_what_is_typed(self):
        result = self.debug(["break put", "run", "print i @lanes"], typed=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.in_order(result.stdout, "put at tests/glass/app/fill.comp:8", "lane  invocation", "7     invocation (7, 0, 0)")

    def test_watches_name_commands(self):
        result = self.debug(["break put if i == 0", "run", "delete", "watch data[1]", "watch data[2]", "watch data[3]",
                             "watch data[7]", "continue", "continue", "continue", "continue", "continue"],
                            arguments=["1", "8", "copies"])
        self.assertEqual(result.returncode, 0, result.stderr)
        self.in_order(result.stdout, "watch 2: data[1] has changed: 0 -> 1\n",
                      "watch 2: data[1] has changed: 1 -> 70, by submission 1, command 5 (vkCmdFillBuffer)",
                      "watch 3: data[2] has changed: 2 -> 80, by submission 1, command 6 (vkCmdUpdateBuffer)",
                      "watch 4: data[3] has changed: 3 -> 80, by submission 1, command 8 (vkCmdCopyBuffer)",
                      "invocation (0, 0, 0), lane 0, submission 1, command 10 (vkCmdDispatch)")
        self.assertNotIn("by no shader", result.stdout)
        self.assertNotIn("data[7] has changed", result.stdout)

    def test_json(self):
        result = self.debug(["break main", "run", "step", "nonsense"], "--json")
        rows = [json.loads(line) for line in result.stdout.splitlines() if line.startswith("{")]
        stops = [row["reason"] for row in rows if row.get("event") == "stopped"]
        self.assertEqual(stops, ["start", "breakpoint", "step"])
        self.assertIn("is no command", rows[-3]["text"] + rows[-2]["text"] + rows[-1].get("text", ""))

    def test_several_instances_and_the_end(self):
        result = self.debug(["break main", "run", "continue", "finish", "step"], arguments=["3"])
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout.count("main at tests/glass/app/fill.comp:12"), 3)
        self.in_order(result.stdout, "invocation (0, 0, 0) has ended")

    def test_another_value(self):
        result = self.debug(["tbreak 14 if i == 2u", "run", "set i = 6", "set data[1] = 77", "print data[1]", "whowrote data[1]",
                             "watch data[6]", "continue", "back", "set i = 0", "continue", "continue", "continue"])
        self.assertEqual(result.returncode, 0, result.stderr)
        self.in_order(result.stdout, "i = 6", "from here on this run is another one than without the debugger", "data[1] = 77",
                      "data[1] was set at the prompt", "watch 2: data[6]", "watch 2: data[6] has changed: 0 -> 6",
                      "put at tests/glass/app/fill.comp:8", "this has been done already")

    def test_findings(self):
        result = self.debug(["catch finding", "run", "print i", "continue"], arguments=["1", "12"])
        self.in_order(result.stdout, "caught: finding", "finding: error: store", "[vitrine/out-of-bounds-store]",
                      "put at tests/glass/app/fill.comp:8", "i = ")

    def test_interrupt(self):
        process = subprocess.Popen([self.vitrine, "debug", "--", self.application, "3000"], stdin=subprocess.PIPE, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)
        self.addCleanup(lambda: (process.kill(), process.wait(), process.stdin.close(), process.stdout.close(), process.stderr.close()))
        process.stdin.write("run\n")
        process.stdin.flush()
        self.assertIn("nothing has run yet", process.stdout.readline())
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        self.assertIn("paused", process.stdout.readline())
        process.send_signal(signal.SIGINT)
        text = ""
        while "the shader waits" not in text:
            text += process.stdout.readline()
        self.assertIn("main at tests/glass/app/fill.comp:12", text)
        process.stdin.write("step\nprint i\n")
        process.stdin.flush()
        while "i = " not in text:
            text += process.stdout.readline()
        process.stdin.write("print 41 + 1\ndetach\n")
        process.stdin.flush()
        while "= 42" not in text:
            text += process.stdout.readline()
        time.sleep(0.2)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=60), 128 + signal.SIGTERM)

    def test_nothing_to_follow(self):
        self.assertEqual(self.debug([]).returncode, 0)
        result = self.debug(["run"], "-x", "/nowhere/script", typed=True)
        self.assertEqual(result.returncode, 2)
        self.assertIn("cannot be read", result.stderr)

    def test_the_tool_alone(self):
        result = subprocess.run([self.vitrine, "run", "--", self.application], capture_output=True, text=True, check=False,
                                env={**os.environ, "VITRINE_TOOLS": "debug", "VITRINE_DEBUG": "/nowhere"})
        self.assertEqual(result.returncode, 0)
        self.assertIn("nobody listens", result.stderr)


if __name__ == "__main__":
    Prompt.vitrine, Prompt.application = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1])
