#!/usr/bin/env python3
"""What ./package makes: runs where it was unpacked, asks for no newer C library than it says, has its debug symbols
apart, passes lintian, and is the same twice. For 64-bit ARM the same, run by QEMU, with the picture of this machine's.
What it cannot check because a tool is missing it says at its end: "NOT CHECKED".

usage: package_test.py ROOT WORK [ARCHITECTURE]

WORK: a folder in the build tree that has this machine's demo and driver.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile

NEWEST_GLIBC = (2, 31)
MOST_PACKED, MOST_UNPACKED = 6_000_000, 15_000_000
PROGRAMS = ("lib/vitrine/libvitrine_icd.so", "bin/vitrine", "bin/vitrine-replay")
MACHINES = {"amd64": "x86_64", "arm64": "aarch64"}
# A function of each program that debuggers find, and its file.
SEEN_BY_DEBUGGERS = {"lib/vitrine/libvitrine_icd.so": ("vk_icdGetInstanceProcAddr", "icd/edge/loader.cpp"), "bin/vitrine": ("main", "glass/cli/main.cpp"),
                     "bin/vitrine-replay": ("main", "glass/replayer/main.cpp")}
# Lines of functions that the linker has thrown away stay at address 0 and up, in this small program as far as those that are
# there: gdb passes over them, addr2line does not.
NOT_BY_ADDR2LINE = ("bin/vitrine-replay",)


unchecked = []  # what, and why


def has(tool, what):
    """Whether the tool is installed; else what it is for is not checked."""
    if shutil.which(tool):
        return True
    unchecked.append(f"{what}: {tool} is missing (manifest/install-packages package)")
    return False


def run(*command, **settings):
    return subprocess.run(command, check=True, capture_output=True, text=True, **settings).stdout


def pack(root, architecture):
    """The files' bytes by name."""
    shutil.rmtree(root / "build/packages", ignore_errors=True)
    run(root / "package", "--arch", architecture)
    return {path.name: path.read_bytes() for path in (root / "build/packages").iterdir() if path.is_file()}


def faults_of_symbols(tree, tool):
    """The programs' functions and lines are found, by build-id, in the tree that has both archives."""
    for program, (function, source) in SEEN_BY_DEBUGGERS.items():
        known = re.search(r"Build ID: ([0-9a-f]+)", run(tool + "readelf", "-n", tree / program))
        if not known:
            yield f"{program} has no build-id"
            continue
        if ".symtab" in run(tool + "readelf", "-SW", tree / program):
            yield f"{program} is not stripped"
        symbols = tree / "lib/debug/.build-id" / known[1][:2] / f"{known[1][2:]}.debug"
        if not symbols.is_file():
            yield f"{program} has no debug symbols of its build-id"
            continue
        address = re.search(rf"^([0-9a-f]+) T {function}$", run(tool + "nm", symbols), re.M)
        if address and program in NOT_BY_ADDR2LINE:
            continue
        place = run(tool + "addr2line", "-fe", symbols, address[1]).split() if address else []
        if not place or not place[0].startswith(function) or f"/usr/src/vitrine/{source}" not in os.path.normpath(place[1]):
            yield f"{program}: {function} is at {place}"


def faults_of_gdb(tree):
    """gdb, too, finds them in the folder that it is told."""
    if not has("gdb", "that gdb finds lines of the programs"):
        return
    for program, (function, source) in SEEN_BY_DEBUGGERS.items():
        said = run("gdb", "-nx", "-batch", "-iex", f"set debug-file-directory {tree / 'lib/debug'}", "-ex", f"info line {function}", tree / program)
        if not re.search(rf'Line \d+ of ".*{source}"', said):
            yield f"gdb finds no line of {program}: {said}"


def faults_of_debs(root, version, architecture):
    packages = root / "build/packages"
    files = [packages / f"{name}_{version}_{architecture}.deb" for name in ("vitrine", "vitrine-dbgsym")]
    for file in files:
        if run("dpkg-deb", "--field", file, "Architecture").strip() != architecture:
            yield f"{file.name} is for another architecture"
    if run("dpkg-deb", "--field", files[1], "Depends").strip() != f"vitrine (= {version})":
        yield f"{files[1].name} is not that of its package"
    if has("lintian", "what lintian says of the Debian packages"):
        told = subprocess.run(["lintian", "--allow-root", "--fail-on", "error,warning", *files], capture_output=True, text=True)
        if told.returncode:
            yield f"lintian: {told.stdout}{told.stderr}"


