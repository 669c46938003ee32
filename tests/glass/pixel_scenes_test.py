#!/usr/bin/env python3
"""Tests the tool `pixel` wholesale: scenes of cts-subset, every texel of every image of which is watched, as far as images
reach. Between two events of a texel nothing may have changed it, and what the last one left is what it holds: the tool
itself looks at the memory before and after every submission, and calls what it cannot explain "unknown".

usage: pixel_scenes_test.py CTS_SUBSET MANIFEST [SCENE...]
"""
import collections
import json
import os
import pathlib
import subprocess
import sys
import tempfile

SIDE = 32  # texels of an image that are watched, to the right and down
SCENES = ["draw.random_scene/*", "draw.random/*", "draw.triangle_*", "clipping.random_triangles/*",
          "clipping.random_unrestricted_depth/*", "rasterization.random_triangles_multisample/*",
          "rasterization.random_line_modes.samples_4/*", "rasterization.random_polygon_mode/*",
          "renderpass.random/*", "renderpass.random_multiview/*", "renderpass.random_render_area/*",
          "renderpass.*input*", "dynamic_rendering.random/*", "multisample.random_depth_resolve/*",
          "multisample.random_single_sampled_spelled_out/*", "pipeline.random_state/*", "pipeline.random_blend/*",
          "pipeline.random_multisample/*", "pipeline.random_depth_bounds/*", "pipeline.random_dynamic_state/*",
          "geometry.random/*", "tessellation.random/*", "image.random_load_store/*", "image.random_volume_attachment/*",
          "api.random_blit_scaled/*", "api.random_copy_image/*", "api.random_clear_attachments/*", "texture.*mip*"]
MOST_CASES = 2  # of a scene: the tool writes down a lot


def cases_of(suite, scene):
    listed = subprocess.run([suite, "--gtest_list_tests", f"--gtest_filter={scene}"], capture_output=True, text=True,
                            check=True).stdout
    names, group = [], ""
    for line in listed.splitlines():
        if line.startswith("  "):
            names.append(group + line.split()[0])
        elif line.endswith("."):
            group = line
    step = max(1, len(names) // MOST_CASES)
    return names[::step][:MOST_CASES]


def faults_of(texel, kinds):
    last = None
    for event in texel["events"]:
        kinds[event["kind"], event.get("fate", "")] += 1
        if event["kind"] == "unknown" and "between submissions" not in event["text"]:
            yield f"{texel['texel']}: {event}"
        if last is not None and event.get("before", last) != last:
            yield f"{texel['texel']}: {last} before {event}"
        last = event.get("after", last)
    if last is not None and last != texel["value"]:
        yield f"{texel['texel']}: holds {texel['value']} after {last}"


def main(suite, manifest, *scenes):
    kinds, faults, texels = collections.Counter(), [], 0
    for scene in scenes or SCENES:
        cases = cases_of(suite, scene)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "history.json"
            result = subprocess.run([suite, f"--icd={manifest}", "--validation=0", "--gtest_brief=1",
                                     f"--gtest_filter={':'.join(cases)}"], capture_output=True, text=True, check=False,
                                    cwd=folder, env={**os.environ, "VITRINE_TOOLS": "pixel",
                                                     "VITRINE_PIXEL": f"0,0-{SIDE - 1},{SIDE - 1}:image=*",
                                                     "VITRINE_PIXEL_HISTORY": str(file)})
            if not cases or result.returncode != 0 or not file.exists():
                faults.append(f"{scene}: {len(cases)} cases, exit code {result.returncode}: {result.stdout[-500:]}")
                continue
            history = json.loads(file.read_text())
        texels += len(history["texels"])
        for texel in history["texels"]:
            faults += [f"{scene}: {fault}" for fault in faults_of(texel, kinds)]
    print(f"{texels} texels;", ", ".join(f"{count} {' '.join(kind).strip()}" for kind, count in sorted(kinds.items())))
    for fault in faults[:10]:
        print("FAULT", fault)
    return 1 if faults or texels == 0 else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
