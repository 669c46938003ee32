#!/usr/bin/env python3
"""Checks the shape of the tree: include directions between rooms and inside them, rooms in CONTRIBUTING, tests behind
claims, opcodes and steps, capabilities, dynamic states, long files.

usage: structure.py SOURCE_FOLDER
Exit status 1 and one line per fault. The tail of file sizes is printed, never a fault.
"""
import pathlib
import re
import sys
from xml.etree import ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "icd" / "registry"))
import claims as claims_module
import vkxml

# design.md section 2: a room may include itself and what stands to its right.
ORDER = ["icd", "glass", "raster", "spirv", "texel", "base"]
FREE = ["tests", "cts-subset"]
DATA = ["manifest", "docs"]
# What raster sees of spirv.
SHADER_HEADERS = ["shader.h", "shader_cost.h", "counted_runs.h", "stage_memory.h", "resources.h"]
# Inside raster: a part (a folder, or files of one name) includes itself and parts of lines below its own.
RASTER_PARTS = [
    ["pass"],
    ["front", "tile"],
    ["primitive_instances"],
    ["primitive"],
    ["plan"],
    ["draw_watches", "output", "pass_desc", "topology"],
    ["draw", "observe"],
    ["arena", "fragment_rate", "lane_bits", "color_registers", "pixel_order", "pixel_rect", "sample_locations", "stage"],
]
# What must not be included from where, besides: files whose path begins so, and the beginnings of paths they must not see.
NEVER = [
    ("raster/front/stages/", ["raster/front/front.h"]),
    ("texel/sampler/model/", ["texel/sampler/wave/", "texel/load_store/"]),
    ("texel/sampler/wave/", ["texel/load_store/"]),
    ("texel/format/", ["texel/codec", "texel/block", "texel/sampler", "texel/load_store", "texel/transfer"]),
    ("icd/registry/", ["icd/api/", "icd/object/", "icd/record/", "icd/replay/", "icd/wsi/"]),
]
# Folders in which includes between parts still run in a circle.
CIRCLES = ["icd", "icd/replay", "spirv", "spirv/exec", "spirv/lower", "spirv/rewrite", "texel"]
LONG_FILE = 350
# What only <algorithm> has: min, copy, fill and their like come with every container, and these do, too, with some compilers.
ALGORITHMS = re.compile(r"\bstd::(ranges::\w+|clamp|minmax|(stable_|partial_)?sort|nth_element|find(_if|_if_not|_first_of)?|(any|all|none)_of|copy_(n|if)"
                        r"|count(_if)?|transform|reverse|unique|(upper|equal)_bound|equal_range|binary_search|remove_if|(min|max|minmax)_element|rotate"
                        r"|generate(_n)?|for_each(_n)?|shuffle|is_sorted\w*|(stable_)?partition|set_\w+|includes|search|replace(_if)?|(inplace_)?merge"
                        r"|\w+_heap|adjacent_find|next_permutation)[(<]")
# Relative to the tree: what manifest/pack/newer-headers has unpacked. Claims are held against each that is there.
REGISTRIES = ["/usr/share/vulkan/registry/vk.xml", "/usr/local/share/vulkan/registry/vk.xml", "build/headers/usr/share/vulkan/registry/vk.xml"]


def registries(root):
    return [path for path in (root / name for name in REGISTRIES) if path.exists()]


def sources(root, folder):
    for pattern in ("*.h", "*.cpp", "*.def"):
        yield from sorted((root / folder).rglob(pattern))


def include_faults(root):
    """A room includes only rooms below it; raster sees of spirv the shader interface alone."""
    for position, room in enumerate(ORDER):
        allowed = set(ORDER[position:])
        for path in sources(root, room):
            for number, line in enumerate(path.read_text().splitlines(), 1):
                match = re.match(r'\s*#\s*include\s+"([^"/]+)/([^"]+)"', line)
                if not match:
                    continue
                target, header = match.groups()
                where = f"{path.relative_to(root)}:{number}"
                if target in ORDER + FREE and target not in allowed:
                    yield f"{where}: {room} must not include {target}/{header}"
                if room == "raster" and target == "spirv" and header not in SHADER_HEADERS:
                    yield f"{where}: raster sees spirv through spirv/shader.h, not {header}"
                if room != "icd" and "vk_icd" in header:
                    yield f"{where}: only icd knows the loader"


def includes(path):
    """(line number, included path) of a file."""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        match = re.match(r'\s*#\s*include\s+"([^"]+)"', line)
        if match:
            yield number, match.group(1)


