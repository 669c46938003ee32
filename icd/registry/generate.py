#!/usr/bin/env python3
"""Generates the tables that icd/ derives from the Vulkan registry and from the claims in manifest/.

usage: generate.py VK_XML MANIFEST_FOLDER OUTPUT_FOLDER

Output: enums.h (Extension, Feature), structure_types.h (sType of every structure), entry_points.h (declaration of every
command), properties.h (every property structure with its claimed values), tables.cpp (entry points, extensions, feature
and property structures as constexpr tables), limit_rules.h (what the tests ask of the limits).
"""
import pathlib
import re
import sys

import claims as claims_module
import vkxml

# Members that got another name when their structure became core.
CORE_NAMES = {"subgroupSupportedStages": "supportedStages", "subgroupSupportedOperations": "supportedOperations",
              "subgroupQuadOperationsInAllStages": "quadOperationsInAllStages"}
BANNER = "// Generated from vk.xml and manifest/ by icd/registry/generate.py.\n"


def fail(message):
    raise SystemExit(f"generate.py: {message}")


def write(path, text):
    """Leaves an unchanged file alone, so that nothing is rebuilt for it."""
    text = BANNER + text
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


def enumerator(extension):
    return extension.removeprefix("VK_")


class Generator:
    def __init__(self, registry, claims):
        self.registry = registry
        self.claims = claims
        # An older registry does not know the version: that claim, too, waits for newer headers.
        self.version = min(vkxml.version_number(claims.api_version), max(registry.core_versions))
        for name in claims.extensions:
            if name not in registry.extensions:
                # An older registry does not know the extension: the claim waits for newer headers.
                print(f"note: {name} is claimed but not in this registry", file=sys.stderr)
        self.claimed = {n for n in registry.extensions if n in claims.extensions}
        self.feature_names = self.feature_structs = None
        self._collect_features()
        self._check()

    def holds(self, gate):
        return gate.version <= self.version and all(e in self.claimed for e in gate.extensions)

    def available(self, thing):
        return any(self.holds(g) for g in thing.gates)

    def _collect_features(self):
        structs = self.registry.structs
        self.feature_structs = [structs["VkPhysicalDeviceFeatures"]]
        self.feature_structs += [s for s in structs.values() if "VkPhysicalDeviceFeatures2" in s.extends]
        names = {}
        for struct in self.feature_structs:
            for member in struct.members:
                if member.type == "VkBool32":
                    names[member.name] = True
        self.feature_names = list(names)

    def _check(self):
        known = set(self.feature_names)
        for name in self.claims.features:
            if name not in known:
                print(f"note: feature {name} is claimed but not in this registry", file=sys.stderr)
        for name in self.claimed:
            depends = self.registry.extensions[name].depends
            if depends and not any(self.holds(g) for g in depends):
                fail(f"{name} is claimed, but not what it depends on")

    def enums(self):
        extensions = "".join(f"  {enumerator(n)},\n" for n in sorted(self.registry.extensions))
        features = "".join(f"  {n},\n" for n in self.feature_names)
        return f"""#pragma once

#include <cstdint>

namespace vitrine::icd {{

/// Every extension of the registry, without its VK_ prefix, sorted by name.
enum class Extension : std::uint16_t {{
{extensions}  kCount
}};

/// Every member of a feature structure. Promoted structures share the names and so the enumerators.
enum class Feature : std::uint16_t {{
{features}  kCount
}};

}}  // namespace vitrine::icd
"""

    def structure_types(self):
        lines = "".join(f"template <>\ninline constexpr VkStructureType kStructureTypeOf<{s.name}> = {s.stype};\n"
                        for s in self.registry.structs.values() if s.stype and "," not in s.stype)
        return f"""#pragma once

#include "icd/edge/vulkan_api.h"

namespace vitrine::icd {{

/// The sType of a structure.
template <class T>
inline constexpr VkStructureType kStructureTypeOf = VK_STRUCTURE_TYPE_MAX_ENUM;
{lines}
}}  // namespace vitrine::icd
"""

    def entry_points(self):
        names = sorted({c.implementation for c in self.registry.commands.values()})
        lines = "".join(f"VITRINE_ENTRY({n.removeprefix('vk')});\n" for n in names)
        return f"""#pragma once

#include <type_traits>

#include "icd/edge/vulkan_api.h"

/// Commands are ordinary functions named after the Vulkan command without "vk". They are declared weak: one that no
/// source file defines is null, and icd/registry/ reports it if its version or extension is claimed.
#define VITRINE_ENTRY(name) \\
  __attribute__((weak, visibility("hidden"))) extern std::remove_pointer_t<PFN_vk##name> name

namespace vitrine::icd::entry {{

{lines}
}}  // namespace vitrine::icd::entry

#undef VITRINE_ENTRY
"""

    def _gate_rows(self, gates):
        """The gates that can hold with our claims, as table rows. A version that holds alone makes the rest moot."""
        rows = []
        for gate in gates:
            if not self.holds(gate):
                continue
            if len(gate.extensions) > 2:
                fail(f"gate with more than two extensions: {gate}")
            extensions = [f"Extension::{enumerator(e)}" for e in gate.extensions]
            extensions += ["Extension::kCount"] * (2 - len(extensions))
            row = f"{{{gate.version}u, {{{extensions[0]}, {extensions[1]}}}}}"
            if row not in rows:
                rows.append(row)
        return rows

    def _command_tables(self):
        gates, commands = [], []
        for name in sorted(self.registry.commands):
            command = self.registry.commands[name]
            rows = self._gate_rows(command.gates)
            extension, revision = vkxml.REVISIONS.get(name, (None, 0))
            if not rows or extension in self.claimed and self.claims.extensions[extension][0] < revision:
                continue
            first = len(gates)
            gates += rows
            target = command.implementation.removeprefix("vk")
            scope = "k" + command.scope.title().replace("_", "")
            thunk = observed = f"&Edge<&entry::{target}>::call"
            # Debug labels describe the commands between them, and are none.
            if name.startswith("vkCmd") and "DebugUtilsLabel" not in name:
                observed = f'&Edge<&Marked<&entry::{target}, "{name}">::call>::call'
            functions = ", ".join(f"reinterpret_cast<VoidFunction>({f})" for f in (f"&entry::{target}", thunk, observed))
            commands.append(f'    {{"{name}", Scope::{scope}, {first}, {len(rows)}, {functions}}},\n')
        return gates, commands

    def _extension_table(self):
        lines = []
        for name in sorted(self.registry.extensions):
            extension = self.registry.extensions[name]
            version = self.claims.extensions[name][0] if name in self.claimed else 0
            lines.append(f'    {{"{name}", {min(version, extension.spec_version)}u, '
                         f'{str(extension.is_instance).lower()}, {str(name in self.claimed).lower()}, '
                         f'{extension.promoted_to}u}},\n')
        return lines

    def _feature_tables(self):
        members, structs = [], []
        for struct in self.feature_structs:
            if not self.available(struct):
                continue
            booleans = [m for m in struct.members if m.type == "VkBool32"]
            first = len(members)
            offset_type = struct.name
            members += [f"    {{Feature::{m.name}, offsetof({offset_type}, {m.name})}},\n" for m in booleans]
            if struct.stype:
                structs.append(f"    {{{struct.stype}, {first}, {len(booleans)}, sizeof({struct.name})}},\n")
            else:
                structs.insert(0, f"    {{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, {first}, {len(booleans)}, "
                                  f"sizeof({struct.name})}},\n")
        return members, structs

    def _value(self, struct, member):
        nested = self.registry.structs.get(member.type)
        limit = self.claims.limit(CORE_NAMES.get(member.name, member.name))
        if limit is None and nested and nested.name != "VkConformanceVersion":
            return "{" + self._initializer(nested) + "}"
        if limit is None:
            fail(f"{struct.name}::{member.name} has no value: add it to manifest/limits")
        return self._known_bits(limit.value)

    def _known_bits(self, value):
        """Without the bits that this registry does not know: like an extension, they wait for newer headers."""
        bits = value.split(" | ")
        known = [b for b in bits if b in self.registry.enumerators or not re.fullmatch(r"VK_\w+", b)]
        return " | ".join(known) if len(bits) > 1 else value

    def _initializer(self, struct):
        parts = []
        of_application = self._of_application(struct)
        for member in struct.members:
            if member.name in ("sType", "pNext"):
                continue
            if member.name in of_application:
                parts.append(f".{member.name} = {{}}")
                continue
            if struct.name == "VkPhysicalDeviceProperties" and member.name == "apiVersion":
                value = f"VK_MAKE_API_VERSION(0, {self.version >> 22}, {self.version >> 12 & 0x3ff}, VK_HEADER_VERSION)"
            else:
                value = self._value(struct, member)
            parts.append(f".{member.name} = {value}")
        return ", ".join(parts)

    def _property_tables(self):
        """Constants of properties.h, and rows of the table of their addresses."""
        constants, structs = [], []
        for struct in self.registry.structs.values():
            is_core = struct.name == "VkPhysicalDeviceProperties"
            if not is_core and "VkPhysicalDeviceProperties2" not in struct.extends or not self.available(struct):
                continue
            start = "" if is_core else f".sType = {struct.stype}, .pNext = nullptr, "
            name = "kClaimed" + struct.name.removeprefix("Vk")
            constants.append(f"inline constexpr {struct.name} {name} = {{{start}{self._initializer(struct)}}};\n")
            if not is_core:
                kept = self._of_application(struct)
                first, end = ((f"offsetof({struct.name}, {kept[0]})", f"offsetof({struct.name}, {kept[-1]}) + "
                               f"sizeof({struct.name}::{kept[-1]})") if kept else [f"sizeof({struct.name})"] * 2)
                structs.append(f"    {{{struct.stype}, sizeof({struct.name}), &{name}, {first}, {end}}},\n")
        return constants, structs

    @staticmethod
    def _of_application(struct):
        """The members that say where lists go and how much room there is: names, which follow each other."""
        names = [m.name for m in struct.members]
        kept = {n for m in struct.members if m.length for n in (m.name, m.length)}
        together = [n for n in names if n in kept]
        if together and names[names.index(together[0]):][:len(together)] != together:
            fail(f"{struct.name} has members between those of the application")
        return together

    def properties(self):
        return f"""#pragma once

#include "icd/edge/vulkan_api.h"
#include "icd/version.h"

namespace vitrine::icd {{

// Every structure of properties that is claimed; name, type and UUIDs are filled in by the physical device.
{"".join(self._property_tables()[0])}
}}  // namespace vitrine::icd
"""

    def limit_rules(self):
        """For the tests: one row per number of VkPhysicalDeviceLimits: value, required minimum, direction."""
        lines = []
        for member in self.registry.structs["VkPhysicalDeviceLimits"].members:
            limit = self.claims.limit(member.name)
            if limit is None or limit.minimum == "-":
                continue
            values = re.split(r",", limit.value.strip("{}"))
            minima = re.split(r",", limit.minimum.strip("{}"))
            for index, (value, minimum) in enumerate(zip(values, minima * len(values))):
                kind = member.limittype.split(",")[0] if member.limittype else "max"
                if kind == "range":
                    kind = "min" if index == 0 else "max"
                direction = {"min": "kAtMost", "bitmask": "kContains"}.get(kind, "kAtLeast")
                lines.append(f'    {{"{member.name}", static_cast<double>({value}), '
                             f'static_cast<double>({minimum}), LimitRule::{direction}}},\n')
        return f"""#pragma once

#include <cstdint>

#include "icd/edge/vulkan_api.h"

namespace vitrine::icd {{

/// A claimed number beside what the specification requires of it.
struct LimitRule {{
  enum Direction : std::uint8_t {{ kAtLeast, kAtMost, kContains }};
  const char* name;
  double value;
  double required;
  Direction direction;
}};

inline constexpr LimitRule kLimitRules[] = {{
{"".join(lines)}}};

}}  // namespace vitrine::icd
"""

    def _format_table(self):
        def bits(words):
            names = [f"VK_FORMAT_FEATURE_{w}_BIT" + ("_KHR" if w == "FRAGMENT_SHADING_RATE_ATTACHMENT" else "") for w in words]
            # Whatever is filtered linearly is so cubically, but for formats whose planes are.
            cubic = "SAMPLED_IMAGE_FILTER_LINEAR" in words and "MIDPOINT_CHROMA_SAMPLES" not in words
            if cubic and "VK_EXT_filter_cubic" in self.claimed:
                names.append("VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_CUBIC_BIT_EXT")
            return " | ".join(names) or "0"

        lines = []
        for name, (image, buffer) in self.claims.formats.items():
            if f"VK_FORMAT_{name}" not in self.registry.enumerators:
                continue  # waits for newer headers
            linear = [word for word in image if word != "DEPTH_STENCIL_ATTACHMENT"]
            lines.append(f"    {{VK_FORMAT_{name}, {{{bits(linear)}, {bits(image)}, {bits(buffer)}}}}},\n")
        return lines

    def tables(self):
        gates, commands = self._command_tables()
        feature_members, feature_structs = self._feature_tables()
        property_structs = self._property_tables()[1]
        claimed_features = ["Feature::" + n for n in self.feature_names if n in self.claims.features]
        return f"""#include <cstddef>

#include "icd/edge/edge.h"
#include "icd/entry_points.h"
#include "icd/properties.h"
#include "icd/registry/registry.h"

namespace vitrine::icd {{
namespace {{

constexpr Gate kGates[] = {{
    {(","+chr(10)+"    ").join(gates)}}};

// Addresses of functions cannot be constexpr behind a cast, but they are link-time constants: no constructor runs.
const EntryPoint kEntryPoints[] = {{
{"".join(commands)}}};

constexpr ExtensionInfo kExtensions[] = {{
{"".join(self._extension_table())}}};

constexpr Feature kClaimedFeatures[] = {{{", ".join(claimed_features)}}};

constexpr FeatureMember kFeatureMembers[] = {{
{"".join(feature_members)}}};

constexpr FeatureStruct kFeatureStructs[] = {{
{"".join(feature_structs)}}};

constexpr PropertyStruct kPropertyStructs[] = {{
{"".join(property_structs)}}};

constexpr FormatClaim kFormatClaims[] = {{
{"".join(self._format_table())}}};

}}  // namespace

std::span<const EntryPoint> entry_points() {{ return kEntryPoints; }}
std::span<const Gate> gates(const EntryPoint& entry) {{ return {{kGates + entry.first_gate, entry.gate_count}}; }}
std::span<const ExtensionInfo> extension_infos() {{ return kExtensions; }}
std::span<const Feature> claimed_features() {{ return kClaimedFeatures; }}
std::span<const FeatureStruct> feature_structs() {{ return kFeatureStructs; }}
std::span<const FeatureMember> feature_members(const FeatureStruct& structure) {{
  return {{kFeatureMembers + structure.first_member, structure.member_count}};
}}
std::span<const PropertyStruct> property_structs() {{ return kPropertyStructs; }}
std::span<const FormatClaim> format_claims() {{ return kFormatClaims; }}

}}  // namespace vitrine::icd
"""


def main():
    xml, manifest, output = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    output.mkdir(parents=True, exist_ok=True)
    generator = Generator(vkxml.Registry(xml), claims_module.Claims(manifest))
    write(output / "enums.h", generator.enums())
    write(output / "structure_types.h", generator.structure_types())
    write(output / "entry_points.h", generator.entry_points())
    write(output / "properties.h", generator.properties())
    write(output / "tables.cpp", generator.tables())
    write(output / "limit_rules.h", generator.limit_rules())


if __name__ == "__main__":
    main()
