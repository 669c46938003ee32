#!/usr/bin/env python3
"""Holds a device against Vulkan profiles: what of each one it lacks.

usage: profiles.py [--device FILE] [--only PATTERN] [--expect PROFILE=COUNT ...] PROFILES_JSON...

PROFILES_JSON: files of the Vulkan Profiles schema (Khronos' and LunarG's are in the repository Vulkan-Profiles, the
folder profiles/). --device: what `vulkaninfo --json` wrote; without it vulkaninfo is run on the drivers that the loader
finds, and the loader for features that an older one does not know (loader.py). A file says nothing of instances, whose extensions then count as there. How a limit is compared (more, less, all bits, equal) says the attribute limittype of vk.xml.

Prints the lacking items and a line a profile. Ends with 1 if a count is not the expected one (of a profile that no
--expect names nothing is expected), with 2 if something cannot be read.
"""
import argparse
import fnmatch
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import loader

# What manifest/pack/newer-headers has unpacked, else what is installed.
REGISTRIES = [pathlib.Path(__file__).resolve().parents[2] / "build/headers/usr/share/vulkan/registry/vk.xml",
              pathlib.Path("/usr/share/vulkan/registry/vk.xml")]
REGISTRY = next((path for path in REGISTRIES if path.exists()), REGISTRIES[-1])

# Members whose attribute says nothing, or the contrary of what is meant: more is better, or less.
KNOWN_TYPES = {"minMemoryMapAlignment": "max", "mipmapPrecisionBits": "bits", "subPixelPrecisionBits": "bits",
               "subTexelPrecisionBits": "bits", "viewportSubPixelBits": "bits", "subPixelInterpolationOffsetBits": "bits",
               "timestampPeriod": "ignored", "pointSizeGranularity": "min", "lineWidthGranularity": "min",
               "strictLines": "true", "standardSampleLocations": "true", "residencyAlignedMipSize": "ignored",
               "subgroupSize": "max"}
# Bits that stand for several.
GRAPHICS = {f"VK_SHADER_STAGE_{stage}_BIT"
            for stage in ("VERTEX", "TESSELLATION_CONTROL", "TESSELLATION_EVALUATION", "GEOMETRY", "FRAGMENT")}


def limit_types(registry):
    """{(structure, member): (limittype, type)}, {name: what it is another name of}, and the instance extensions."""
    kinds, aliases = {}, {}
    root = ElementTree.parse(registry).getroot()
    for value in root.iter("enum"):
        if value.get("alias"):
            aliases[value.get("name")] = value.get("alias")
    of_instances = {e.get("name") for e in root.iter("extension") if e.get("type") == "instance"}
    for struct in root.iter("type"):
        if struct.get("category") != "struct":
            continue
        if struct.get("alias"):
            aliases[struct.get("name")] = struct.get("alias")
        for member in struct.iter("member"):
            name = member.find("name")
            if name is not None:
                kind = KNOWN_TYPES.get(name.text, member.get("limittype", "exact"))
                kinds[struct.get("name"), name.text] = (kind, member.find("type").text)
    return kinds, aliases, of_instances


class Device:
    """What a device says of itself, found by the names of members: a feature counts wherever it is told."""

    def __init__(self, capabilities, of_instance=None):
        """of_instance: extensions of instances; None: not known."""
        self.extensions = set(capabilities.get("extensions", {})) | set(of_instance or ())
        self.instance_known = of_instance is not None
        self.structures = capabilities.get("properties", {})
        self.features = {name for struct in capabilities.get("features", {}).values()
                         for name, value in struct.items() if value is True}
        self.members = {name: value for struct in self.structures.values() for name, value in struct.items()}
        self.formats = capabilities.get("formats", {})
        self.families = capabilities.get("queueFamiliesProperties", [])
        self.version = version_of(str(self.structures["VkPhysicalDeviceProperties"]["apiVersion"]))


def version_of(text):
    """(major, minor, patch) of "1.3.239" or of the packed number."""
    if text.isdigit():
        return int(text) >> 22 & 0x7f, int(text) >> 12 & 0x3ff, int(text) & 0xfff
    return tuple(int(part) for part in text.split("."))