def part_of(path, folder):
    """The part of a folder that a file is in: the folder below, or the name that a header and its source share."""
    first, *rest = pathlib.PurePosixPath(path).relative_to(folder).parts
    return first if rest else re.sub(r"(-inl)?\.\w+$", "", first)


def part_faults(root):
    """Inside raster includes go down the list of its parts; NEVER lists single pairs elsewhere."""
    line_of = {part: line for line, parts in enumerate(RASTER_PARTS) for part in parts}
    for path in sources(root, "raster"):
        name = path.relative_to(root).as_posix()
        part = part_of(name, "raster")
        if part not in line_of:
            yield f"{name}: tests/structure/structure.py does not say where in raster {part} stands"
            continue
        for number, target in includes(path):
            if not target.startswith("raster/") or part_of(target, "raster") == part:
                continue
            if line_of.get(part_of(target, "raster"), -1) <= line_of[part]:
                yield f"{name}:{number}: raster's {part} must not include {target}"
    for beginning, forbidden in NEVER:
        for path in sources(root, beginning.split("/")[0]):
            name = path.relative_to(root).as_posix()
            for number, target in includes(path) if name.startswith(beginning) else ():
                if target.startswith(tuple(forbidden)):
                    yield f"{name}:{number}: {beginning} must not include {target}"


def circle_faults(root):
    """No circle of includes between the parts of a folder, and none listed in CIRCLES that is gone."""
    files = [path for room in ORDER for path in sources(root, room)]
    folders = {folder.relative_to(root).as_posix() for path in files for folder in path.parents if root in folder.parents}
    arrows = [(path.relative_to(root).as_posix(), target) for path in files for _, target in includes(path)]
    for folder in sorted(folders):
        below = {}
        for source, target in arrows:
            if source.startswith(folder + "/") and target.startswith(folder + "/"):
                below.setdefault(part_of(source, folder), set()).add(part_of(target, folder))
        left = {part: targets - {part} for part, targets in below.items()}
        while free := [part for part, targets in left.items() if not targets & left.keys()]:
            for part in free:
                del left[part]
        if left and folder not in CIRCLES:
            yield f"{folder}/: includes run in a circle between {', '.join(sorted(left))}"
        if not left and folder in CIRCLES:
            yield f"{folder}/: has no circle of includes any more; tests/structure/structure.py still lists it"


def header_faults(root):
    """Every source of raster has a header of its own name, and includes it first."""
    for path in sources(root, "raster"):
        own = path.with_suffix(".h").relative_to(root).as_posix()
        if path.suffix == ".cpp" and next((target for _, target in includes(path)), None) != own:
            yield f"{path.relative_to(root)}: does not include {own} first"


def room_faults(root):
    """Every room exists and CONTRIBUTING's map names it, and the reverse."""
    rooms = ORDER + FREE + DATA
    for room in rooms:
        if not (root / room).is_dir():
            yield f"{room}/: the room is missing"
    guide = root / "CONTRIBUTING.md"
    if not guide.exists():
        yield "CONTRIBUTING.md is missing"
        return
    named = set(re.findall(r"^\|\s*`([\w-]+)/`", guide.read_text(), re.MULTILINE))
    for room in rooms:
        if room not in named:
            yield f"CONTRIBUTING.md: the map of rooms lacks `{room}/`"
    for name in sorted(named - set(rooms)):
        if not (root / name).is_dir():
            yield f"CONTRIBUTING.md: names `{name}/`, which does not exist"


def known_tests(root):
    """{room: suite names of its unit tests}; cts-subset: the words of its case names."""
    suites = {}
    for room in ORDER:
        text = "".join(p.read_text() for p in (root / "tests" / room).rglob("*_test.cpp"))
        suites[room] = set(re.findall(r"^TEST(?:_[FP])?\((\w+),", text, re.MULTILINE))
    text = "".join(p.read_text() for p in (root / "cts-subset").rglob("*.cpp"))
    suites["cts-subset"] = set(re.findall(r'"([a-z0-9_]+)[."]', text))
    return suites


def claim_faults(root):
    """Every claim in manifest/ names tests that exist: '<room> <Suite>.<pattern>' or 'cts-subset <group>.<pattern>'."""
    suites = known_tests(root)
    for file in ("manifest/features", "manifest/extensions", "tests/spirv/opcode_tests"):
        for number, line in enumerate((root / file).read_text().splitlines(), 1):
            line = re.sub(r"(^|\s)#.*", "", line).strip()
            if not line:
                continue
            for test in line.split(";")[-1].split(","):
                words = test.split()
                if len(words) != 2 or words[0] not in suites:
                    yield f"{file}:{number}: '{test.strip()}' is not '<room or cts-subset> <test pattern>'"
                elif words[1].split(".")[0] not in suites[words[0]]:
                    yield f"{file}:{number}: no test {words[1]} in {words[0]}"


