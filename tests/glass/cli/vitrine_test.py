#!/usr/bin/env python3
"""Tests the command `vitrine` from the outside: applications here are shell scripts that write what the driver would,
and a small one (tests/glass/app) that runs on the driver.

usage: vitrine_test.py VITRINE MANIFEST APPLICATION [--sarif-schema FILE]
With the public schema of SARIF 2.1.0 (sarif-schema-2.1.0.json of OASIS) and python3-jsonschema, reports are held
against that, too; VITRINE_SARIF_SCHEMA names it as well.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

STORE = {"rule": "out-of-bounds-store", "severity": "error", "message": "store past the end", "count": 2,
         "address": {"submission": 1, "command": 3, "commandName": "vkCmdDispatch", "labels": ["blur"], "stage": "compute",
                     "shader": "main", "invocation": {"kind": "compute", "id": [5, 0, 0]}, "spirvId": 42,
                     "frames": [{"function": "put", "file": "a b.comp", "line": 12, "column": 3, "text": "  a[i] = x;"},
                                {"function": "main", "file": "/src/a.comp", "line": 30}]}}
NOTE = {"rule": "printf", "severity": "note", "message": "x = 3", "count": 1, "address": {}}
WARNING = {"rule": "infinity", "severity": "warning", "message": "1/0", "count": 1, "address": {"spirvId": 7}}


def report(*findings):
    return json.dumps({"format": "vitrine-findings", "version": 1, "findings": findings})


class Command(unittest.TestCase):
    vitrine, manifest, small_application, schema = "", "", "", None

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def run_it(self, *words, **environment):
        return subprocess.run([self.vitrine, *words], capture_output=True, text=True, cwd=self.folder, check=False,
                              env={**os.environ, "TMPDIR": str(self.folder), **environment})

    def application(self, variable, *processes, end="exit 0"):
        """A script of several processes that each write a text into the file that a variable names."""
        for i, text in enumerate(processes):
            (self.folder / f"text{i}").write_text(text)
        lines = [f'sh -c \'cat "{self.folder}/text{i}" >"$(echo "${variable}" | sed s/%p/$$/)"\'' for i in range(len(processes))]
        return ["sh", "-c", "; ".join([*lines, end])]

    def check_it(self, *words, findings, end="exit 0"):
        return self.run_it("check", "--tools=printf", *words, "--", *self.application("VITRINE_REPORT", *findings, end=end))

    def test_run_uses_this_driver_and_keeps_the_application_as_it_is(self):
        result = self.run_it("run", "sh", "-c", 'echo "$VK_DRIVER_FILES" "$VK_ICD_FILENAMES"; cat; exit 4')
        self.assertEqual((result.returncode, result.stdout), (4, f"{self.manifest} {self.manifest}\n"))
        self.assertEqual(result.stderr, "vitrine: sh ended with exit code 4\n")

    def test_arguments_of_the_application_are_its_own(self):
        for words in (["run", "--"], ["run"]):
            result = self.run_it(*words, "echo", "--help", "--", "-o", "x")
            self.assertEqual((result.returncode, result.stdout), (0, "--help -- -o x\n"))

    def test_wrong_use_could_not_run(self):
        for words in ([], ["no-such-command"], ["run"], ["run", "--"], ["check", "--no-such-option", "true"], ["diff", "a"],
                      ["coverage", "--min-lines", "many", "true"], ["run", "/no/such/program"],
                      ["check", "--tools=no-such-tool", "true"]):
            result = self.run_it(*words)
            self.assertEqual((result.returncode, bool(result.stderr)), (2, True), words)

    def test_tools_that_do_not_exist_are_named(self):
        result = self.run_it("check", "--tools", "printf,no-such-tool", "true")
        self.assertIn("the tool 'no-such-tool' is not there", result.stderr)

    def test_check_finds_nothing(self):
        result = self.check_it(findings=[report(), report(NOTE)])
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("no findings in 2 processes", result.stderr)
        self.assertIn("note: x = 3", result.stderr)
        self.assertEqual(result.stdout, "")

    def test_check_fails_on_findings_of_any_process(self):
        result = self.check_it("--sarif=a.sarif", "--json=a.json", findings=[report(), report(STORE, WARNING), report(STORE)])
        self.assertEqual(result.returncode, 1)
        self.assertIn("a b.comp:12:3: error: store past the end [vitrine/out-of-bounds-store]", result.stderr)
        self.assertIn("1 error, 1 warning in 3 processes", result.stderr)
        findings = json.loads((self.folder / "a.json").read_text())["findings"]
        self.assertEqual([(f["rule"], f["count"]) for f in findings], [("out-of-bounds-store", 4), ("infinity", 1)])
        results = json.loads((self.folder / "a.sarif").read_text())["runs"][0]["results"]
        self.assertEqual([r["level"] for r in results], ["error", "warning"])

    def test_quiet_check_says_the_summary_alone(self):
        result = self.check_it("--quiet", findings=[report(STORE)])
        self.assertEqual((result.returncode, result.stderr), (1, "vitrine: 1 error in 1 process\n"))

    def test_annotations_are_commands_for_runners(self):
        result = self.check_it("--quiet", "--annotations", findings=[report(STORE)])
        self.assertEqual(result.returncode, 1)
        self.assertIn("::error file=a b.comp,line=12,col=3,title=vitrine/out-of-bounds-store::store past the end%0A", result.stderr)

    def test_code_hosts_get_paths_of_the_repository(self):
        (self.folder / ".git").mkdir()
        (self.folder / "shaders").mkdir()
        (self.folder / "shaders/a.comp").write_text("void main() {}\n")
        for noted in (f"{self.folder}/shaders/a.comp", "../shaders/a.comp", "shaders/a.comp"):
            finding = STORE | {"address": {"frames": [{"file": noted, "line": 1}]}}
            result = self.check_it("--annotations", "--sarif=a.sarif", "--code-quality=a.json", findings=[report(finding)])
            self.assertIn(f"{noted}:1: error", result.stderr)
            self.assertIn("::error file=shaders/a.comp,line=1,", result.stderr)
            place = json.loads((self.folder / "a.sarif").read_text())["runs"][0]["results"][0]["locations"][0]["physicalLocation"]
            self.assertEqual(place["artifactLocation"]["uri"], "shaders/a.comp")
            rows = json.loads((self.folder / "a.json").read_text())
            self.assertEqual([row["location"] for row in rows], [{"path": "shaders/a.comp", "lines": {"begin": 1}}])

    def test_shaders_without_debug_information_are_told_how_to_get_it(self):
        finding = STORE | {"address": {"frames": [{"file": "main.spvasm", "line": 89, "text": "OpStore %61 %60"}]}}
        self.assertIn("-g", self.check_it("--quiet", findings=[report(finding)]).stderr)
        (self.folder / "main.spvasm").write_text("; a file of the project's\n")
        self.assertEqual(self.check_it("--quiet", findings=[report(finding)]).stderr, "vitrine: 1 error in 1 process\n")

    def test_failures_of_the_application_come_first(self):
        result = self.check_it(findings=[report(STORE)], end="kill -6 $$")
        self.assertEqual(result.returncode, 134)
        self.assertIn("was ended by signal 6", result.stderr)
        self.assertIn("1 error in 1 process", result.stderr)

    def test_nothing_checked_is_no_success(self):
        result = self.check_it(findings=[])
        self.assertEqual(result.returncode, 2)
        self.assertIn("nothing was checked", result.stderr)

    def test_reports_that_cannot_be_read_or_written(self):
        result = self.check_it(findings=[report(), report()[:30]])
        self.assertEqual(result.returncode, 2)
        self.assertIn("cannot be read", result.stderr)
        result = self.check_it("--sarif=no/such/folder.sarif", findings=[report()])
        self.assertEqual(result.returncode, 2)
        self.assertIn("no/such/folder.sarif cannot be written: No such file or directory", result.stderr)

    def test_leaves_nothing_behind(self):
        self.check_it(findings=[report(STORE)])
        self.assertEqual([path.name for path in self.folder.iterdir() if not path.name.startswith("text")], [])

    def test_sarif_is_as_the_schema_says(self):
        self.check_it("--sarif=a.sarif", findings=[report(STORE, WARNING, NOTE)])
        document = json.loads((self.folder / "a.sarif").read_text())
        self.assertEqual(document["version"], "2.1.0")
        if not self.schema:
            self.skipTest("no schema is given")
        try:
            import jsonschema
        except ImportError:
            self.skipTest("python3-jsonschema is missing")
        schema = json.loads(pathlib.Path(self.schema).read_text())
        faults = list(jsonschema.Draft4Validator(schema).iter_errors(document))
        self.assertEqual([fault.message for fault in faults], [])

    def cover(self, *words, files):
        return self.run_it("coverage", *words, "--", *self.application("VITRINE_COVERAGE", *files))

    def test_coverage_adds_up_processes_and_runs(self):
        files = ["SF:a.comp\nDA:1,2\nDA:2,0\nend_of_record\n", "SF:a.comp\nDA:2,3\nDA:3,0\nend_of_record\n"]
        result = self.cover("-o", "a.info", files=files)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("ran 2 of 3 lines (66.7 %)", result.stderr)
        self.assertEqual(self.cover("-o", "a.info", "--append", files=files).returncode, 0)
        text = (self.folder / "a.info").read_text()
        self.assertIn("DA:1,4\nDA:2,6\nDA:3,0\nLF:3\nLH:2\n", text)

    def test_coverage_may_be_too_little(self):
        files = ["SF:a.comp\nDA:1,2\nDA:2,0\nend_of_record\n"]
        self.assertEqual(self.cover("--min-lines=50%", files=files).returncode, 0)
        self.assertEqual(self.cover("--min-lines=50.1", files=files).returncode, 1)
        self.assertEqual(self.cover(files=[]).returncode, 2)
        self.assertEqual(self.cover(files=["nonsense"]).returncode, 2)

    def test_bash_completes(self):
        script = pathlib.Path(self.vitrine).parent.parent / "share/bash-completion/completions/vitrine"
        for words, expected in ((["c"], "check coverage count"), (["check", "--s"], "--sanitize --sync --sarif"),
                                (["coverage", "--min"], "--min-lines"), (["check", "--tools", "pri"], "printf")):
            line = " ".join(f"'{word}'" for word in ["vitrine", *words])
            text = f"source '{script}'; COMP_WORDS=({line}); COMP_CWORD={len(words)}; _vitrine; echo \"${{COMPREPLY[*]}}\""
            result = subprocess.run(["bash", "-c", text], capture_output=True, text=True, check=False)
            self.assertEqual((result.stdout.strip(), result.stderr), (expected, ""))

    def diff(self, before, after, *words):
        for name, counters in (("a.json", before), ("b.json", after)):
            (self.folder / name).write_text(json.dumps(counters))
        return self.run_it("diff", "a.json", "b.json", *words)

    def test_diff_fails_over_the_limit(self):
        before, after = {"version": 1, "total": {"adds": 100, "loads": 8}}, {"version": 2, "total": {"adds": 104, "loads": 8}}
        result = self.diff(before, after)
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stdout, r"100 +104 +\+4\.00 % +total/adds")
        self.assertEqual(self.diff(before, after, "--max=5%").returncode, 0)
        self.assertEqual(self.diff(before, after, "--max", "3.9").returncode, 1)
        self.assertEqual(self.diff(before, after, "--max=0", "--counters=*/loads").returncode, 0)
        self.assertEqual(self.diff(before, [], "--max=5%").returncode, 2)
        self.assertEqual(self.run_it("diff", "a.json", "c.json").returncode, 2)


    def run_without_command(self, *words, **environment):
        return subprocess.run([self.small_application, *words], capture_output=True, text=True, cwd=self.folder, check=False,
                              env={**os.environ, "VK_DRIVER_FILES": self.manifest, **environment})

    def test_messages_of_all_instances_and_processes(self):
        two_processes = ["sh", "-c", f"{self.small_application} 2 && {self.small_application}"]
        result = self.run_it("check", "--tools=printf", "--sarif=a.sarif", *two_processes)
        self.assertEqual(result.returncode, 0, result.stderr)
        messages = re.findall(r"^tests/glass/app/fill\.comp:13:.* note: i is 3", result.stderr, re.MULTILINE)
        self.assertEqual(len(messages), 3, result.stderr)
        results = json.loads((self.folder / "a.sarif").read_text())["runs"][0]["results"]
        place = results[0]["locations"][0]["physicalLocation"]
        self.assertEqual((place["artifactLocation"]["uri"], place["region"]["startLine"]), ("tests/glass/app/fill.comp", 13))

    def test_messages_of_one_invocation(self):
        for target, count in (("compute:3,0,0", 1), ("compute:4,0,0", 0)):
            result = self.run_it("check", "--tools=printf", "--invocation", target, self.small_application)
            self.assertEqual((result.returncode, result.stderr.count("i is 3")), (0, count), result.stderr)

    def test_messages_without_the_command(self):
        result = self.run_without_command(VITRINE_PRINTF="stdout")
        self.assertEqual((result.returncode, result.stdout), (0, "i is 3\n"), result.stderr)
        result = self.run_without_command(VITRINE_PRINTF="said-%p.txt", VITRINE_PRINTF_FILTER="fragment:1;compute:3,0,0")
        self.assertEqual([file.read_text() for file in self.folder.glob("said-*.txt")], ["i is 3\n"])
        self.assertIn("'fragment:1' names no invocation", result.stderr)

    def test_faults_of_an_application(self):
        self.assertEqual(self.run_it("check", self.small_application).returncode, 0)
        result = self.run_it("check", self.small_application, "1", "16")
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, r"(?m)^tests/glass/app/fill\.comp:8:.* error: .* \[vitrine/out-of-bounds-store\]$")
        self.assertRegex(result.stderr, r"command 3 \(vkCmdDispatch\), compute shader main, invocation \(8, 0, 0\); 8 times")

    def test_counts_do_not_move_and_grow_with_the_work(self):
        for name, rounds in (("a.json", "1"), ("b.json", "1"), ("c.json", "2")):
            result = self.run_it("count", "-o", name, self.small_application, rounds)
            self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"(?m)^ +16  stores$")
        self.assertEqual((self.folder / "a.json").read_bytes(), (self.folder / "b.json").read_bytes())
        self.assertEqual(self.run_it("diff", "a.json", "b.json", "--max=0").returncode, 0)
        result = self.run_it("diff", "a.json", "c.json", "--max=5%")
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stdout, r"8 +16 +\+100\.00 % +total/stores")

    def test_timelines_nest_and_have_all_processes(self):
        two_processes = ["sh", "-c", f"{self.small_application} 1 && {self.small_application}"]
        result = self.run_it("timeline", "-o", "a.json", *two_processes)
        self.assertEqual(result.returncode, 0, result.stderr)
        events = json.loads((self.folder / "a.json").read_text())["traceEvents"]
        spans = [event for event in events if event["ph"] == "X"]
        names = [span["name"] for span in spans]
        for name in ("create pipeline", "submission", "command buffer", "vkCmdDispatch"):
            self.assertEqual(names.count(name), 2, names)
        self.assertEqual(len({span["pid"] for span in spans}), 2)
        open_until = {}
        for span in spans:  # in the order in which they begin, outer ones first
            ends = open_until.setdefault((span["pid"], span["tid"]), [])
            while ends and ends[-1] <= span["ts"]:
                ends.pop()
            self.assertLessEqual(span["ts"] + span["dur"], ends[-1] + 0.001 if ends else float("inf"), span)
            ends.append(span["ts"] + span["dur"])

    def test_lines_with_their_costs(self):
        result = self.run_it("count", "--lines", self.small_application)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"(?m)^ +32 \|   data\[i\] = i;$")
        self.assertRegex(result.stdout, r"(?m)^ +\| #version 450$")
        self.assertFalse((self.folder / "vitrine-sources").exists())

    def test_coverage_of_all_instances_and_processes(self):
        two_processes = ["sh", "-c", f"{self.small_application} 2 && {self.small_application}"]
        result = self.run_it("coverage", "-o", "a.info", "--sources=sources", *two_processes)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("DA:13,48\n", (self.folder / "a.info").read_text())

    def test_pages_of_coverage(self):
        if not shutil.which("genhtml"):
            self.skipTest("genhtml is missing")
        root = pathlib.Path(__file__).resolve().parents[3]
        two_processes = ["sh", "-c", f"{self.small_application} && {self.small_application} 1 16"]
        result = subprocess.run([self.vitrine, "coverage", "-o", self.folder / "a.info", *two_processes], cwd=root,
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        result = subprocess.run(["genhtml", "--branch-coverage", "-o", self.folder / "pages", self.folder / "a.info"],
                                cwd=root, capture_output=True, text=True, check=False)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        [page] = (self.folder / "pages").rglob("fill.comp.gcov.html")
        text = re.sub("<[^>]*>", "", page.read_text())
        self.assertRegex(text, r"(?m)^ +8 +: +24 :   data\[i\] = i;")
        self.assertRegex(text, r"(?m)^ +14 +\[ \+  \+ \]: +32 :   if \(i &lt; count\) put\(i\);")
        self.assertRegex(text, r"(?m)^ +15 +: +(32 )?: \}")  # Newer compilers say where functions end.

    def test_reports_do_not_depend_on_threads(self):
        reports = set()
        for threads in ("1", "2", "4"):
            for target in ("sse4", "avx2"):
                name = f"{threads}{target}.sarif"
                self.run_without_command("1", "16", VITRINE_TOOLS="sanitize,printf", VITRINE_REPORT=name,
                                         VITRINE_THREADS=threads, VITRINE_TARGET=target)
                reports.add((self.folder / name).read_bytes())
        self.assertEqual(len(reports), 1)
        self.assertEqual(len(json.loads(reports.pop())["runs"][0]["results"]), 2)

    def test_tools_without_the_command(self):
        result = self.run_without_command(VITRINE_TOOLS="printf", VITRINE_REPORT="a%p.txt")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        [report_file] = self.folder.glob("a*.txt")
        self.assertIn("note: i is 3 [vitrine/printf]", report_file.read_text())

    def test_reports_on_an_stderr_that_goes_to_a_file(self):
        script = f"echo before >&2; {self.small_application} 1 16; echo behind >&2"
        with open(self.folder / "log", "w", encoding="utf-8") as log:
            subprocess.run(["sh", "-c", script], check=True, stderr=log,
                           env={**os.environ, "VK_DRIVER_FILES": self.manifest, "VITRINE_TOOLS": "sanitize",
                                "VITRINE_REPORT": "/dev/stderr"})
        lines = (self.folder / "log").read_text().splitlines()
        self.assertEqual((lines[0], lines[-1]), ("before", "behind"))
        self.assertRegex(lines[1], r"^tests/glass/app/fill\.comp:8:.*\[vitrine/out-of-bounds-store\]$")
        self.assertRegex(lines[-3], "; 8 times$")

    def test_rows_of_deviations_that_are_none(self):
        result = self.run_without_command(VITRINE_AS_REFERENCE="point-clipping,no-such-row")
        self.assertEqual(result.returncode, 0)
        [line] = result.stderr.splitlines()
        self.assertIn("VITRINE_AS_REFERENCE: 'no-such-row' cannot be asked for; there are all, point-clipping", line)

    def test_driver_stays_loaded_while_tools_are_on(self):
        code = ("import _ctypes, ctypes, sys; driver = ctypes.CDLL(sys.argv[1]);"
                "driver.vk_icdGetInstanceProcAddr(None, b'vkCreateInstance'); _ctypes.dlclose(driver._handle);"
                "print('libvitrine_icd' in open('/proc/self/maps').read())")
        library = pathlib.Path(self.manifest).parent / "libvitrine_icd.so"
        for tools, stays in (("", "False\n"), ("printf", "True\n")):
            result = subprocess.run([sys.executable, "-c", code, library], capture_output=True, text=True, check=False,
                                    env={**os.environ, "VITRINE_TOOLS": tools})
            self.assertEqual((result.stdout, result.stderr), (stays, ""))

    def test_nothing_is_written_or_said_without_tools(self):
        result = self.run_without_command(VITRINE_REPORT="a.sarif")
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
        self.assertEqual(list(self.folder.iterdir()), [])


def main():
    paths = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:4])
    Command.vitrine, Command.manifest, Command.small_application = paths
    Command.schema = os.environ.get("VITRINE_SARIF_SCHEMA")
    if sys.argv[4:5] == ["--sarif-schema"]:
        Command.schema = sys.argv[5]
    unittest.main(argv=sys.argv[:1])


if __name__ == "__main__":
    main()
