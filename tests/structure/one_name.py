#!/usr/bin/env python3
"""No two types of the rooms have one qualified name: the linker would take the functions that a compiler makes for one of
them (of a vector of it, say) for both (C++20, One-definition rule). Types in unnamed namespaces and in other types are free.

usage: one_name.py ROOT
"""
import collections
import pathlib
import re
import sys

ROOMS = ("base", "texel", "spirv", "raster", "glass", "icd")
# Comments, strings, characters and lines of the preprocessor; then what opens and closes a scope.
NO_CODE = re.compile(r"//[^\n]*|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])'|^[ \t]*#(?:[^\n\\]|\\.|\\\n)*", re.M)
SCOPE = re.compile(r"namespace\s*([\w:]*)\s*\{|(?<![<,])(?<![<,] )\b(?:struct|class|union|enum(?:\s+class)?)\s+(?:\[\[[^\]]*\]\]\s*|alignas\([^)]*\)\s*)?"
                   r"(\w+)(?!\s*(?:::|<|\w))[^;{}()=]*\{|[{}]")


def types_of(text):
    """Qualified names of the types that are defined at the scope of a named namespace."""
    scopes = []
    for found in SCOPE.finditer(NO_CODE.sub(" ", text)):
        if found[0] == "}":
            if scopes:
                scopes.pop()
            continue
        if found[2] and all(scope for scope in scopes):
            yield "::".join([*scopes, found[2]])
        scopes.append(found[1] if found[0].startswith("namespace") else "")


def faults(root):
    places = collections.defaultdict(list)
    for room in ROOMS:
        for path in sorted((root / room).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                for name in types_of(path.read_text()):
                    places[name].append(str(path.relative_to(root)))
    return [f"{name} is defined in {' and in '.join(files)}" for name, files in sorted(places.items()) if len(set(files)) > 1]


def main():
    # What it sees, and what it does not.
    seen = list(types_of("namespace a { struct B {}; namespace { struct C {}; } template <class D> struct E { struct F {}; }; void g() { struct H {}; } }"))
    assert seen == ["a::B", "a::E"], seen
    found = faults(pathlib.Path(sys.argv[1]))
    print("\n".join(f"FAULT {fault}" for fault in found) or "types: one name each")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
