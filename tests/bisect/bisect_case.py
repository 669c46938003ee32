#!/usr/bin/env python3
"""Says at which step of the shader compiler, and at which instruction, a case of cts-subset first differs.

usage: bisect_case.py CASE [--build=DIR] [--against=reference | --other-icd=FILE | --setting=NAME=VALUE]
                 [--trace=INVOCATION] [options of cts_subset: --seed=N --count=N --mutate --icd=FILE ...]

CASE is a case's full name, as glsl.random_float.compute/3 (CTest prints it; `cts_subset --gtest_list_tests` lists all).

Against the reference (the default), which has no steps of ours: the case runs with the first N steps alone, for every N
after which a shader is another one, and each run is compared with the reference. The table says after which steps the
number of differing texels changes; the last of them, and those that make it larger, are told in full.

Against another build of this driver (--other-icd) or another setting of it (--setting=VITRINE_TARGET=sse4,
--setting=VITRINE_PASS_OFF=opt_cse): the shaders are compared after every step; the first step after which they are
different ones is told. Where all shaders are the same, one invocation of both is compared, value by value.

Told are the step, its row of spirv/rewrite/passes.def (file, what it mirrors), what it changed in the shader, with
SPIR-V ids and lines, the first instruction whose value differs, and commands to look further.
Exit status: 0 nothing differs, 1 something does, 2 could not be run.
"""
import argparse
import collections
import difflib
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
Step = collections.namedtuple("Step", "number round name text")  # number -1: before all steps
Row = collections.namedtuple("Row", "file mirrors why")


# ---- running a case

class Suite:
    """cts_subset with the options of this call."""

    def __init__(self, build, case, options):
        self.binary = build / "cts-subset/cts_subset"
        self.case, self.options = case, options

    def command(self, more=()):
        return [str(self.binary), "--validation=0", f"--gtest_filter={self.case}", *self.options, *more]

    def run(self, more=(), **environment):
        """Output, and diagnostics of the driver."""
        done = subprocess.run(self.command(more), env={**os.environ, **environment}, capture_output=True, text=True,
                              errors="replace", cwd=tempfile.gettempdir(), timeout=600)
        if re.search(r"Running 0 tests", done.stdout):
            sys.exit(f"no case is called {self.case} (seed and count are options of cts_subset: --seed=N --count=N)")
        return done.stdout, done.stderr

    def judgement(self, more=(), **environment):
        """(number of differing texels, what is said of the first of them); None: identical."""
        out, _ = self.run((*more, f"--results={tempfile.gettempdir()}/bisect-pictures"), **environment)
        found = re.search(r"^  (.*; (\d+) of \d+ differ)$", out, re.MULTILINE)
        if found:
            return int(found[2]), found[1]
        return (1, out.strip().splitlines()[-1]) if "[  FAILED  ]" in out else None

    def fingerprint(self, more=(), **environment):
        """Hash of what the device puts out."""
        with tempfile.NamedTemporaryFile() as file:
            self.run((*more, f"--fingerprints={file.name}"), **environment)
            return pathlib.Path(file.name).read_text().strip()

    def shaders(self, more=(), **environment):
        """{number of the shader: its steps}, from VITRINE_LOG=ir."""
        with tempfile.NamedTemporaryFile() as file:
            _, log = self.run((*more, f"--fingerprints={file.name}"), VITRINE_LOG="ir", **environment)
        return read_steps(log)

    def trace(self, invocation, more=(), **environment):
        """Lines of all runs of one invocation."""
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "trace"
            self.run((*more, f"--fingerprints={folder}/hash"), VITRINE_TRACE=f"{invocation}@{path}", **environment)
            return path.read_text().splitlines() if path.exists() else []


def read_steps(log):
    shaders, steps = {}, None
    for line in log.splitlines():
        head = re.match(r"vitrine: ir: shader (\d+), (?:front end|final|step (\d+)[^,]*, round (\d+): (\w+))$", line)
        if head:
            steps = shaders.setdefault(int(head[1]), [])
            steps.append(Step(int(head[2] or -1), int(head[3] or 0), head[4] or line.rsplit(", ", 1)[1], []))
        elif line.startswith("vitrine: "):
            steps = None
        elif steps is not None and line:
            steps[-1].text.append(line)
    return shaders


def read_rows():
    """{function: its first row of passes.def}."""
    text = (ROOT / "spirv/rewrite/passes.def").read_text()
    rows = {}
    pattern = r'^VITRINE_PASS\(\w+, \w+, \w+, (\w+), "([^"]*)",\s*"([^"]*)",\s*"([^"]*)"\)'
    for row in re.finditer(pattern, text, re.MULTILINE):
        rows.setdefault(row[1], Row(*row.groups()[1:]))
    return rows


# ---- telling

def without_names(line):
    """The instruction without the numbers of values, which steps that run give away differently."""
    return re.sub(r"%\d+(?=[:.,\s]|$)", "%", line.split("  ;")[0]).strip()


