#!/usr/bin/env python3
"""What packed files have inside that others wrote: their notices, and a list in SPDX 2.3.

usage: inside.py VERSION SECONDS ARCHITECTURE FOLDER HEADERS LIBRARIES COMPILER

NOTICES and vitrine.spdx.json, into FOLDER. SECONDS since 1970 go into the list as its date, so that two builds give the
same file. The versions are those of the installed packages; their notices are the copyright files that Debian installs
with them. HEADERS: the folder usr/ where manifest/pack/newer-headers has unpacked packages, which then are those inside;
LIBRARIES: where manifest/pack/cross-root has unpacked those of another architecture. Both can be empty. COMPILER: whose own
libraries are inside; dpkg tells their packages.
"""
import json
import pathlib
import subprocess
import sys
import time

# Package, what of it is inside.
INSIDE = (
    ("spirv-tools", "SPIRV-Tools, linked: names of instructions, reasons of refusals"),
    ("spirv-headers", "SPIR-V's headers and grammar"),
    ("libvulkan-dev", "Vulkan's headers and registry"),
    ("libhwy-dev", "Highway, headers: SIMD"),
    ("nlohmann-json3-dev", "JSON for Modern C++, headers: reports"),
    ("libcli11-dev", "CLI11, headers: the command line"),
    ("zlib1g-dev", "zlib, linked: bug files"),
)
# File of the compiler, what of it is inside.
OF_COMPILER = (
    ("libstdc++.a", "GCC's C++ runtime, linked"),
    ("libgcc.a", "GCC's support routines, linked"),
)


def unpacked(listing):
    """{package: version} of what a script has unpacked and listed."""
    return dict(row.split()[:2] for row in listing.read_text().splitlines())


def sources(architecture, headers, libraries):
    """[(folder usr/, {package: version})]: the first that has a package has what is inside."""
    found = []
    if headers:
        found.append((pathlib.Path(headers), unpacked(pathlib.Path(headers).parent / "complete")))
    if libraries:
        found.append((pathlib.Path(libraries) / "usr", unpacked(pathlib.Path(libraries) / f"architecture-{architecture}")))
    return found


def installed(package):
    return subprocess.run(["dpkg-query", "-W", "-f=${Version}", package], check=True, capture_output=True, text=True).stdout


def owner(compiler, name):
    """The installed package that has a library which the compiler links."""
    file = subprocess.run([compiler, f"-print-file-name={name}"], check=True, capture_output=True, text=True).stdout.strip()
    # "PACKAGE:ARCHITECTURE: FILE"
    told = subprocess.run(["dpkg-query", "-S", str(pathlib.Path(file).resolve())], check=True, capture_output=True, text=True).stdout
    return told.split(":")[0]


def main():
    version, seconds, architecture, folder = sys.argv[1], int(sys.argv[2]), sys.argv[3], pathlib.Path(sys.argv[4])
    apart, compiler = sources(architecture, *sys.argv[5:7]), sys.argv[7]
    text = ["Vitrine has parts of these inside. What follows are the notices that Debian's packages of them have.\n"]
    packages = []
    relations = []
    for package, role in INSIDE + tuple((owner(compiler, name), role) for name, role in OF_COMPILER):
        usr, number = next(((usr, versions[package]) for usr, versions in apart if package in versions), (pathlib.Path("/usr"), None))
        number = number or installed(package)
        copyright_file = usr / "share/doc" / package / "copyright"
        text.append(f"\n{'=' * 100}\n{package} {number}: {role}\n{'=' * 100}\n\n{copyright_file.read_text(errors='replace')}")
        packages.append({
            "SPDXID": f"SPDXRef-{package.replace('+', 'p')}", "name": package, "versionInfo": number,
            "supplier": "Organization: Debian", "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
            "licenseConcluded": "NOASSERTION", "licenseDeclared": "NOASSERTION", "copyrightText": "NOASSERTION",
            "comment": role,
            "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                              "referenceLocator": f"pkg:deb/debian/{package.replace('+', '%2B')}@{number.replace('+', '%2B')}?arch={architecture}"}]})
        relations.append({"spdxElementId": "SPDXRef-vitrine", "relationshipType": "CONTAINS",
                          "relatedSpdxElement": packages[-1]["SPDXID"]})
    packages.insert(0, {
        "SPDXID": "SPDXRef-vitrine", "name": "vitrine", "versionInfo": version, "downloadLocation": "NOASSERTION",
        "filesAnalyzed": False, "licenseConcluded": "MIT", "licenseDeclared": "MIT",
        "copyrightText": "Copyright (c) 2026 The Vitrine authors"})
    relations.insert(0, {"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES", "relatedSpdxElement": "SPDXRef-vitrine"})
    (folder / "NOTICES").write_text("".join(text))
    (folder / "vitrine.spdx.json").write_text(json.dumps({
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"vitrine-{version}",
        "documentNamespace": f"https://spdx.org/spdxdocs/vitrine-{version}-{seconds}",
        "creationInfo": {"created": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(seconds)), "creators": ["Tool: vitrine package"]},
        "packages": packages, "relationships": relations}, indent=1) + "\n")


main()