class Comparison:
    def __init__(self, device, registry):
        self.device = device
        self.kinds, self.aliases, of_instances = limit_types(registry)
        self.unknown = set() if device.instance_known else of_instances

    def holds(self, struct, member, wanted, have):
        """Whether a member's value is at least as good as the wanted one."""
        if have is None:
            return wanted in (False, 0, [])
        struct = self.aliases.get(struct, struct)
        kind, type_name = self.kinds.get((struct, member), ("exact", ""))
        if kind in ("ignored", "noauto"):
            return True
        if isinstance(wanted, dict):
            return all(self.holds(type_name, m, w, have.get(m)) for m, w in wanted.items())
        if isinstance(wanted, bool):
            return have or not wanted
        if isinstance(wanted, list) and wanted and isinstance(wanted[0], str):
            wanted = set(wanted)
            return (wanted - {"VK_SHADER_STAGE_ALL_GRAPHICS"} <= set(have) and
                    ("VK_SHADER_STAGE_ALL_GRAPHICS" not in wanted or GRAPHICS <= set(have)))
        if kind == "range":
            return have[0] <= wanted[0] and have[1] >= wanted[1]
        if isinstance(wanted, list):
            return all(self.compare(kind, w, h) for w, h in zip(wanted, have))
        return self.compare(kind, wanted, have)

    @staticmethod
    def compare(kind, wanted, have):
        if kind.startswith("min"):
            return have <= wanted
        if kind.startswith("max") or kind == "bits":
            return have >= wanted
        return have == wanted

    def lacking(self, block):
        """What the device lacks of one block of capabilities."""
        out = [name for name in block.get("extensions", {}) if name not in self.device.extensions | self.unknown]
        for struct in block.get("features", {}).values():
            out += [f"feature {name}" for name, wanted in struct.items() if wanted and name not in self.device.features]
        for struct, members in block.get("properties", {}).items():
            out += self.lacking_properties(struct, members)
        for name, wanted in block.get("formats", {}).items():
            out += self.lacking_format(name, wanted)
        for family in block.get("queueFamiliesProperties", []):
            if not any(self.has_family(family, have) for have in self.device.families):
                out.append(f"queue family {family}")
        return out

    def lacking_properties(self, struct, members):
        own = self.device.structures.get(struct, {})
        out = []
        for member, wanted in members.items():
            have = own.get(member, self.device.members.get(member))
            if isinstance(wanted, dict) and isinstance(have, dict):
                kind = self.kinds.get((struct, member), ("", ""))[1]
                out += [f"{member}.{m} {w} (is {have.get(m)})" for m, w in wanted.items()
                        if not self.holds(kind, m, w, have.get(m))]
            elif not self.holds(struct, member, wanted, have):
                out.append(f"{member} {wanted} (is {have})")
        return out

    def lacking_format(self, name, wanted):
        have = self.device.formats.get(name, self.device.formats.get(self.aliases.get(name), {}))
        out = []
        for struct, members in wanted.items():
            for member, bits in members.items():
                missing = set(bits) - set(have.get(struct, {}).get(member, []))
                out += [f"{name} {member} {bit}" for bit in sorted(missing)]
        return out

    @staticmethod
    def has_family(wanted, have):
        wanted, have = wanted.get("VkQueueFamilyProperties", {}), have["VkQueueFamilyProperties"]
        return (set(wanted.get("queueFlags", [])) <= set(have["queueFlags"]) and
                wanted.get("queueCount", 0) <= have["queueCount"] and
                wanted.get("timestampValidBits", 0) <= have["timestampValidBits"])


def lacking_of(profile, document, comparison, known):
    """What is lacking of a profile and of those that it is made of, each item once."""
    out = []
    wanted = version_of(profile["api-version"])
    if comparison.device.version < wanted:
        out.append(f"version {profile['api-version']} (is {'.'.join(map(str, comparison.device.version))})")
    for other in profile.get("profiles", []):
        base, base_document = known[other]
        out += lacking_of(base, base_document, comparison, known)
    for block in profile["capabilities"]:
        # A list has alternatives: the one that lacks least.
        choices = block if isinstance(block, list) else [block]
        out += min((comparison.lacking(document["capabilities"][choice]) for choice in choices), key=len)
    return list(dict.fromkeys(out))


def ask_vulkaninfo():
    with tempfile.TemporaryDirectory() as folder:
        run = {"cwd": folder, "check": True, "stderr": subprocess.DEVNULL, "stdout": subprocess.PIPE, "text": True,
               "env": {"XDG_RUNTIME_DIR": folder, **os.environ}}
        subprocess.run(["vulkaninfo", "--json", "-o", "device.json"], **run)
        summary = subprocess.run(["vulkaninfo", "--summary"], **run).stdout
        told = json.loads(pathlib.Path(folder, "device.json").read_text())["capabilities"]["device"]
    device = Device(told, re.findall(r"^(VK_\w+) +: extension revision", summary, re.MULTILINE))
    more = loader.Asked(REGISTRY)
    device.features |= more.features
    for members in more.numbers.values():
        device.members.update({m: value for m, value in members.items() if value and m not in device.members})
    for struct in device.structures.values():
        for member in ("supportedOperations", "subgroupSupportedOperations"):
            if member in struct:
                struct[member] = sorted({*struct[member], *more.operations})
    return device


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", type=pathlib.Path)
    parser.add_argument("--only", default="*")
    parser.add_argument("--expect", action="append", default=[])
    parser.add_argument("profiles", nargs="+", type=pathlib.Path)
    arguments = parser.parse_args()
    try:
        if arguments.device:
            device = Device(json.loads(arguments.device.read_text())["capabilities"]["device"])
        else:
            device = ask_vulkaninfo()
        comparison = Comparison(device, REGISTRY)
        documents = [json.loads(path.read_text()) for path in arguments.profiles]
    except (OSError, ValueError, KeyError, subprocess.CalledProcessError) as problem:
        print(f"profiles.py: {problem}", file=sys.stderr)
        return 2
    known = {name: (profile, document) for document in documents for name, profile in document["profiles"].items()
             if "capabilities" in profile}
    expected = {name: int(count) for name, count in (word.rsplit("=", 1) for word in arguments.expect)}
    wrong = False
    for name, (profile, document) in sorted(known.items()):
        if not fnmatch.fnmatch(name, arguments.only):
            continue
        lacking = lacking_of(profile, document, comparison, known)
        for item in lacking:
            print(f"  {name}: {item}")
        print(f"{name}: {len(lacking)} lacking")
        wrong |= expected.get(name, len(lacking)) != len(lacking)
    return int(wrong)


if __name__ == "__main__":
    sys.exit(main())