def tell_difference(old, new, old_name, new_name, origin=None, most=30):
    """What a step did, of the instructions from `origin` if it did something to them; literals alone say nothing."""
    lines = list(difflib.unified_diff(old, new, old_name, new_name, lineterm="", n=0))
    telling = [line for line in lines if not re.match(r"[+-] *%\d+:\d+b? = Const", line) and not line.startswith("@@")]
    lines = telling if len(telling) > 2 else lines
    wanted = [line for line in lines if origin and re.search(rf"; {re.escape(origin)}\b", line)]
    if wanted:
        print(f"  what it did to {origin}, of {len(lines) - 2} lines:")
        lines = [*lines[:2], *wanted]
    for line in lines[:most]:
        print("    " + line)
    if len(lines) > most:
        print(f"    ... {len(lines) - most} lines more")
    origins = [re.search(r"; (%\d+(?: line \d+)?|line \d+)", line) for line in lines if line[0] in "+-"]
    origins = list(dict.fromkeys(origin[1] for origin in origins if origin))
    if origins:
        print(f"  SPIR-V: {', '.join(origins[:8])}" + (", ..." if len(origins) > 8 else ""))


def tell_step(shader, step, rows):
    print(f"  shader {shader}, step {step.number}, round {step.round}: {step.name}")
    row = rows.get(step.name)
    if row:
        print(f"  file     spirv/rewrite/{row.file}")
        print(f"  mirrors  {row.mirrors}  (sections of docs/lavapipe-optimizer.md)")
        print(f"  here     {row.why}")


def tell_alone(build, shader, step, before):
    """How to run the step on what it got."""
    if step.number < 0:
        return
    path = pathlib.Path(tempfile.gettempdir()) / f"before-{step.name}-{shader}-{step.number}.ir"
    path.write_text("\n".join(before) + "\n")
    print(f"  alone    {build}/tests/vitrine_step {step.name} < {path}")


def invocations(case, message):
    """Invocations that may have made the place of the first difference, best first."""
    element = re.search(r", element (\d+):", message)
    pixel = re.search(r", pixel \((\d+), (\d+)\)", message)
    if pixel:
        yield f"fragment:{pixel[1]},{pixel[2]}"
    if element:
        index = int(element[1])
        stages = [s for s in ("compute", "vertex", "fragment") if s in case] or ["compute", "vertex", "fragment"]
        for words in (1, 2, 4, 3, 8):
            for stage in stages:
                number = index // words
                yield {"compute": f"compute:{number},0,0", "vertex": f"vertex:{number}",
                       "fragment": f"fragment:{number % 64},{number // 64}"}[stage]


def values(lines):
    """{origin: (value, line)} of results, in the order of the trace; the last run of an instruction counts."""
    result = {}
    for line in lines:
        found = re.search(r" = ([0-9a-f]{8}|[01]\b).*  ; (.*)$", line)
        if found:
            result[found[2]] = (found[1], line.strip())
    return result


def tell_instruction(suite, case, message, wanted, here, there, names=("here ", "there")):
    """The first instruction whose value differs between two ways to run the driver: (options, environment). Its id."""
    candidates = [wanted] if wanted else invocations(case, message)
    for invocation in candidates:
        old = suite.trace(invocation, here[0], **here[1])
        new = suite.trace(invocation, there[0], **there[1])
        if not old or not new:
            continue
        a, b = values(old), values(new)
        for origin, (value, line) in a.items():
            if origin in b and b[origin][0] != value:
                print(f"  first value that differs, of {invocation}: {origin}")
                print(f"    {names[0]}  {line}\n    {names[1]}  {b[origin][1]}")
                return origin.split(" line ")[0]
    print("  no value of an instruction that both have differs at the guessed invocations" if not wanted else
          f"  no value of {wanted} differs", "(--trace=compute:x,y,z | vertex:i | fragment:x,y names another)")
    return None


# ---- the two comparisons

def changed_steps(shaders):
    """{N: [(shader, index)]}: the optional steps after which a shader is another one."""
    steps = collections.defaultdict(list)
    for shader, list_of in shaders.items():
        for index, step in enumerate(list_of):
            if index and step.number > 0:
                steps[step.number].append((shader, index))
    return dict(sorted(steps.items()))


