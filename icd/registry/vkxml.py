"""Reads vk.xml into the few plain structures that the generator needs. Knows no claim of ours.

Handles registries older and newer than the one it was written with: `requires`/`requiresCore` as well as `depends`
expressions, `supported`/`api` attributes with several names, and the vulkanbase feature groups.
"""
import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field

# Platforms whose declarations icd/edge/vulkan_api.h can supply without the window system's own headers.
PLATFORMS = {None, "xcb", "xlib", "wayland"}
APIS = {"vulkan", "vulkanbase", "vulkancompute", "vulkangraphics"}
# The oldest registry that the driver is built with: its core version and its last extension's number. What came or became
# core later is no name for sources that are built with that one, too.
OLDEST_CORE = "1.3"
OLDEST_LAST_EXTENSION = 498


@dataclass
class Gate:
    """All of these must hold: a core version (0: none) and extensions."""
    version: int = 0
    extensions: tuple = ()

    def both(self, other):
        return Gate(max(self.version, other.version), tuple(dict.fromkeys(self.extensions + other.extensions)))


@dataclass
class Command:
    name: str
    implementation: str  # what the sources call it and all its aliases, whatever the registry (Registry._stable_names)
    scope: str
    gates: list = field(default_factory=list)


@dataclass
class Member:
    name: str
    type: str
    array: bool
    limittype: str
    length: str  # of a pointer to an array: the member that counts its elements; else empty


@dataclass
class Struct:
    name: str  # of all its aliases the one that is in every registry (Registry._stable_names)
    stype: str
    extends: tuple
    members: list
    gates: list = field(default_factory=list)


@dataclass
class Extension:
    name: str
    spec_version: int
    is_instance: bool
    depends: list  # alternatives of Gate; empty: none
    promoted_to: int  # core version, 0: not promoted to core


def version_number(text):
    major, minor = text.split(".")[:2]
    return int(major) << 22 | int(minor) << 12


def version_of_name(name):
    match = re.fullmatch(r"VK_(?:[A-Z]+_)?VERSION_(\d+)_(\d+)", name)
    return version_number(f"{match[1]}.{match[2]}") if match else None


def parse_depends(text):
    """Turns 'A+(B,C)' ('+' and, ',' or) into a list of alternative gates."""
    tokens = re.findall(r"[\w:]+|[+,()]", text)
    position = 0

    def factor():
        nonlocal position
        token = tokens[position]
        position += 1
        if token == "(":
            alternatives = expression()
            position += 1
            return alternatives
        version = version_of_name(token)
        return [Gate(version=version)] if version else [Gate(extensions=(token.split("::")[0],))]

    # The registry gives '+' and ',' equal precedence, left to right.
    def expression():
        nonlocal position
        left = factor()
        while position < len(tokens) and tokens[position] in "+,":
            operator = tokens[position]
            position += 1
            right = factor()
            left = left + right if operator == "," else [a.both(b) for a in left for b in right]
        return left

    return expression() if tokens else []


# What a later revision of an extension brought, which the registry does not tell apart.
REVISIONS = {name: ("VK_EXT_discard_rectangles", 2)
             for name in ("vkCmdSetDiscardRectangleEnableEXT", "vkCmdSetDiscardRectangleModeEXT",
                          "VK_DYNAMIC_STATE_DISCARD_RECTANGLE_ENABLE_EXT", "VK_DYNAMIC_STATE_DISCARD_RECTANGLE_MODE_EXT")}
# Extensions that have all their commands, those too which the registry ties to other extensions: the conformance suite asks
# for them (dEQP-VK.shader_object.api.get_device_proc_addr), and what is not enabled has no valid call.
WHOLE = {"VK_EXT_shader_object"}
LAST_RANK = 5


def rank_of(extension):
    """Where the names that an extension requires stand among their aliases: behind those of core, before what came later."""
    author = extension.get("name").split("_")[1]
    return LAST_RANK - 1 if int(extension.get("number")) > OLDEST_LAST_EXTENSION else {"KHR": 1, "EXT": 2}.get(author, 3)


def in_api(element, attribute="api"):
    value = element.get(attribute)
    return value is None or bool(APIS & set(value.split(",")))


