#!/usr/bin/env python3
"""The tables of icd/registry/generate.py from registries of different age: the same claims, under the same names.

usage: generate_test.py MANIFEST_FOLDER VK_XML...
"""
import pathlib
import re
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "icd" / "registry"))
import claims as claims_module
import generate
import vkxml

MANIFEST = REGISTRIES = None

# Dynamic states of these extensions, whose commands a registry up to 1.3.2xx gives to VK_EXT_extended_dynamic_state3 alone.
OF_NV_EXTENSIONS = {"vkCmdSet" + name + "NV" for name in (
    "CoverageModulationMode", "CoverageModulationTable", "CoverageModulationTableEnable", "CoverageReductionMode",
    "CoverageToColorEnable", "CoverageToColorLocation", "RepresentativeFragmentTestEnable", "ShadingRateImageEnable",
    "ViewportSwizzle", "ViewportWScalingEnable")}

PARAMETERS = "<proto><type>void</type> <name>%s</name></proto><param><type>VkDevice</type> <name>device</name></param>"
MEMBERS = """<member values="VK_STRUCTURE_TYPE_%s"><type>VkStructureType</type> <name>sType</name></member>
<member><type>VkBool32</type> <name>%s</name></member>"""


def command(name, alias=None):
    return f'<command name="{name}" alias="{alias}"/>' if alias else f"<command>{PARAMETERS % name}</command>"


def struct(name, alias=None):
    head = f'<type category="struct" name="{name}"'
    return f'{head} alias="{alias}"/>' if alias else f"{head}>{MEMBERS % (name, 'flag')}</type>"


def feature(version, *names):
    return f'<feature api="vulkan" name="VK_VERSION_{version[0]}_{version[2]}" number="{version}">{require(names)}</feature>'


def extension(name, number, *names):
    enum = f'<enum value="1" name="{name}_SPEC_VERSION"/>'
    return f'<extension name="{name}" number="{number}" supported="vulkan">{require(names, enum)}</extension>'


def require(names, more=""):
    kinds = "".join(f'<{"command" if n.startswith("vk") else "type"} name="{n}"/>' for n in names)
    return f"<require>{more}{kinds}</require>"


def registry(types, commands, features, extensions):
    text = (f"<registry><types>{''.join(types)}</types><commands>{''.join(commands)}</commands>{''.join(features)}"
            f"<extensions>{''.join(extensions)}</extensions></registry>")
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "vk.xml")
        path.write_text(text)
        return vkxml.Registry(path)


def names_of(known):
    return {name: known.commands[name].implementation for name in known.commands}, set(known.structs)


class Names(unittest.TestCase):
    """What a command or structure and its aliases are called in the sources."""

    def test_what_the_oldest_core_has_is_called_as_there(self):
        known = registry([], [command("vkTrim"), command("vkTrimKHR", "vkTrim")], [feature("1.1", "vkTrim")],
                         [extension("VK_KHR_trim", 50, "vkTrimKHR")])
        self.assertEqual(names_of(known)[0], {"vkTrim": "vkTrim", "vkTrimKHR": "vkTrim"})

    def test_what_becomes_core_later_keeps_the_name_of_its_extension(self):
        old = registry([struct("VkPushKHR")], [command("vkPushKHR")], [], [extension("VK_KHR_push", 81, "vkPushKHR", "VkPushKHR")])
        new = registry([struct("VkPush"), struct("VkPushKHR", "VkPush")], [command("vkPush"), command("vkPushKHR", "vkPush")],
                       [feature("1.4", "vkPush", "VkPush")], [extension("VK_KHR_push", 81, "vkPushKHR", "VkPushKHR")])
        self.assertEqual(names_of(old), ({"vkPushKHR": "vkPushKHR"}, {"VkPushKHR"}))
        self.assertEqual(names_of(new), ({"vkPush": "vkPushKHR", "vkPushKHR": "vkPushKHR"}, {"VkPushKHR"}))
        self.assertEqual([g.version for g in new.commands["vkPush"].gates], [vkxml.version_number("1.4")])

    def test_a_later_twin_does_not_rename(self):
        known = registry([struct("VkLineKHR"), struct("VkLineEXT", "VkLineKHR")],
                         [command("vkLineKHR"), command("vkLineEXT", "vkLineKHR")], [],
                         [extension("VK_KHR_line", 535, "vkLineKHR", "VkLineKHR"), extension("VK_EXT_line", 260, "vkLineEXT", "VkLineEXT")])
        self.assertEqual(names_of(known), ({"vkLineKHR": "vkLineEXT", "vkLineEXT": "vkLineEXT"}, {"VkLineEXT"}))
        self.assertEqual(len(known.structs["VkLineEXT"].gates), 2)

    def test_a_vendors_name_gives_way(self):
        known = registry([], [command("vkRayKHR"), command("vkRayNV", "vkRayKHR")], [],
                         [extension("VK_NV_ray", 166, "vkRayNV"), extension("VK_KHR_ray", 348, "vkRayKHR")])
        self.assertEqual(set(names_of(known)[0].values()), {"vkRayKHR"})

    def test_what_is_younger_has_its_own_names(self):
        known = registry([], [command("vkMap"), command("vkMapKHR", "vkMap")], [feature("1.4", "vkMap")],
                         [extension("VK_KHR_map", 600, "vkMapKHR")])
        self.assertEqual(set(names_of(known)[0].values()), {"vkMapKHR"})


