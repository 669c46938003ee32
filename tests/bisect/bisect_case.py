#!/usr/bin/env python3
"""Says at which step of the shader compiler, and at which instruction, a case of cts-subset first differs.

usage: bisect_case.py CASE [--build=DIR] [--against=reference | --other-icd=FILE | --setting=NAME=VALUE]
                 [--trace=INVOCATION] [--origin=%ID] [options of cts_subset: --seed=N --count=N --mutate --icd=FILE ...]

CASE is a case's full name, as glsl.random_float.compute/3 (CTest prints it; `cts_subset --gtest_list_tests` lists all).

Against the reference (the default), which has no steps of ours: the case runs with the first N steps alone, for every N
after which a shader is another one, and each run is compared with the reference. The table says after which steps the
number of differing texels changes; the last of them, and those that make it larger, are told in full.

Against another build of this driver (--other-icd) or another setting of it (--setting=VITRINE_TARGET=sse4,
--setting=VITRINE_PASS_OFF=opt_cse): the shaders are compared after every step; the first step after which they are
different ones is told. Where all shaders are the same, one invocation of both is compared, value by value.

With --origin=%305 nothing is compared: the instructions that come from that SPIR-V id (or "line 12") are shown after
every step that changed them.

Told are the step, its row of spirv/rewrite/passes.def (file, what it mirrors), what it changed in the shader, with
SPIR-V ids and lines, the first instruction whose value differs, and commands to look further.
Exit status: 0 nothing differs, 1 something does, 2 could not be run.
"""
import argparse
import difflib
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

import logs
from logs import ROOT, Step, invocations, without_names


# ---- running a case

class Suite:
    """cts_subset with the options of this call."""

    def __init__(self, build, case, options):
        self.build, self.case, self.options = build, case, options
        self.binary = build / "cts-subset/cts_subset"
        self.folder = build / "bisect"  # of what is left for the reader

    def command(self, more=()):
        return [str(self.binary), "--validation=0", f"--gtest_filter={self.case}", *self.options, *more]

    def run(self, more=(), **environment):
        """Output, and diagnostics of the driver."""
        done = subprocess.run(self.command(more), env={**os.environ, **environment}, capture_output=True, text=True,
                              errors="replace", timeout=600)
        if re.search(r"Running 0 tests", done.stdout):
            cannot(f"no case is called {self.case} (seed and count are options of cts_subset: --seed=N --count=N)")
        return done.stdout, done.stderr

    def judgement(self, more=(), of=None, **environment):
        """(number of differing texels, what is said of the first of them) of a result, None: of the first that differs.
        None: identical."""
        out, _ = self.run((*more, f"--results={self.folder}/pictures"), **environment)
        return logs.judgement(out, of)

    def fingerprint(self, more=(), **environment):
        """Hash of what the device puts out."""
        with tempfile.NamedTemporaryFile() as file:
            self.run((*more, f"--fingerprints={file.name}"), **environment)
            return pathlib.Path(file.name).read_text().strip()

    def shaders(self, more=(), **environment):
        """{number of the shader: its steps}, from VITRINE_LOG=ir."""
        with tempfile.NamedTemporaryFile() as file:
            _, log = self.run((*more, f"--fingerprints={file.name}"), VITRINE_LOG="ir", **environment)
        shaders = logs.read_steps(log)
        if not shaders:
            icd = next((option for option in (*more, *self.options) if option.startswith("--icd=")), "this build")
            cannot(f"{icd} wrote no steps of a shader (VITRINE_LOG=ir): only other builds of this driver can be compared "
                   "step by step (another driver is a --reference=FILE), and only cases that have shaders")
        return shaders

    def trace(self, invocation, more=(), **environment):
        """Lines of all runs of one invocation."""
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "trace"
            self.run((*more, f"--fingerprints={folder}/hash"), VITRINE_TRACE=f"{invocation}@{path}", **environment)
            return path.read_text().splitlines() if path.exists() else []


def cannot(why):
    print(f"bisect_case.py: {why}", file=sys.stderr)
    sys.exit(2)


# ---- telling

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


def tell_alone(suite, shader, step, before):
    """How to run the step on what it got."""
    if step.number < 0:
        return
    path = suite.folder / f"before-{step.name}-{shader}-{step.number}.ir"
    suite.folder.mkdir(exist_ok=True)
    path.write_text("\n".join(before) + "\n")
    print(f"  alone    {suite.build}/tests/vitrine_step {step.name} < {path}")


