#!/usr/bin/env python3
"""Generates the table of format descriptions from the <formats> of the Vulkan registry.

usage: generate.py VK_XML OUTPUT_HEADER

Output: rows of texel::FormatDesc, sorted by the enum's value at compile time by the includer. Channel positions and
numeric formats come from the format's name (`A2R10G10B10_UNORM_PACK32`): the registry's components are wrong for a few
formats (B5G5R5A1_UNORM, B10G11R11_UFLOAT, BC4_SNORM in 1.3.239).
"""
import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree

COMPRESSION = {None: "kNone", "BC": "kBc", "ETC2": "kEtc2", "EAC": "kEac", "ASTC LDR": "kAstcLdr",
               "ASTC HDR": "kAstcHdr", "PVRTC": "kPvrtc"}
CHANNELS = "RGBADS"
NUMERIC = {"UNORM", "SNORM", "USCALED", "SSCALED", "UINT", "SINT", "UFLOAT", "SFLOAT", "SRGB"}


def numeric(text):
    return "Numeric::k" + text.capitalize()


class Format:
    def __init__(self, element):
        self.name = element.get("name")
        self.block_bytes = int(element.get("blockSize"))
        self.block = [int(v) for v in element.get("blockExtent", "1,1,1").split(",")]
        self.packed = int(element.get("packed", "0"))
        self.compression = COMPRESSION.get(element.get("compressed"), "kNone")
        self.components = element.findall("component")
        self.planes = max(1, len(element.findall("plane")))
        named = [p for p in self.name.split("_") if p in NUMERIC]
        self.numeric_of = {c.get("name"): c.get("numericFormat") for c in self.components}
        if len(named) == 1:
            self.numeric_of = dict.fromkeys(CHANNELS, named[0])
        self.channels = []  # fixed-point, planar and chroma-subsampled formats have none: they are not plain
        self.chroma = element.get("chroma")
        self.plane_elements = element.findall("plane")
        if named and not self.plane_elements and self.chroma in (None, "444"):
            self.channels = self._compressed() if element.get("compressed") else self._plain()

    def _compressed(self):
        return [(c.get("name"), self.numeric_of[c.get("name")], 0, 0) for c in self.components]

    def _plain(self):
        """(name, numeric format, bits, bit offset) in memory order, least significant first."""
        tokens = []
        for part in self.name.removeprefix("VK_FORMAT_").split("_"):
            if re.fullmatch(r"([A-Z]\d+)+", part):
                tokens += [(m[1], int(m[2])) for m in re.finditer(r"([A-Z])(\d+)", part)]
        words = []  # each: tokens from the least significant bit on
        if self.packed:
            word, filled = [], 0
            for token in tokens:
                word.insert(0, token)
                filled += token[1]
                if filled == self.packed:
                    words.append(word)
                    word, filled = [], 0
        else:
            words = [[t] for t in tokens]
        result, offset = [], 0
        for word in words:
            for name, bits in word:
                if name in CHANNELS:
                    result.append((name, self.numeric_of[name], bits, offset))
                offset += bits
        return result

    def kind(self):
        first = self.components[0].get("numericFormat")
        return {"UINT": "kUint", "SINT": "kSint"}.get(first, "kFloat")

    def aspects(self):
        names = {c.get("name") for c in self.components}
        if names <= {"D", "S"}:
            return " | ".join(f"VK_IMAGE_ASPECT_{'DEPTH' if n == 'D' else 'STENCIL'}_BIT" for n in sorted(names))
        if self.planes > 1:
            return " | ".join(f"VK_IMAGE_ASPECT_PLANE_{i}_BIT" for i in range(self.planes))
        return "VK_IMAGE_ASPECT_COLOR_BIT"

    def rgba(self):
        """Depth and stencil are read as red."""
        names = [c[0] for c in self.channels]
        index = [names.index(n) if n in names else -1 for n in "RGBA"]
        if names and names[0] in "DS":
            index[0] = 0
        return index

    def sampled_planes(self):
        """(format, width divisor, height divisor) of each single-plane view that a conversion samples."""
        if self.plane_elements:
            return [(p.get("compatible"), p.get("widthDivisor"), p.get("heightDivisor")) for p in self.plane_elements]
        if self.chroma == "444":
            return [(self.name, 1, 1)]
        if self.chroma is None:
            return []
        # Packed 4:2:2: pairs of luma and chroma, or four elements for two texels.
        bits = re.match(r"VK_FORMAT_[GB](\d+(X\d+)?)", self.name)[1]
        suffix = ("_2PACK16", "_4PACK16") if "X" in bits else ("", "")
        formats = ["".join(c + bits for c in names) + "_UNORM" for names in ("RG", "RGBA")]
        return [(f"VK_FORMAT_{f}{s}", d, 1) for f, s, d in zip(formats, suffix, (1, 2))]

    def plane_components(self):
        """(plane, channel of its format) of R, G, B and A; plane -1: the format lacks the component."""
        names = [c.get("name") for c in self.components]
        found = {}
        if self.plane_elements:
            planes = [int(c.get("planeIndex")) for c in self.components]
            found = {n: (p, planes[:i].count(p)) for i, (n, p) in enumerate(zip(names, planes))}
        elif self.chroma == "422":
            found = {n: (0, i % 2) if n == "G" else (1, i) for i, n in enumerate(names)}
        elif self.chroma:
            found = {n: (0, i) for i, n in enumerate("RGBA")}
        return [found.get(n, (-1, 0)) for n in "RGBA"]

    def row(self):
        channels = ", ".join(f"Channel{{'{n}', {numeric(f)}, {b}, {o}}}" for n, f, b, o in self.channels)
        array = f"{{{{{channels}}}}}" if channels else "{}"
        return (f"    {{{self.name}, \"{self.name.removeprefix('VK_FORMAT_')}\", {self.block_bytes}, "
                f"{self.block[0]}, {self.block[1]}, {self.block[2]}, Compression::{self.compression}, {self.packed}, "
                f"{len(self.channels)}, {array}, {{{{{', '.join(map(str, self.rgba()))}}}}}, Kind::{self.kind()}, "
                f"{self.aspects()}, {self.planes}, {self.planar()}, false, {{}}}},\n")

    def planar(self):
        planes = ", ".join(f"Plane{{{f}, {w}, {h}}}" for f, w, h in self.sampled_planes())
        components = ", ".join(f"PlaneComponent{{{p}, {c}}}" for p, c in self.plane_components())
        return f"{len(self.sampled_planes())}, {{{{{planes}}}}}, {{{{{components}}}}}" if planes else "0, {}, {}"


def main(vk_xml, output):
    formats = [Format(e) for e in ElementTree.parse(vk_xml).getroot().find("formats")]
    text = "// Generated from vk.xml by texel/format/generate.py.\n"
    text += "inline constexpr FormatDesc kFormatRows[] = {\n" + "".join(f.row() for f in formats) + "};\n"
    path = pathlib.Path(output)
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


if __name__ == "__main__":
    main(*sys.argv[1:])