class Values(unittest.TestCase):
    def test_bits_that_the_registry_does_not_know_are_left_out(self):
        generator = generate.Generator.__new__(generate.Generator)
        generator.registry = registry([], [], [], [extension("VK_KHR_trim", 50)])
        generator.registry.enumerators = {"VK_A_BIT"}
        for value, left in (("VK_A_BIT | VK_B_BIT_KHR", "VK_A_BIT"), ("VK_A_BIT | 3", "VK_A_BIT | 3"), ("VK_C", "VK_C")):
            self.assertEqual(generator._known_bits(value), left)


class Tables(unittest.TestCase):
    """What the registries at hand make of the claims."""

    @classmethod
    def setUpClass(cls):
        cls.known = [generate.Generator(vkxml.Registry(path), claims_module.Claims(MANIFEST)) for path in REGISTRIES]

    def commands(self, generator):
        return dict(re.findall(r'\{"(vk\w+)".*?&entry::(\w+)\)', "".join(generator._command_tables()[1])))

    def test_claimed_extensions_and_features_of_the_oldest_are_in_all(self):
        first = self.known[0]
        for other in self.known[1:]:
            self.assertLessEqual(first.claimed, other.claimed)
            self.assertLessEqual(set(first.feature_names) & set(first.claims.features), set(other.feature_names))

    def test_commands_of_the_oldest_are_in_all_under_their_names(self):
        first = self.commands(self.known[0])
        self.assertGreater(len(first), 300)
        for other in self.known[1:]:
            rows = self.commands(other)
            self.assertLessEqual(set(first) - set(rows), OF_NV_EXTENSIONS)
            self.assertEqual({n: rows[n] for n in first if n in rows}, {n: t for n, t in first.items() if n in rows})

    def test_a_registry_claims_no_version_that_it_does_not_know(self):
        for generator in self.known:
            self.assertIn(generator.version, generator.registry.core_versions)
            self.assertLessEqual(generator.version, vkxml.version_number(generator.claims.api_version))

    def test_commands_that_only_others_have_come_with_extensions_or_versions_that_only_they_have(self):
        """Or with later revisions of extensions."""
        first = self.known[0]
        for other in self.known[1:]:
            same = {e for e in first.claimed
                    if first.registry.extensions[e].spec_version == other.registry.extensions[e].spec_version}
            for name in set(self.commands(other)) - set(self.commands(first)):
                gates = [g for g in other.registry.commands[name].gates if other.holds(g)]
                self.assertFalse([g for g in gates if g.version <= first.version and set(g.extensions) <= same], name)

    def test_structures_have_the_same_names(self):
        def names(generator):
            return {s.name for s in generator.registry.structs.values() if generator.available(s)}
        for other in self.known[1:]:
            self.assertEqual(names(self.known[0]) - names(other), set())

    def test_values_are_the_same(self):
        def constants(generator):
            return dict(re.findall(r"(kClaimed\w+) = (.*);", generator.properties()))
        first = constants(self.known[0])
        enumerators = self.known[0].registry.enumerators

        def older_bits(value):
            return re.sub(r" \| (VK_\w+)", lambda match: match[0] if match[1] in enumerators else "", value)
        for other in self.known[1:]:
            rows = constants(other)
            for name, value in first.items():
                # The name of the type may be another alias: its members count.
                self.assertEqual(value.partition("pNext")[2], older_bits(rows[name].partition("pNext")[2]), name)


if __name__ == "__main__":
    MANIFEST = pathlib.Path(sys.argv[1])
    # The oldest first.
    REGISTRIES = sorted(sys.argv[2:], key=lambda path: len(vkxml.Registry(path).extensions))
    unittest.main(argv=sys.argv[:1])