def against_reference(suite, build, case, rows, trace):
    whole = suite.judgement()
    if not whole:
        print(f"{case}: nothing differs from the reference")
        return 0
    print(f"{case}\n  {whole[1]}")
    shaders = suite.shaders()
    steps = changed_steps(shaders)
    print(f"  {len(shaders)} shaders, {len(steps)} limits to try\n\n   limit  differing  step")
    before, told, suspects, last = None, None, [], None
    for number in [0, *steps]:
        judged = suite.judgement(VITRINE_PASS_LIMIT=str(number))
        count = judged[0] if judged else 0
        names = ", ".join(f"{shaders[s][i].name} (shader {s}, round {shaders[s][i].round})"
                          for s, i in steps.get(number, []))
        if judged != told or number == 0:
            print(f"  {number:6} {count:10}  {names or 'none'}")
            if number:
                last = number
                if count > (before or 0):
                    suspects.append(number)
        before, told = count, judged
    if last and last not in suspects:
        suspects.append(last)
    if not suspects:
        print("\nno step changes what differs: the difference is not one of the rewrites; look at the trace of an "
              "invocation")
    for number in suspects[-3:]:
        kind = "the last step that changes what differs" if number == last else "a step that makes it worse"
        print(f"\n{kind}:")
        origin = tell_instruction(suite, case, whole[1], trace, ((), {"VITRINE_PASS_LIMIT": str(number - 1)}),
                                  ((), {"VITRINE_PASS_LIMIT": str(number)}), ("without it", "with it   "))
        for shader, index in steps[number]:
            step, previous = shaders[shader][index], shaders[shader][index - 1]
            tell_step(shader, step, rows)
            tell_difference(previous.text, step.text, "before", "after", origin)
            tell_alone(build, shader, step, previous.text)
    tell_further(suite, case, whole[1], trace)
    return 1


def against_twin(suite, build, case, rows, trace, options, environment, name):
    """Against another build or setting of this driver."""
    same = suite.fingerprint() == suite.fingerprint(options, **environment)
    print(f"{case}: the outputs of this build and of {name} are {'the same' if same else 'not the same'}")
    message = ""
    if not same and options:
        other = next(option.removeprefix("--icd=") for option in options)
        judged = suite.judgement(more=(f"--reference={other}",))
        message = judged[1] if judged else ""
        print(f"  {message}")
    elif not same:
        judged = suite.judgement(**environment) or suite.judgement()
        message = judged[1] if judged else ""
    here, there = suite.shaders(), suite.shaders(options, **environment)
    for shader in sorted(here):
        ours, theirs = here[shader], there.get(shader, [])
        for index in range(max(len(ours), len(theirs))):
            mine = ours[index] if index < len(ours) else ours[-1]
            other = theirs[index] if index < len(theirs) else theirs[-1] if theirs else Step(-1, 0, "nothing", [])
            equal = [without_names(l) for l in mine.text] == [without_names(l) for l in other.text]
            if equal and (mine.name, mine.round) == (other.name, other.round):
                continue
            print("first step that differs:")
            told = mine if index < len(ours) else other
            tell_step(shader, told, rows)
            if (mine.name, mine.round) == (other.name, other.round) or not index:
                tell_difference(mine.text, other.text, "here", "there")
            else:
                print(f"  it changes nothing there: the next that does is {other.name}, round {other.round}")
                tell_difference((ours if told is mine else theirs)[index - 1].text, told.text, "before", "after")
            if index:
                tell_alone(build, shader, told, (ours if told is mine else theirs)[index - 1].text)
            tell_instruction(suite, case, message, trace, ((), {}), (options, environment))
            tell_further(suite, case, message, trace)
            return 1
    print("the shaders are the same after every step")
    if not same:
        tell_instruction(suite, case, message, trace, ((), {}), (options, environment))
        tell_further(suite, case, message, trace)
    return 0 if same else 1


def tell_further(suite, case, message, trace):
    invocation = trace or next(invocations(case, message), "compute:0,0,0")
    command = shlex.join(suite.command())
    print("\nto look further:")
    print(f"  pictures         {command} --results=DIR")
    print(f"  every step       VITRINE_LOG=ir {command} 2> steps.log")
    print(f"  one invocation   VITRINE_TRACE={invocation}@trace.log {command}")
    print(f"  fewer steps      VITRINE_PASS_LIMIT=N {command}")


def main():
    parser = argparse.ArgumentParser(usage=__doc__, add_help=True)
    parser.add_argument("case")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--against", choices=["reference"], default="reference")
    parser.add_argument("--other-icd")
    parser.add_argument("--setting")
    parser.add_argument("--trace")
    arguments, options = parser.parse_known_args()
    suite = Suite(arguments.build, arguments.case.removeprefix("--gtest_filter="), options)
    if not suite.binary.exists():
        print(f"{suite.binary} is missing: cmake --build {arguments.build} --target cts_subset vitrine_icd_library",
              file=sys.stderr)
        return 2
    rows = read_rows()
    told = (suite, arguments.build, suite.case, rows, arguments.trace)
    if arguments.other_icd:
        more = (f"--icd={pathlib.Path(arguments.other_icd).resolve()}",)
        return against_twin(*told, more, {}, arguments.other_icd)
    if arguments.setting:
        name, _, value = arguments.setting.partition("=")
        return against_twin(*told, (), {name: value}, arguments.setting)
    return against_reference(*told)


if __name__ == "__main__":
    sys.exit(main())
