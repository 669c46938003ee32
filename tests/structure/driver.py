#!/usr/bin/env python3
"""Checks the built driver: exports the loader's functions alone, needs few libraries, asks for no executable page, has
no static that is destroyed at exit, and leaves nothing behind when it is unloaded.

usage: driver.py LIBVITRINE_ICD_SO MANIFEST_JSON
"""
import _ctypes
import ctypes
import json
import pathlib
import subprocess
import sys

EXPORTS = {"vk_icdNegotiateLoaderICDInterfaceVersion", "vk_icdGetInstanceProcAddr", "vk_icdGetPhysicalDeviceProcAddr"}
# Window libraries are loaded with the first surface (design.md section 2), so none stands here.
LIBRARIES = {"libc.so.6", "libm.so.6", "ld-linux-x86-64.so.2"}
SANITIZER_LIBRARIES = ("libasan", "libubsan", "libtsan", "libstdc++", "libgcc_s")


def lines(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()


def heap_growth(library, times):
    """KiB of data that `times` loads and unloads leave behind."""
    def size():
        status = pathlib.Path("/proc/self/status").read_text()
        return int(status.split("VmData:")[1].split()[0])
    for i in range(times + 1):
        _ctypes.dlclose(ctypes.CDLL(library)._handle)
        if i == 0:
            before = size()
    return size() - before


def faults(library, manifest):
    exports = {line.split()[-1] for line in lines("nm", "-D", "--defined-only", library)}
    for name in sorted(exports - EXPORTS):
        yield f"exports {name}"
    for name in sorted(EXPORTS - exports):
        yield f"does not export {name}"
    needed = [line.split("[")[1].rstrip("]") for line in lines("readelf", "-d", library) if "(NEEDED)" in line]
    sanitized = any(n.startswith(("libasan", "libtsan")) for n in needed)
    for name in needed:
        if name not in LIBRARIES and not (sanitized and name.startswith(SANITIZER_LIBRARIES)):
            yield f"needs {name}"
    headers = "\n".join(lines("readelf", "-lW", library))
    if any("GNU_STACK" in line and "E" in line.split()[-2] for line in headers.splitlines()):
        yield "asks for an executable stack"
    if any("LOAD" in line and "RWE" in line.replace(" ", "") for line in headers.splitlines()):
        yield "has a segment that is writable and executable"
    # mprotect is how a page becomes executable after the fact; mmap is ours (device memory) and never asks for it.
    undefined = {line.split()[-1].split("@")[0] for line in lines("nm", "-D", "--undefined-only", library)}
    for name in ("mprotect", "pkey_mprotect"):
        if name in undefined and not sanitized:
            yield f"calls {name}"
    # Statics with destructors are gone when the exit handlers of the application draw: base/lasting.h.
    # A thread_local with a destructor keeps the library loaded until its thread ends.
    function = ""
    for line in () if sanitized else lines("objdump", "-d", "--no-show-raw-insn", library):
        if line.endswith(">:"):
            function = line.split("<")[1]
        elif "<__cxa_atexit" in line and "7vitrine" in function:
            yield f"{function[:-2]} has a static local with a destructor"
        elif "<__cxa_thread_atexit" in line and "7vitrine" in function:
            yield f"{function[:-2]} has a thread_local with a destructor"
    # The loader unloads a driver with its last instance, and applications make thousands of instances.
    growth = 0 if sanitized else heap_growth(library, 100)
    if growth > 1024:
        yield f"leaves {growth} KiB behind when it is loaded 100 times"
    text = json.loads(pathlib.Path(manifest).read_text())
    path = text["ICD"]["library_path"]
    if not path.startswith("./") or not (pathlib.Path(manifest).parent / path).exists():
        yield f"manifest names {path}, which is not beside it"


def main():
    found = list(faults(sys.argv[1], sys.argv[2]))
    for fault in found:
        print(f"FAULT {fault}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
