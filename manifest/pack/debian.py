#!/usr/bin/env python3
"""Writes what a Debian package has beside the installed files.

usage: debian.py VERSION SECONDS ROOT TREE

Control file, copyright, change log (from docs/changelog.md) and what lintian is told, into TREE (usr below it is there).
"""
import email.utils
import pathlib
import re
import sys
import textwrap

CONTROL = """Package: vitrine
Version: {version}
Architecture: amd64
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


def main():
    version, seconds, root, tree = sys.argv[1], int(sys.argv[2]), pathlib.Path(sys.argv[3]), pathlib.Path(sys.argv[4])
    doc = tree / "usr/share/doc/vitrine"
    licence = (root / "LICENSE").read_text().split("\n\n", 2)[2].strip()
    paragraphs = "\n .\n".join(" " + p.replace("\n", "\n ") for p in licence.split("\n\n"))
    (doc / "copyright").write_text("Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\nUpstream-Name: vitrine\n\n"
                                   f"Files: *\nCopyright: 2026 The Vitrine authors\nLicense: Expat\n{paragraphs}\n")
    (doc / "changelog").write_text(changelog(root, seconds))
    overrides = tree / "usr/share/lintian/overrides"
    overrides.mkdir(parents=True)
    (overrides / "vitrine").write_text(OVERRIDES)
    size = sum(path.stat().st_size for path in (tree / "usr").rglob("*") if path.is_file()) // 1024 + 1
    (tree / "DEBIAN/control").write_text(CONTROL.format(version=version, maintainer=MAINTAINER, size=size))


main()
