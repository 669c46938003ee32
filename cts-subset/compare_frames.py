#!/usr/bin/env python3
"""Runs a windowed Vulkan application on two drivers under a virtual display and compares every presented frame.

compare_frames.py --layer DIR --icd FILE --reference FILE --suite CTS_SUBSET --out DIR [--frames N] -- APP ARGS...
Exit status: 0 equal, 1 different or failed, 77 something needed is not installed: the reference in the recorded version, too.
"""
import argparse
import os
import shutil
import struct
import subprocess
import sys
import zlib


def run_app(app, icd, layer, folder, timeout):
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    env = dict(os.environ)
    for name in ("VK_ICD_FILENAMES", "WAYLAND_DISPLAY"):
        env.pop(name, None)
    env.update(VK_DRIVER_FILES=icd, VK_ADD_LAYER_PATH=layer, VK_INSTANCE_LAYERS="VK_LAYER_VITRINE_capture",
               CAPTURE_DIR=folder, LP_PERF="no_rast_linear")
    command = ["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24"] + app
    try:
        done = subprocess.run(command, env=env, timeout=timeout, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    except subprocess.TimeoutExpired:
        sys.exit(f"{' '.join(app)} on {icd} did not end within {timeout} s")
    if done.returncode:
        sys.exit(f"{' '.join(app)} on {icd} failed with {done.returncode}:\n{done.stdout.decode(errors='replace')}")
    return sorted(os.listdir(folder))


def load(path):
    with open(path, "rb") as file:
        width, height, image_format = map(int, file.readline().split())
        return width, height, image_format, file.read()


def write_png(path, width, height, bgra):
    rows = bytearray()
    for y in range(height):
        rows.append(0)
        line = bgra[y * width * 4:(y + 1) * width * 4]
        rgb = bytearray(width * 3)
        rgb[0::3], rgb[1::3], rgb[2::3] = line[2::4], line[1::4], line[0::4]
        rows += rgb

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(bytes(rows))) + chunk(b"IEND", b""))


def compare(name, device, reference, out):
    a, b = load(os.path.join(device, name)), load(os.path.join(reference, name))
    if a == b:
        return 0
    if a[:3] != b[:3]:
        print(f"{name}: {a[:3]} against {b[:3]} (width, height, format)")
        return 1
    width, height = a[0], a[1]
    different = [i for i in range(width * height) if a[3][4 * i:4 * i + 4] != b[3][4 * i:4 * i + 4]]
    first = different[0]
    print(f"{name}: {len(different)} of {width * height} pixels differ; first ({first % width}, {first // width}): "
          f"device {a[3][4 * first:4 * first + 4].hex()}, reference {b[3][4 * first:4 * first + 4].hex()}")
    stem = os.path.join(out, name[:-4])
    write_png(stem + ".device.png", width, height, a[3])
    write_png(stem + ".reference.png", width, height, b[3])
    mask = bytearray(width * height * 4)
    for i in different:
        mask[4 * i + 2] = 255
    write_png(stem + ".difference.png", width, height, bytes(mask))
    return 1


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for option in ("--layer", "--icd", "--reference", "--suite", "--out"):
        parser.add_argument(option, required=True)
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--timeout", type=int, default=300)
    parser.add_argument("app", nargs="+")
    options = parser.parse_args()
    for tool in ("xvfb-run", options.app[0]):
        if not shutil.which(tool):
            print(f"{tool} is not installed")
            sys.exit(77)
    chosen = subprocess.check_output([options.suite, "--which-reference"], text=True)
    if chosen.startswith("recorded"):
        print(f"frames are not recorded; the reference is {chosen}")
        sys.exit(77)
    device, reference = (os.path.join(options.out, side) for side in ("device", "reference"))
    expected = run_app(options.app, options.reference, options.layer, reference, options.timeout)
    found = run_app(options.app, options.icd, options.layer, device, options.timeout)
    if len(expected) < options.frames or len(set(open(os.path.join(reference, n), "rb").read() for n in expected)) < 2:
        sys.exit(f"the reference presented {len(expected)} frames, or always the same one")
    if found != expected:
        sys.exit(f"{len(found)} frames, reference {len(expected)}")
    different = sum(compare(name, device, reference, options.out) for name in expected)
    write_png(os.path.join(options.out, "last.png"), *load(os.path.join(device, expected[-1]))[:2],
              load(os.path.join(device, expected[-1]))[3])
    print(f"{' '.join(options.app)}: {len(expected)} frames, {different} different")
    sys.exit(1 if different else 0)


main()
