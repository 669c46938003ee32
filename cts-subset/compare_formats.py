#!/usr/bin/env python3
"""Asks this driver and its peers what every format can do: nothing that a peer claims may be missing here.

compare_formats.py --icd MANIFEST --peers MANIFEST... --registry VK_XML --suite CTS_SUBSET
Compared are the feature bits of every format of the registry, and for every image type, tiling and single usage the
largest extent, levels, layers and sample counts. Peers whose manifest does not exist are left out,
and so is lavapipe in another version than the recorded one.
Exit status: 0 nothing is missing, 1 something is, 77 no peer is installed.
"""
import argparse
import ctypes
import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

SRC_BLIT, DST_BLIT, UNIFORM_TEXEL = 1 << 10, 1 << 11, 1 << 3
HOST_IMAGE_TRANSFER, DEPTH_COMPARISON = 1 << 46, 1 << 33

# What is left out on purpose: (formats, feature bits, reason).
OMITTED = [
    (lambda name: name.startswith("R64") or "SCALED" in name, SRC_BLIT | DST_BLIT,
     "no image can be made of them for a blit: they have no other feature, not even transfers"),
    (lambda name: name.startswith("R64"), UNIFORM_TEXEL,
     "read by shaders with Int64ImageEXT alone, whose image formats have one component"),
    (lambda name: name == "S8_UINT", DEPTH_COMPARISON, "there is no depth in it to compare with"),
    (lambda name: True, HOST_IMAGE_TRANSFER, "VK_EXT_host_image_copy is younger than the registry"),
]
# Also left out: cubes of formats that are sampled through conversions, which have flat views alone.
IMAGE_TYPES = {"1D": 0, "2D": 1, "3D": 2}
TILINGS = {"optimal": 0, "linear": 1}
USAGES = {"transfer source": 1, "transfer destination": 2, "sampled": 4, "storage": 8, "colour attachment": 16,
          "depth or stencil attachment": 32, "input attachment": 128}
CUBE_COMPATIBLE = 0x10


class Properties3(ctypes.Structure):
    _fields_ = [("type", ctypes.c_uint), ("next", ctypes.c_void_p), ("linear", ctypes.c_uint64),
                ("optimal", ctypes.c_uint64), ("buffer", ctypes.c_uint64)]


class Properties2(ctypes.Structure):
    _fields_ = [("type", ctypes.c_uint), ("next", ctypes.c_void_p), ("narrow", ctypes.c_uint * 3)]


class ImageProperties(ctypes.Structure):
    _fields_ = [("extent", ctypes.c_uint * 3), ("levels", ctypes.c_uint), ("layers", ctypes.c_uint),
                ("samples", ctypes.c_uint), ("size", ctypes.c_uint64)]


class ApplicationInfo(ctypes.Structure):
    _fields_ = [("type", ctypes.c_uint), ("next", ctypes.c_void_p), ("name", ctypes.c_char_p),
                ("version", ctypes.c_uint), ("engine", ctypes.c_char_p), ("engine_version", ctypes.c_uint),
                ("api", ctypes.c_uint)]


class InstanceInfo(ctypes.Structure):
    _fields_ = [("type", ctypes.c_uint), ("next", ctypes.c_void_p), ("flags", ctypes.c_uint),
                ("application", ctypes.POINTER(ApplicationInfo)), ("layer_count", ctypes.c_uint),
                ("layers", ctypes.c_void_p), ("extension_count", ctypes.c_uint), ("extensions", ctypes.c_void_p)]


def devices(vulkan, manifests):
    """{name: handle} of the physical devices of some drivers."""
    os.environ["VK_DRIVER_FILES"] = os.environ["VK_ICD_FILENAMES"] = ":".join(manifests)
    application = ApplicationInfo(0, None, b"compare_formats", 0, b"", 0, 1 << 22 | 3 << 12)
    info = InstanceInfo(1, None, 0, ctypes.pointer(application), 0, None, 0, None)
    instance = ctypes.c_void_p()
    if vulkan.vkCreateInstance(ctypes.byref(info), None, ctypes.byref(instance)):
        sys.exit("vkCreateInstance failed")
    count, handles = ctypes.c_uint(16), (ctypes.c_void_p * 16)()
    vulkan.vkEnumeratePhysicalDevices(instance, ctypes.byref(count), handles)
    found = {}
    for handle in handles[:count.value]:
        properties = ctypes.create_string_buffer(4096)  # more than VkPhysicalDeviceProperties; the name is at byte 20
        vulkan.vkGetPhysicalDeviceProperties(ctypes.c_void_p(handle), properties)
        found[properties.raw[20:276].split(b"\0")[0].decode()] = ctypes.c_void_p(handle)
    return found


