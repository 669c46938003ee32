#!/usr/bin/env python3
"""What ./package makes: runs where it was unpacked, asks for no newer C library than it says, and is the same twice.

usage: package_test.py ROOT WORK
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile

NEWEST_GLIBC = (2, 31)
MOST_PACKED, MOST_UNPACKED = 6_000_000, 15_000_000
PROGRAMS = ("lib/vitrine/libvitrine_icd.so", "bin/vitrine", "bin/vitrine-replay")


def run(*command, **settings):
    return subprocess.run(command, check=True, capture_output=True, text=True, **settings).stdout


def pack(root):
    """The two files' bytes by name."""
    run(root / "package")
    return {path.name: path.read_bytes() for path in (root / "build/packages").iterdir() if path.is_file()}


def faults(root, work):
    first = pack(root)
    if sorted(pathlib.PurePath(name).suffix for name in first) != [".deb", ".gz"]:
        yield f"unexpected files: {sorted(first)}"
    name = next(name for name in first if name.endswith(".tar.gz"))
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    with tarfile.open(root / "build/packages" / name) as archive:
        archive.extractall(work)
    tree = work / name.removesuffix(".tar.gz")
    unpacked = sum(path.stat().st_size for path in tree.rglob("*") if path.is_file())
    if len(first[name]) > MOST_PACKED or unpacked > MOST_UNPACKED:
        yield f"{len(first[name])} bytes, {unpacked} unpacked"
    for program in PROGRAMS:
        for version in re.findall(r"GLIBC_([0-9.]+)", run("objdump", "-T", tree / program)):
            if tuple(map(int, version.split("."))) > NEWEST_GLIBC:
                yield f"{program} wants glibc {version}"
        if "RUNPATH" in (dynamic := run("readelf", "-d", tree / program)) or "RPATH" in dynamic:
            yield f"{program} has a path for libraries"
        if "libstdc++" in dynamic:
            yield f"{program} wants a C++ runtime"
    summary = run(tree / "bin/vitrine", "run", "vulkaninfo", "--summary", cwd="/")
    if "deviceName         = Vitrine" not in summary:
        yield f"the unpacked command runs on another device: {summary}"
    flags = run("pkg-config", "--variable=icd_manifest", "vitrine", env={"PKG_CONFIG_PATH": str(tree / "share/pkgconfig"), "PATH": "/usr/bin:/bin"})
    if not pathlib.Path(flags.strip()).is_file():
        yield f"pkg-config names {flags}"
    shutil.rmtree(root / "build/portable")
    for name, contents in pack(root).items():
        if first.get(name) != contents:
            yield f"{name} is another file the second time"


def main():
    found = list(faults(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])))
    print("\n".join(f"FAULT {fault}" for fault in found) or "packages: as they should be")
    return 1 if found else 0


sys.exit(main())
