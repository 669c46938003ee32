#!/usr/bin/env python3
"""Writes the page that says of every claimed format what it can do, what tests it and how exact it is.

usage: formats_page.py ROOT [--check]

The rows come from manifest/formats (the claims) and cts-subset/harness/format.cpp (what is compared with the
reference). --check: fails if manifest/formats.md is not what would be written.
"""
import pathlib
import re
import sys

HEAD = """# Formats

Written by `manifest/formats_page.py` from `manifest/formats`; a test keeps it current. Every format that has image features can
also be copied in both directions. *color* includes resolves; *linear* is linear filtering, and cubic filtering of
formats without chroma samples (VK_EXT_filter_cubic: `texel CubicFilter.*`, `icd CubicFilters.*`).

What tests them, besides the unit tests of `texel`:

- **reference**: `texture.format.*` of `cts-subset` compares fetches, nearest and linear samples of each with lavapipe (of
  8- and 16-bit formats every possible texel), the random cases of `texture`, `image`, `api` and `pipeline` samples, loads,
  stores, transfers and attachments; `pipeline.vertex_input` and `texture.random_texel_buffer` attributes and texel buffers.
- **vertex**: compared with lavapipe as vertex attribute and texel buffer alone, by the same cases.
- **decoder**: lavapipe lacks the format; `texel Block.*` holds digests of blocks that were compared with an independent
  decoder, and `texture.format.*` and `texture.random_lacking*` of `cts-subset` compare fetches and filters with those of
  lavapipe for an image of the decoded texels.
- **peer**: lavapipe lacks the format or the marked use of it; unit tests of `texel` compare with a format of the same values,
  and the same cases of `cts-subset` with an image of the same values in a format that lavapipe has (A8 and A1B5G5R5, which
  come with VK_KHR_maintenance5: `icd Maintenance5Draws.*` with one that this device has; R64: `image.random_wide_texels`,
  `compute.image_atomics_64.*` with two words and with a buffer, `icd WideTexels.*` with known numbers).
- **formulas**: lavapipe lacks the format; `texel Ycbcr.*` compares samples through every kind of conversion with the
  specification's formulas in double precision, `texture.ycbcr.*` of `cts-subset` the way through the API;
  `api.random_planar_copies` and `texture.random_plane_*` compare copies and views of planes with single images.

`cts-subset/compare_formats.py` finds nothing that lavapipe or SwiftShader claims of a format or image and that is missing here,
but what it lists with the reason.

What exact means:

- **same bits**: those of lavapipe 22.3.6 in every conversion.
- **reference curve**: those bits too, and so not the curve of the sRGB definition (deviations of up to one code).
- **defined**: the values that the format's specification defines.
- **but attachments**: the same bits, but colours stored in attachments are the nearest codes, as the specification demands
  (`cts-subset/deviations.md`, snorm10-attachments).

| format | image | buffer | tests | exactness |
|---|---|---|---|---|
"""


# Formats that lavapipe lacks and another has the values of, with their exactness.
PEERS = {"R4G4B4A4_UNORM_PACK16": "defined", "R8_SRGB": "reference curve", "R8G8_SRGB": "reference curve",
         "A2R10G10B10_SINT_PACK32": "defined", "A2B10G10R10_SINT_PACK32": "defined",
         "A8_UNORM": "defined", "A1B5G5R5_UNORM_PACK16": "defined", "R64_UINT": "defined", "R64_SINT": "defined"}
# Uses of other formats that lavapipe does not claim.
PEER_USES = {**dict.fromkeys(("D16_UNORM", "X8_D24_UNORM_PACK32", "D32_SFLOAT", "D24_UNORM_S8_UINT",
                              "D32_SFLOAT_S8_UINT"), "linear"),
             **dict.fromkeys(("B5G6R5_UNORM_PACK16", "A2R10G10B10_UNORM_PACK32"), "blits"),
             **dict.fromkeys(("R8G8B8A8_SRGB", "B8G8R8A8_SRGB", "A8B8G8R8_SRGB_PACK32"), "storage"),
             "B10G11R11_UFLOAT_PACK32": "blit_dst"}


def claims(root):
    for line in (root / "manifest/formats").read_text().splitlines():
        line = line.split("#")[0].strip()
        if line:
            name, image, buffer = [*(part.strip() for part in line.split(";")), ""][:3]
            yield name, image, buffer


def row(name, image, buffer, compared):
    if re.match(r"ETC2|EAC|ASTC", name):
        tests, exact = "decoder", "defined"
    elif re.search(r"PLANE|_422_|R1[02]X", name):
        tests, exact = "formulas", "defined"
    elif name in PEERS:
        tests, exact = "peer", PEERS[name]
    elif name in compared:
        tests = "reference"
        exact = "reference curve" if "SRGB" in name and "BC7" not in name else "same bits"
        if re.match(r"A2\w+_SNORM", name) and "color" in image:
            exact += ", but attachments"
        if name in PEER_USES:
            tests += f"; {PEER_USES[name]}: peer"
    elif image:
        tests, exact = "reference, by formats of the same fields", "same bits"
    else:
        # lavapipe narrows the others (cts-subset/deviations.md, wide-attributes).
        tests, exact = "vertex", "defined" if re.match(r"R64\w+_SINT|R64G64B64", name) else "same bits"
    return f"| {name} | {image} | {buffer} | {tests} | {exact} |\n"


def main(root, check=False):
    root = pathlib.Path(root)
    listed = (root / "cts-subset/harness/format.cpp").read_text()
    compared = set(re.findall(r"^\s*(?:ROW|BLOCK)\((\w+),", listed, re.M))
    text = HEAD + "".join(row(*claim, compared) for claim in claims(root))
    page = root / "manifest/formats.md"
    if check:
        if not page.exists() or page.read_text() != text:
            sys.exit("manifest/formats.md is out of date: run manifest/formats_page.py .")
        return
    page.write_text(text)


if __name__ == "__main__":
    main(sys.argv[1], "--check" in sys.argv[2:])