def tell_instruction(suite, case, message, wanted, here, there, names=("here ", "there")):
    """The first instruction whose value differs between two ways to run the driver: (options, environment). Its id."""
    candidates = [wanted] if wanted else invocations(case, message)
    for invocation in candidates:
        old = suite.trace(invocation, here[0], **here[1])
        new = suite.trace(invocation, there[0], **there[1])
        if not old or not new:
            continue
        a, b = logs.values(old), logs.values(new)
        for origin, (value, line) in a.items():
            if origin in b and b[origin][0] != value:
                print(f"  first value that differs, of {invocation}: {origin}")
                print(f"    {names[0]}  {line}\n    {names[1]}  {b[origin][1]}")
                return origin.split(" line ")[0]
    print("  no value of an instruction that both have differs at the guessed invocations" if not wanted else
          f"  no value of {wanted} differs", "(--trace=compute:x,y,z | vertex:i | fragment:x,y names another)")
    return None


# ---- the two comparisons

def tell_missing(suite, case, message, trace):
    """What remains where no step makes a difference: one that ours lack, or something else than a step."""
    print("\nno step adds to what differs. Either the reference does a rewrite that is missing here: compare the statement"
          "\nwith the tables of docs/lavapipe-shader-math.md 4.2 and 4.3, and write it for vitrine_step to see what becomes"
          "\nof it (tests/spirv/ir_text.h). Or the difference lies outside the rewrites: in an operation, a texture, the"
          "\ninterface.")
    for invocation in [trace] if trace else invocations(case, message):
        lines = logs.slice_of(suite.trace(invocation), message)
        if lines:
            print(f"what computes the components that differ, of {invocation} (last shader, values of this driver):")
            print("\n".join("    " + line for line in lines))
            return


def tell_origin(suite, origin):
    """Instructions that come from a SPIR-V id, after every step that changed them."""
    found = {shader: logs.lines_of(origin, steps) for shader, steps in suite.shaders().items()}
    for shader, changes in found.items():
        for step, lines in changes:
            where = f", step {step.number}, round {step.round}" if step.number >= 0 else ""
            print(f"shader {shader}{where}: {step.name}")
            print("\n".join("    " + line for line in lines) or "    nothing is left of it")
    if not any(found.values()):
        print(f"no instruction of {suite.case} comes from {origin}")
    return 0


def against_reference(suite, case, rows, trace):
    whole = suite.judgement()
    if not whole:
        print(f"{case}: nothing differs from the reference")
        return 0
    print(f"{case}\n  {whole[1]}")
    result = logs.result_of(whole[1])
    shaders = suite.shaders()
    steps = logs.changed_steps(shaders)
    print(f"  {len(shaders)} shaders, {len(steps)} limits to try\n\n   limit  differing  step")
    before, told, suspects, last = None, None, [], None
    for number in [0, *steps]:
        judged = suite.judgement(of=result, VITRINE_PASS_LIMIT=str(number))
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
    if not suspects:
        tell_missing(suite, case, whole[1], trace)
    if last and last not in suspects:
        suspects.append(last)
    for number in suspects[-3:]:
        kind = "the last step that changes what differs" if number == last else "a step that makes it worse"
        print(f"\n{kind}:")
        origin = tell_instruction(suite, case, whole[1], trace, ((), {"VITRINE_PASS_LIMIT": str(number - 1)}),
                                  ((), {"VITRINE_PASS_LIMIT": str(number)}), ("without it", "with it   "))
        for shader, index in steps[number]:
            step, previous = shaders[shader][index], shaders[shader][index - 1]
            tell_step(shader, step, rows)
            tell_difference(previous.text, step.text, "before", "after", origin)
            tell_alone(suite, shader, step, previous.text)
    tell_further(suite, case, whole[1], trace)
    return 1


def against_twin(suite, case, rows, trace, options, environment, name):
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
                tell_alone(suite, shader, told, (ours if told is mine else theirs)[index - 1].text)
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
    parser = argparse.ArgumentParser(usage=__doc__.replace("%", "%%"), add_help=True)
    parser.add_argument("case")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--against", choices=["reference"], default="reference")
    parser.add_argument("--other-icd")
    parser.add_argument("--setting")
    parser.add_argument("--trace")
    parser.add_argument("--origin")
    arguments, options = parser.parse_known_args()
    if not (arguments.build / "cts-subset/cts_subset").exists():
        cannot(f"no cts_subset: cmake --build {arguments.build} --target cts_subset vitrine_icd_library vitrine_step")
    suite = Suite(arguments.build, arguments.case.removeprefix("--gtest_filter="), options)
    if arguments.origin:
        return tell_origin(suite, arguments.origin)
    rows = logs.read_rows()
    told = (suite, suite.case, rows, arguments.trace)
    if arguments.other_icd:
        more = (f"--icd={pathlib.Path(arguments.other_icd).resolve()}",)
        return against_twin(*told, more, {}, arguments.other_icd)
    if arguments.setting:
        name, _, value = arguments.setting.partition("=")
        return against_twin(*told, (), {name: value}, arguments.setting)
    return against_reference(*told)


if __name__ == "__main__":
    sys.exit(main())