class Registry:
    def __init__(self, path):
        root = ElementTree.parse(path).getroot()
        self.aliases = {}
        self.enumerators = {e.get("name") for e in root.iter("enum")}
        self.structs = self._read_structs(root)
        self.commands = self._read_commands(root)
        self.extensions = {}
        self.core_versions = []
        self.ranks = {}  # of each required name of a command or structure (rank_of)
        self._read_requirements(root)
        self.commands = {n: c for n, c in self.commands.items() if c.gates}
        self.structs = {n: s for n, s in self.structs.items() if s.gates}
        self._stable_names()

    def _read_structs(self, root):
        structs = {}
        for element in root.find("types"):
            if element.get("category") != "struct" or not in_api(element):
                continue
            name = element.get("name")
            if element.get("alias"):
                self.aliases[name] = element.get("alias")
                continue
            members = [self._member(m) for m in element.findall("member") if in_api(m)]
            stype = next((m.get("values") for m in element.findall("member") if m.find("name").text == "sType"), None)
            extends = tuple((element.get("structextends") or "").split(","))
            structs[name] = Struct(name, stype, extends, members)
        return structs

    @staticmethod
    def _member(element):
        tail = (element.find("name").tail or "")
        pointer = "*" in (element.find("type").tail or "")
        return Member(element.find("name").text, element.find("type").text, "[" in tail, element.get("limittype") or "",
                      (element.get("len") or "") if pointer else "")

    @staticmethod
    def _read_commands(root):
        commands = {}
        aliases = {}
        for element in root.iter("command"):
            if element.get("alias"):
                if in_api(element):
                    aliases[element.get("name")] = element.get("alias")
                continue
            proto = element.find("proto")
            if proto is None or not in_api(element):
                continue
            name = proto.find("name").text
            first = element.find("param/type").text
            scope = {"VkInstance": "instance", "VkPhysicalDevice": "physical_device", "VkDevice": "device",
                     "VkQueue": "device", "VkCommandBuffer": "device"}.get(first, "global")
            commands[name] = Command(name, name, scope)
        for name, target in aliases.items():
            while target in aliases:
                target = aliases[target]
            if target in commands:
                commands[name] = Command(name, target, commands[target].scope)
        return commands

    def _read_requirements(self, root):
        for feature in root.findall("feature"):
            if not in_api(feature):
                continue
            version = version_number(feature.get("number"))
            if version not in self.core_versions:
                self.core_versions.append(version)
            rank = 0 if version <= version_number(OLDEST_CORE) else LAST_RANK
            for require in feature.findall("require"):
                self._apply(require, [Gate(version=version)], rank)
        for element in root.find("extensions"):
            supported = set((element.get("supported") or "").split(","))
            if not (APIS & supported) or element.get("platform") not in PLATFORMS or element.get("provisional"):
                continue
            name = element.get("name")
            self.extensions[name] = self._extension(element, name)
            for require in element.findall("require"):
                if in_api(require):
                    gate = Gate(extensions=(name,))
                    gates = [gate] if name in WHOLE else self._require_gates(require, gate)
                    self._apply(require, gates, rank_of(element))

    @staticmethod
    def _extension(element, name):
        spec_version = next(int(e.get("value")) for e in element.iter("enum")
                            if e.get("name", "").endswith("_SPEC_VERSION") and e.get("value", "").isdigit())
        depends = parse_depends(element.get("depends") or "")
        if element.get("requires"):
            depends = [Gate(extensions=tuple(element.get("requires").split(",")))]
        if element.get("requiresCore"):
            core = Gate(version=version_number(element.get("requiresCore")))
            depends = [g.both(core) for g in depends] or [core]
        return Extension(name, spec_version, element.get("type") == "instance", depends,
                         version_of_name(element.get("promotedto") or "") or 0)

    @staticmethod
    def _require_gates(require, gate):
        gates = [gate]
        for attribute in ("feature", "extension", "depends"):
            if require.get(attribute):
                gates = [g.both(d) for g in gates for d in parse_depends(require.get(attribute))]
        return gates

    def _apply(self, require, gates, rank):
        for command in require.findall("command"):
            name = command.get("name")
            self.ranks[name] = min(rank, self.ranks.get(name, rank))
            if name in self.commands:
                self.commands[name].gates.extend(gates)
        for type_element in require.findall("type"):
            name = type_element.get("name")
            self.ranks[name] = min(rank, self.ranks.get(name, rank))
            name = self._resolve(name)
            if name in self.structs:
                self.structs[name].gates.extend(gates)

    def _resolve(self, name):
        while name in self.aliases:
            name = self.aliases[name]
        return name

    def _stable_names(self):
        """Gives each group of aliases the name that is in the oldest registry, too. Which one a registry calls the
        original is no guide: each makes the names that it had before aliases of those that became core meanwhile."""
        groups = {}
        for command in self.commands.values():
            groups.setdefault(command.implementation, []).append(command)
        for original, group in groups.items():
            name = self._stable_name(original, [c.name for c in group])
            for command in group:
                command.implementation = name
        groups = {}
        for name in self.aliases:
            groups.setdefault(self._resolve(name), []).append(name)
        for original, others in groups.items():
            if original in self.structs:
                self.structs[original].name = self._stable_name(original, [original, *others])
        self.structs = {s.name: s for s in self.structs.values()}

    def _stable_name(self, original, names):
        """Of names of the same rank the one that the registry calls the original, else the first."""
        return min((n for n in names if n in self.ranks), key=lambda n: (self.ranks[n], n != original, n))