def features(vulkan, device, number):
    """Feature bits by where they hold."""
    wide = Properties3(1000360000, None, 0, 0, 0)
    narrow = Properties2(1000059002, ctypes.cast(ctypes.pointer(wide), ctypes.c_void_p))
    vulkan.vkGetPhysicalDeviceFormatProperties2(device, number, ctypes.byref(narrow))
    words = narrow.narrow  # also says what drivers without the wide structure know
    return {"linear": wide.linear | words[0], "optimal": wide.optimal | words[1], "buffer": wide.buffer | words[2]}


def image(vulkan, device, number, image_type, tiling, usage, flags):
    """Properties of images, or None where the driver has none."""
    properties = ImageProperties()
    result = vulkan.vkGetPhysicalDeviceImageFormatProperties(device, number, image_type, tiling, usage, flags,
                                                             ctypes.byref(properties))
    return None if result else properties


def missing_features(vulkan, device, peer, name, number):
    omitted = 0
    for names, bits, _ in OMITTED:
        omitted |= bits if names(name) else 0
    ours = features(vulkan, device, number)
    for where, bits in features(vulkan, peer, number).items():
        missing = bits & ~ours[where] & ~omitted
        if missing:
            yield f"{name}: {where} features {missing:#x}"


def missing_images(vulkan, device, peer, name, number):
    for type_name, image_type in IMAGE_TYPES.items():
        for tiling_name, tiling in TILINGS.items():
            for usage_name, usage in USAGES.items():
                for flags in (0, CUBE_COMPATIBLE):
                    if flags and (type_name != "2D" or "PLANE_" in name or "_422_" in name):
                        continue
                    theirs = image(vulkan, peer, number, image_type, tiling, usage, flags)
                    if theirs is None:
                        continue
                    what = f"{name}: {type_name} {tiling_name} {usage_name}{' cubes' if flags else ''}"
                    ours = image(vulkan, device, number, image_type, tiling, usage, flags)
                    if ours is None:
                        yield f"{what}: none"
                        continue
                    if any(a < b for a, b in zip(ours.extent, theirs.extent)):
                        yield f"{what}: extent {list(ours.extent)} against {list(theirs.extent)}"
                    if ours.levels < theirs.levels:
                        yield f"{what}: {ours.levels} levels against {theirs.levels}"
                    if ours.layers < theirs.layers:
                        yield f"{what}: {ours.layers} layers against {theirs.layers}"
                    if theirs.samples & ~ours.samples:
                        yield f"{what}: samples {ours.samples:#x} against {theirs.samples:#x}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--icd", required=True)
    parser.add_argument("--peers", nargs="+", required=True)
    parser.add_argument("--registry", required=True)
    parser.add_argument("--suite", required=True)
    arguments = parser.parse_args()
    recorded = subprocess.check_output([arguments.suite, "--which-reference"], text=True).startswith("recorded")
    peers = [path for path in arguments.peers if os.path.exists(path) and not (recorded and "lvp_icd" in path)]
    if not peers:
        sys.exit(77)
    vulkan = ctypes.CDLL("libvulkan.so.1")
    found = devices(vulkan, [arguments.icd, *peers])
    device = next((handle for name, handle in found.items() if name.startswith("Vitrine")), None)
    if device is None or len(found) != 1 + len(peers):
        sys.exit(f"found {', '.join(found)}")
    formats = numbers(ElementTree.parse(arguments.registry).getroot())
    faults = 0
    for peer_name, peer in found.items():
        if peer is device:
            continue
        for name, number in formats.items():
            for compared in (missing_features, missing_images):
                for fault in compared(vulkan, device, peer, name, number):
                    print(f"{peer_name} has, this driver lacks {fault}")
                    faults += 1
    print(f"{len(formats)} formats compared with {len(found) - 1} drivers, {faults} things missing")
    sys.exit(1 if faults else 0)


def numbers(registry):
    """{name without VK_FORMAT_: number} of every format of the registry."""
    result = {}
    for block in registry.iter("enums"):
        if block.get("name") == "VkFormat":
            result.update({e.get("name"): int(e.get("value")) for e in block.iter("enum") if e.get("value")})
    for extension in [*registry.iter("extension"), *registry.iter("feature")]:
        for e in extension.iter("enum"):
            if e.get("extends") == "VkFormat" and e.get("offset"):
                block = int(e.get("extnumber") or extension.get("number"))
                result[e.get("name")] = 1000000000 + (block - 1) * 1000 + int(e.get("offset"))
    return {name.removeprefix("VK_FORMAT_"): number for name, number in result.items() if number}


main()