def faults_of_running(root, tree, architecture):
    """The command finds its driver; for ARM it starts, and the demo's picture is this machine's."""
    if architecture == "amd64":
        summary = run(tree / "bin/vitrine", "run", "vulkaninfo", "--summary", cwd="/")
        if "deviceName         = Vitrine" not in summary:
            yield f"the unpacked command runs on another device: {summary}"
        return
    if not has("qemu-aarch64-static", "that what is packed for 64-bit ARM runs"):
        return
    emulated = ("qemu-aarch64-static", "-L", root / "build/arm64-root")
    version = tree.name.split("-")[1]
    if version not in (said := run(*emulated, tree / "bin/vitrine", "--version")):
        yield f"the command does not tell its version on ARM: {said}"
    run("cmake", "--build", root / "build/portable-arm64", "--target", "vitrine_demo")
    run("cmake", "--build", tree.parent.parent, "--target", "vitrine_demo", "vitrine_icd_library")
    pictures = []
    for program, machine, folder in (([*emulated, root / "build/portable-arm64/tests/vitrine_demo"], "aarch64", tree / "lib/vitrine"),
                                     ([tree.parent.parent / "tests/vitrine_demo"], "x86_64", tree.parent.parent / "icd")):
        picture = tree.parent / f"{machine}.png"
        run(*program, picture, env=os.environ | {"VK_DRIVER_FILES": str(folder / f"vitrine_icd.{machine}.json")})
        pictures.append(picture.read_bytes())
    if pictures[0] != pictures[1]:
        yield "the demo's picture is another one on ARM"
    print(f"the demo's picture: {len(pictures[0])} bytes")


def faults(root, work, architecture):
    machine, tool = MACHINES[architecture], "aarch64-linux-gnu-" if architecture == "arm64" else ""
    first = pack(root, architecture)
    version = re.search(r"project\(vitrine VERSION ([0-9.]+)", (root / "CMakeLists.txt").read_text())[1]
    archive, debug = f"vitrine-{version}-{machine}.tar.gz", f"vitrine-{version}-{machine}-debug.tar.gz"
    if sorted(first) != sorted([archive, debug, f"vitrine_{version}_{architecture}.deb", f"vitrine-dbgsym_{version}_{architecture}.deb"]):
        yield f"unexpected files: {sorted(first)}"
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    tree = work / archive.removesuffix(".tar.gz")
    with tarfile.open(root / "build/packages" / archive) as packed:
        packed.extractall(work)
    unpacked = sum(path.stat().st_size for path in tree.rglob("*") if path.is_file())
    print(f"{archive}: {len(first[archive])} bytes, {unpacked} unpacked")
    if len(first[archive]) > MOST_PACKED or unpacked > MOST_UNPACKED:
        yield f"{len(first[archive])} bytes, {unpacked} unpacked"
    if f"# Vitrine {version}" not in (tree / "README.md").read_text():
        yield "the archive has no README of its version"
    with tarfile.open(root / "build/packages" / debug) as packed:
        packed.extractall(work)
    for program in PROGRAMS:
        for wanted in re.findall(r"GLIBC_([0-9.]+)", run(tool + "objdump", "-T", tree / program)):
            if tuple(map(int, wanted.split("."))) > NEWEST_GLIBC:
                yield f"{program} wants glibc {wanted}"
        if "RUNPATH" in (dynamic := run(tool + "readelf", "-d", tree / program)) or "RPATH" in dynamic:
            yield f"{program} has a path for libraries"
        if "libstdc++" in dynamic:
            yield f"{program} wants a C++ runtime"
    yield from faults_of_symbols(tree, tool)
    if not tool:
        yield from faults_of_gdb(tree)
    yield from faults_of_debs(root, version, architecture)
    yield from faults_of_running(root, tree, architecture)
    flags = run("pkg-config", "--variable=icd_manifest", "vitrine", env={"PKG_CONFIG_PATH": str(tree / "share/pkgconfig"), "PATH": "/usr/bin:/bin"})
    if not pathlib.Path(flags.strip()).is_file():
        yield f"pkg-config names {flags}"
    shutil.rmtree(root / "build" / ("portable-arm64" if tool else "portable"))
    for name, contents in pack(root, architecture).items():
        if first.get(name) != contents:
            yield f"{name} is another file the second time"


def main():
    architecture = sys.argv[3] if len(sys.argv) > 3 else "amd64"
    found = list(faults(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), architecture))
    print("\n".join(f"NOT CHECKED {what}" for what in unchecked))
    print("\n".join(f"FAULT {fault}" for fault in found) or "packages: as they should be")
    return 1 if found else 0


sys.exit(main())
