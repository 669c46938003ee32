#!/usr/bin/env python3
"""Writes what a Debian package has beside the installed files.

usage: debian.py VERSION SECONDS ARCHITECTURE ROOT TREE SYMBOLS

Control file, copyright, change log (from docs/changelog.md) and what lintian is told, into TREE (usr below it is there);
the control file of what debuggers want of it (.debug files are there), into SYMBOLS.
"""
import email.utils
import pathlib
import re
import sys
import textwrap

CONTROL = """Package: vitrine
Version: {version}
Architecture: {architecture}
Maintainer: {maintainer}
Installed-Size: {size}
Depends: libc6 (>= 2.31)
Recommends: libvulkan1
Suggests: libxcb1, libxcb-shm0, libwayland-client0, vulkan-validationlayers
Section: libs
Priority: optional
Description: Vulkan device in software that shows what happens inside
 Vitrine is a Vulkan 1.4 driver that runs without a GPU: an interpreter of
 SPIR-V over wide SIMD, a clipper and a rasterizer. Its pixels are those of
 Mesa's lavapipe bit by bit and depend neither on threads nor on the CPU.
 .
 The command vitrine runs programs on it and tells faults of shaders by
 source line, their coverage and counts, hazards, and why a pixel is as it is.
"""
# As debhelper writes it.
SYMBOLS_CONTROL = """Package: vitrine-dbgsym
Source: vitrine
Version: {version}
Auto-Built-Package: debug-symbols
Architecture: {architecture}
Maintainer: {maintainer}
Installed-Size: {size}
Depends: vitrine (= {version})
Section: debug
Priority: optional
Description: debug symbols for vitrine
Build-Ids: {ids}
"""
MAINTAINER = "The Vitrine authors <vitrine@users.noreply.github.com>"
OVERRIDES = """# One file for all of Debian 11 and newer: the C++ runtime, SPIRV-Tools and zlib are inside (NOTICES.gz).
vitrine: embedded-library *
vitrine: initial-upload-closes-no-bugs *
"""


def changelog(root, seconds):
    """The newest entry has the date of the commit, those before a day less each: lintian wants them in order."""
    out = []
    for version, changes in re.findall(r"^## ([0-9.]+)[^\n]*\n(.*?)(?=^## |\Z)", (root / "docs/changelog.md").read_text(), re.M | re.S):
        lines = [re.sub(r"\s+", " ", change.strip()) for change in re.split(r"^\* ", changes, flags=re.M)[1:]]
        date = email.utils.formatdate(seconds - 86400 * len(out))
        text = "\n".join(textwrap.fill(line, 78, initial_indent="  * ", subsequent_indent="    ") for line in lines)
        out.append(f"vitrine ({version}) unstable; urgency=medium\n\n{text}\n"
                   f"\n -- {MAINTAINER}  {date}\n")
    return "\n".join(out)


def size_of(tree):
    """In KiB."""
    return sum(path.stat().st_size for path in (tree / "usr").rglob("*") if path.is_file() and not path.is_symlink()) // 1024 + 1


def main():
    version, seconds, architecture = sys.argv[1], int(sys.argv[2]), sys.argv[3]
    root, tree, symbols = map(pathlib.Path, sys.argv[4:7])
    doc = tree / "usr/share/doc/vitrine"
    licence = (root / "LICENSE").read_text().split("\n\n", 2)[2].strip()
    paragraphs = "\n .\n".join(" " + p.replace("\n", "\n ") for p in licence.split("\n\n"))
    (doc / "copyright").write_text("Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\nUpstream-Name: vitrine\n\n"
                                   f"Files: *\nCopyright: 2026 The Vitrine authors\nLicense: Expat\n{paragraphs}\n")
    (doc / "changelog").write_text(changelog(root, seconds))
    overrides = tree / "usr/share/lintian/overrides"
    overrides.mkdir(parents=True)
    (overrides / "vitrine").write_text(OVERRIDES)
    common = {"version": version, "architecture": architecture, "maintainer": MAINTAINER}
    (tree / "DEBIAN/control").write_text(CONTROL.format(size=size_of(tree), **common))
    ids = sorted(path.parent.name + path.stem for path in symbols.rglob("*.debug"))
    (symbols / "DEBIAN/control").write_text(SYMBOLS_CONTROL.format(size=size_of(symbols), ids=" ".join(ids), **common))


main()
