#!/usr/bin/env python3
"""Generates what the suite knows of its own sources: a hash of each file that defines cases, and one of all.

usage: revision.py SUITE_FOLDER OUTPUT_FILE
"""
import hashlib
import pathlib
import sys


def main():
    suite = pathlib.Path(sys.argv[1])
    files = sorted(file for room in ("harness", "cases") for file in (suite / room).rglob("*") if file.suffix in (".cpp", ".h"))
    everything = hashlib.sha256()
    rows = []
    for file in files:
        content = file.read_bytes()
        everything.update(content)
        if "cases" in file.parts and file.suffix == ".cpp":
            digest = hashlib.sha256(content).hexdigest()[:8]
            rows.append(f'    {{"cts-subset/{file.relative_to(suite).as_posix()}", 0x{digest}}},\n')
    pathlib.Path(sys.argv[2]).write_text(f"""// Generated from the suite's sources by cts-subset/harness/revision.py.
#pragma once

#include <cstdint>

namespace vitrine::cts {{

struct SourceFile {{
  const char* path;
  uint32_t hash;
}};

/// The files that define cases.
inline constexpr SourceFile kSourceFiles[] = {{
{"".join(rows)}}};
/// Of all files of the suite.
inline constexpr uint32_t kRevision = 0x{everything.hexdigest()[:8]};

}}  // namespace vitrine::cts
""")


if __name__ == "__main__":
    main()
