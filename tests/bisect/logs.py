"""Reads what the driver and the suite write: logs of steps, traces of an invocation, messages of differing cases."""
import collections
import pathlib
import re
import struct

ROOT = pathlib.Path(__file__).resolve().parents[2]
Step = collections.namedtuple("Step", "number round name text")  # number -1: before all steps
Row = collections.namedtuple("Row", "file mirrors why")


# ---- VITRINE_LOG=ir

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


def changed_steps(shaders):
    """{N: [(shader, index)]}: the optional steps after which a shader is another one."""
    steps = collections.defaultdict(list)
    for shader, list_of in shaders.items():
        for index, step in enumerate(list_of):
            if index and step.number > 0:
                steps[step.number].append((shader, index))
    return dict(sorted(steps.items()))


def lines_of(origin, steps):
    """[(step, its lines that come from `origin`)], where these are others than after the step before."""
    result = []
    for step in steps:
        lines = [line for line in step.text if re.search(rf"; .*{re.escape(origin)}\b", line)]
        before = result[-1][1] if result else []
        if [without_names(line) for line in lines] != [without_names(line) for line in before]:
            result.append((step, lines))
    return result


def without_names(line):
    """The instruction without the numbers of values, which steps that run give away differently."""
    return re.sub(r"%\d+(?=[:.,\s]|$)", "%", line.split("  ;")[0]).strip()


def read_rows():
    """{function: its first row of passes.def}."""
    text = (ROOT / "spirv/rewrite/passes.def").read_text()
    rows = {}
    pattern = r'^VITRINE_PASS\(\w+, \w+, \w+, (\w+), "([^"]*)",\s*"([^"]*)",\s*"([^"]*)"\)'
    for row in re.finditer(pattern, text, re.MULTILINE):
        rows.setdefault(row[1], Row(*row.groups()[1:]))
    return rows


# ---- messages of the suite, values of a trace

def judgement(output, of=None):
    """(number of differing texels, what is said of the first of them) of the result `of`, or of the first that differs;
    None: nothing is said of it. What is no comparison of texels counts as one."""
    found = re.search(rf"^  ({re.escape(of) + ' ' if of else ''}.*; (\d+) of \d+ differ)$", output, re.MULTILINE)
    if found:
        return int(found[2]), found[1]
    if of or "[  FAILED  ]" not in output:
        return None
    reason = re.search(r"^Failed\n +(.*)$", output, re.MULTILINE)
    return 1, reason[1] if reason else "the case fails"


def result_of(message):
    """Name of the result that a judgement is about; None: it is about none."""
    found = re.match(r"(.*?) \(\w+ \d+x\d+\), ", message)
    return found[1] if found else None


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


# ---- a part of a trace

def differing_words(message):
    """Words of the device's texel in a judgement's message, and the indices of those that the reference has otherwise."""
    texels = re.search(r": device ([0-9a-f]+) .*?, reference ([0-9a-f]+) ", message)
    if not texels or len(texels[1]) % 8 or len(texels[1]) != len(texels[2]):
        return [], []
    device, reference = (struct.unpack(f"<{len(t) // 8}I", bytes.fromhex(t)) for t in texels.groups())
    return list(device), [i for i, word in enumerate(device) if word != reference[i]]


def slice_of(lines, message):
    """Lines of the trace that compute the components that differ, and the store of them; empty: it does not store them."""
    words, wanted = differing_words(message)
    parsed = [re.match(r" +\d+  (\w+) +(?:(.*) = .*)?<- ([^;]*)", line) for line in lines]
    for at in reversed(range(len(lines) if any(words) else 0)):
        if not parsed[at] or not parsed[at][1].startswith("store"):
            continue
        stored = re.findall(r"([ru]\d+) ([0-9a-f]{8}) ", parsed[at][3])
        values = [int(value, 16) for _, value in stored]
        for first in range(1, len(values) - len(words) + 1):
            if values[first:first + len(words)] == words:
                return backwards(lines, at, {stored[first + i][0] for i in wanted})
    return []


def backwards(lines, at, needed):
    """The line `at` and, above it, those that write registers that it or a line of them needs."""
    kept = [lines[at].strip()]
    for line in reversed(lines[:at]):
        if line.startswith("vitrine: trace:"):
            break
        result, found, operands = line.split("  ;")[0].partition("<-")
        written = set(re.findall(r"\b([rum]\d+) = ", result))
        if not found or not written & needed:
            continue
        needed = needed - written | set(re.findall(r"\b[rum]\d+\b", operands))
        kept.append(line.strip())
    return kept[::-1]
