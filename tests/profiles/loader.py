"""Asks the loader's first device what an older vulkaninfo does not know to ask for: the features of every structure that
the registry has, properties that are plain numbers, and all operations of subgroups. Nothing but the registry says what
there is."""
import ctypes
import xml.etree.ElementTree as ElementTree

VK_SUCCESS = 0
APPLICATION_INFO, INSTANCE_CREATE_INFO = 0, 1
FEATURES_2, PROPERTIES_2, SUBGROUP_PROPERTIES = 1000059000, 1000059001, 1000094000
HEADER = 16  # bytes of sType and pNext
PROPERTIES_BYTES = 4096  # more than VkPhysicalDeviceProperties2 has


class ApplicationInfo(ctypes.Structure):
    _fields_ = [("type", ctypes.c_uint32), ("next", ctypes.c_void_p), ("name", ctypes.c_char_p), ("version", ctypes.c_uint32),
                ("engine", ctypes.c_char_p), ("engine_version", ctypes.c_uint32), ("api", ctypes.c_uint32)]


class InstanceCreateInfo(ctypes.Structure):
    _fields_ = [("type", ctypes.c_uint32), ("next", ctypes.c_void_p), ("flags", ctypes.c_uint32),
                ("application", ctypes.POINTER(ApplicationInfo)), ("layer_count", ctypes.c_uint32), ("layers", ctypes.c_void_p),
                ("extension_count", ctypes.c_uint32), ("extensions", ctypes.c_void_p)]


def enumerators(root):
    """{name: number} of those that extend other enumerations (Vulkan 1.4.309, Style Guide: Enumerant Values)."""
    out = {}
    for owner in [*root.iter("feature"), *root.iter("extension")]:
        for value in owner.iter("enum"):
            number = value.get("extnumber", owner.get("number"))
            if value.get("offset") and number.isdigit():
                out[value.get("name")] = 1000000000 + (int(number) - 1) * 1000 + int(value.get("offset"))
            elif value.get("value", "").isdigit():
                out[value.get("name")] = int(value.get("value"))
    return out


def plain_structs(root, extended, kinds):
    """{structure: (name of its sType, [(type, member)])} of those that extend a structure and have single members of
    these types alone."""
    out = {}
    for struct in root.iter("type"):
        if extended not in (struct.get("structextends") or "").split(","):
            continue
        members = [(m.find("type").text, m.find("name").text + (m.find("name").tail or ""), m.get("values"))
                   for m in struct.findall("member")]
        if members and all(kind in kinds and name.isalnum() for kind, name, _ in members[2:]):
            out[struct.get("name")] = (members[0][2], [(kind, name) for kind, name, _ in members[2:]])
    return out


class Asked:
    """`version`: of the device, packed; `features`: names of those that are supported; `numbers`: {structure: {member: number
    or boolean}} of properties; `operations`: names of the bits of subgroups' operations."""

    def __init__(self, registry):
        root = ElementTree.parse(registry).getroot()
        self.vulkan = ctypes.CDLL("libvulkan.so.1")
        application = ApplicationInfo(APPLICATION_INFO, None, None, 0, None, 0, 1 << 22 | 4 << 12)
        info = InstanceCreateInfo(INSTANCE_CREATE_INFO, None, 0, ctypes.pointer(application), 0, None, 0, None)
        instance = ctypes.c_void_p()
        if self.vulkan.vkCreateInstance(ctypes.byref(info), None, ctypes.byref(instance)) != VK_SUCCESS:
            raise OSError("no instance")
        try:
            self.device = ctypes.c_void_p()
            count = ctypes.c_uint32(1)
            self.vulkan.vkEnumeratePhysicalDevices(instance, ctypes.byref(count), ctypes.byref(self.device))
            if not count.value:
                raise OSError("no device")
            supported = self.ask(root, FEATURES_2, "VkPhysicalDeviceFeatures2", {"VkBool32"})
            self.features = {member for struct in supported.values() for member, value in struct.items() if value}
            self.numbers = self.ask(root, PROPERTIES_2, "VkPhysicalDeviceProperties2", {"VkBool32", "uint32_t"})
            self.operations = self.ask_operations(root)
        finally:
            self.vulkan.vkDestroyInstance(instance, None)

    @staticmethod
    def structure(number, words, behind=None):
        """Of `words` 32-bit members, which are zero."""
        out = (ctypes.c_uint32 * (HEADER // 4 + words))()
        out[0] = number
        if behind is not None:
            ctypes.c_void_p.from_buffer(out, 8).value = ctypes.addressof(behind)
        return out

    def ask(self, root, number, extended, kinds):
        ask = {FEATURES_2: self.vulkan.vkGetPhysicalDeviceFeatures2, PROPERTIES_2: self.vulkan.vkGetPhysicalDeviceProperties2}
        numbers = enumerators(root)
        out = {}
        for name, (kind, members) in plain_structs(root, extended, kinds).items():
            if kind in numbers:
                asked = self.structure(numbers[kind], len(members))
                whole = self.structure(number, PROPERTIES_BYTES // 4, asked)
                ask[number](self.device, whole)
                out[name] = {member: bool(asked[HEADER // 4 + i]) if of == "VkBool32" else asked[HEADER // 4 + i]
                             for i, (of, member) in enumerate(members)}
        return out

    def ask_operations(self, root):
        asked = self.structure(SUBGROUP_PROPERTIES, 4)
        whole = self.structure(PROPERTIES_2, PROPERTIES_BYTES // 4, asked)
        self.vulkan.vkGetPhysicalDeviceProperties2(self.device, whole)
        self.version = whole[HEADER // 4]
        return {value.get("name") for value in root.iter("enum")
                if value.get("bitpos") and value.get("name").startswith("VK_SUBGROUP_FEATURE_")
                and asked[HEADER // 4 + 2] >> int(value.get("bitpos")) & 1}