def opcode_faults(root):
    """Every row of the opcode tables is in assembly among the tests, or tests/spirv/opcode_tests says what tests it."""
    text = "".join(p.read_text() for folder in ("tests/spirv", "cts-subset") for p in (root / folder).rglob("*.cpp"))
    listed = set(re.findall(r"^(\w+) *;", (root / "tests/spirv/opcode_tests").read_text(), re.MULTILINE))
    for table, row, use in (("spirv/opcodes.def", r"^VITRINE(?:_NUMBERED)?_OPCODE\((\w+)", r"Op%s\b"),
                            ("spirv/front/glsl450.def", r"^VITRINE_GLSL\((\w+)", r"glsl %s\b")):
        for name in re.findall(row, (root / table).read_text(), re.MULTILINE):
            if name not in listed and not re.search(use % name, text):
                yield f"{table}: no test uses {name}, and tests/spirv/opcode_tests does not say what does"


def step_faults(root):
    """Every step of the rewrites has a table in the test file that mirrors its source, which names it."""
    rows = re.findall(r'^VITRINE_PASS\(\w+, \w+, \w+, (\w+), "([^"]+)\.cpp"', (root / "spirv/rewrite/passes.def").read_text(),
                      re.MULTILINE)
    for function, file in sorted(set(rows)):
        test = root / f"tests/spirv/rewrite/{file}_test.cpp"
        if not test.exists() or not re.search(rf"\b{function}\b", test.read_text()):
            yield f"spirv/rewrite/passes.def: {test.relative_to(root)} has no table for {function}"


def capability_faults(root):
    """spirv/capabilities.def lists the SPIR-V capabilities whose features or extensions manifest/ claims, and no other.

    Those that a property of the device enables may stand there or not; so may what the registry does not know."""
    def claimed(file):
        return set(re.findall(r"^(\w+) *;", (root / file).read_text(), re.MULTILINE))
    listed = set(re.findall(r"^VITRINE(?:_NUMBERED)?_CAPABILITY\((\w+)", (root / "spirv/capabilities.def").read_text(), re.MULTILINE))
    claims = claimed("manifest/features") | claimed("manifest/extensions")
    def stem(name):
        """What the names of a capability share: registries call it by this author's or that one's, or by none."""
        return re.sub("(KHR|EXT|NV)$", "", name)
    stems = {stem(name) for name in listed}
    for registry in registries(root):
        needs = {}
        for row in ElementTree.parse(registry).iter("spirvcapability"):
            needs.setdefault(stem(row.attrib["name"]), []).extend(enable.attrib for enable in row.findall("enable"))
        for name, ways in needs.items():
            if any("property" in way for way in ways):
                continue
            allowed = any("version" in w or w.get("feature") in claims or w.get("extension") in claims for w in ways)
            if allowed != (name in stems):
                yield f"spirv/capabilities.def: {name} is {'claimed but missing' if allowed else 'not claimed'} ({registry})"


def dynamic_state_faults(root):
    """icd/record/dynamic_state.def has every VkDynamicState that extensions bring which manifest/ claims.

    VK_EXT_extended_dynamic_state3 has a feature for each of its states: those that are claimed."""
    text = (root / "icd/record/dynamic_state.def").read_text()
    listed = set(re.findall(r"^VITRINE_DYNAMIC_\w+\(\w+, (\w+),", text, re.MULTILINE))
    claimed = {file: set(re.findall(r"^(\w+) *;", (root / "manifest" / file).read_text(), re.MULTILINE))
               for file in ("extensions", "features")}
    revisions = {f[0]: int(f[1]) for f, _ in claims_module.rows(root / "manifest/extensions")}
    for registry in registries(root):
        for extension in ElementTree.parse(registry).iter("extension"):
            for row in extension.iterfind("require/enum[@extends='VkDynamicState']"):
                state = row.attrib["name"].removeprefix("VK_DYNAMIC_STATE_")
                feature = "extendedDynamicState3" + "".join(w.title() for w in state.split("_")[:-1])
                third = extension.attrib["name"] == "VK_EXT_extended_dynamic_state3"
                wanted = feature in claimed["features"] if third else extension.attrib["name"] in claimed["extensions"]
                brought_by, revision = vkxml.REVISIONS.get(row.attrib["name"], (None, 0))
                if "alias" not in row.attrib and wanted and state not in listed and revisions.get(brought_by, 0) >= revision:
                    yield f"icd/record/dynamic_state.def: lacks {state}, which {extension.attrib['name']} brings"


def pass_faults(root):
    """spirv/rewrite/passes.def names the file of each step, and every step and its file are in it."""
    base = root / "spirv/rewrite"
    row = r'^VITRINE_PASS\(\w+, \w+, \w+, (\w+), "([\w/.]+)"'
    rows = set(re.findall(row, (base / "passes.def").read_text(), re.MULTILINE))
    for function, file in sorted(rows):
        text = (base / file).read_text() if (base / file).exists() else ""
        if not re.search(rf"^(bool|void) {function}\(Graph& graph", text, re.MULTILINE):
            yield f"spirv/rewrite/passes.def: {file} has no {function}()"
    for folder in ("gallivm", "llvm", "lower", "nir"):
        for name in re.findall(r"^(?:bool|void) (\w+)\(", (base / folder / "passes.h").read_text(), re.MULTILINE):
            if name not in {function for function, _ in rows}:
                yield f"spirv/rewrite/passes.def: lacks {name}() of {folder}/passes.h"
        for path in sorted((base / folder).rglob("*.cpp")):
            own = re.search(r'^#include "([\w/.]+)"', path.read_text(), re.MULTILINE)
            helper = own and not own[1].endswith("/passes.h") and own[1].startswith(f"spirv/rewrite/{folder}/")
            if str(path.relative_to(base)) not in {file for _, file in rows} and not helper:
                yield f"{path.relative_to(root)}: neither a step of passes.def nor the file of a header beside it"


def asked_faults(root):
    """base/as_reference.def has the rows of deviations.md whose column says that they can be asked for."""
    table = (root / "cts-subset/deviations.md").read_text().split("\n\n| id | what the reference does elsewhere")[0]
    rows = re.findall(r"^\| ([\w-]+) \|.*\| (yes|no: [^|]+) \| `[^|]+\|$", table, re.MULTILINE)
    for name in re.findall(r"^\| ([a-z][\w-]+) \|", table, re.MULTILINE):
        if name not in [row for row, _ in rows] + ["id"]:
            yield f"cts-subset/deviations.md: {name} does not say whether it can be asked for"
    listed = set(re.findall(r'^VITRINE_DEVIATION\(\w+, "([\w-]+)"\)', (root / "base/as_reference.def").read_text(), re.MULTILINE))
    for name in sorted(listed ^ {row for row, asked in rows if asked == "yes"}):
        yield f"base/as_reference.def and cts-subset/deviations.md differ about {name}"


def shape_faults(root):
    for folder in ORDER + FREE:
        for path in sources(root, folder):
            text = path.read_text()
            where = path.relative_to(root)
            if path.suffix == ".cpp" and not text.startswith("//"):
                yield f"{where}: does not open with its purpose"
            if re.search(r"^\s*#\s*if\s+0\b", text, re.MULTILINE):
                yield f"{where}: dead code under #if 0"
            for number, line in enumerate(text.splitlines(), 1):
                if re.search(r"\bcase newer::", line):
                    yield f"{where}:{number}: older headers have no such enumerator, and GCC refuses it as a case (-Wswitch)"
                if re.search(r"\bstd::(cout|printf|puts)\b|(^|[^\w.>])printf\(", line) and folder in ORDER:
                    yield f"{where}:{number}: the library never prints to stdout"


def algorithm_faults(root):
    """Who uses the standard library's algorithms includes them: that other headers bring them is one compiler's accident."""
    for folder in ORDER + FREE:
        for path in sources(root, folder):
            text = path.read_text()
            used = ALGORITHMS.search(text)
            if used and "#include <algorithm>" not in text:
                yield f"{path.relative_to(root)}: uses {used[0][:-1]} without <algorithm>"


def report_tail(root):
    sizes = sorted(((len(p.read_text().splitlines()), p) for f in ORDER + FREE for p in sources(root, f)), reverse=True)
    print("longest files:")
    for lines, path in sizes[:10]:
        print(f"  {lines:5} {path.relative_to(root)}{'  (long)' if lines > LONG_FILE else ''}")


CHECKS = (include_faults, part_faults, circle_faults, header_faults, room_faults, claim_faults, opcode_faults,
          step_faults, capability_faults, dynamic_state_faults, pass_faults, asked_faults, shape_faults, algorithm_faults)


def main():
    root = pathlib.Path(sys.argv[1])
    faults = [f for check in CHECKS for f in check(root)]
    report_tail(root)
    for fault in faults:
        print(f"FAULT {fault}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
