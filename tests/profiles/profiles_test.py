#!/usr/bin/env python3
"""The profile checker on a made-up device: what is lacking is found, what is there is not. And what it asks the loader for,
on the driver that VK_DRIVER_FILES names, if it names one.

usage: profiles_test.py
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import loader
import profiles

CHECKER = pathlib.Path(__file__).with_name("profiles.py")

DEVICE = {"capabilities": {"device": {
    "extensions": {"VK_EXT_robustness2": 1},
    "features": {"VkPhysicalDeviceVulkan12Features": {"descriptorIndexing": True, "samplerMirrorClampToEdge": False}},
    "properties": {
        "VkPhysicalDeviceProperties": {"apiVersion": 1 << 22 | 3 << 12 | 239, "limits": {
            "maxImageDimension2D": 8192, "minUniformBufferOffsetAlignment": 64, "minMemoryMapAlignment": 4096,
            "pointSizeRange": [1.0, 64.0], "framebufferColorSampleCounts": ["VK_SAMPLE_COUNT_1_BIT"],
            "maxComputeWorkGroupCount": [100, 100, 50]}},
        "VkPhysicalDeviceVulkan11Properties": {"subgroupSupportedStages": [
            "VK_SHADER_STAGE_VERTEX_BIT", "VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT",
            "VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT", "VK_SHADER_STAGE_GEOMETRY_BIT",
            "VK_SHADER_STAGE_FRAGMENT_BIT"]}},
    "formats": {"VK_FORMAT_A4R4G4B4_UNORM_PACK16": {
        "VkFormatProperties": {"optimalTilingFeatures": ["VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT"]}}},
    "queueFamiliesProperties": [{"VkQueueFamilyProperties": {
        "queueFlags": ["VK_QUEUE_GRAPHICS_BIT"], "queueCount": 1, "timestampValidBits": 64}}]}}}


def limits(**wanted):
    return {"properties": {"VkPhysicalDeviceProperties": {"limits": wanted}}}


class Profiles(unittest.TestCase):
    def check(self, *blocks, version="1.3.200", others=None, arguments=()):
        """Runs the checker on one profile of these blocks; (items, exit code)."""
        names = []
        capabilities = {}
        for index, block in enumerate(blocks):
            choices = block if isinstance(block, list) else [block]
            own = [f"block{index}_{choice}" for choice in range(len(choices))]
            capabilities.update(zip(own, choices))
            names.append(own if isinstance(block, list) else own[0])
        profile = {"version": 1, "api-version": version, "capabilities": names}
        document = {"capabilities": capabilities, "profiles": {"VP_test": profile}}
        if others:
            document["profiles"]["VP_other"] = {"version": 1, "api-version": version, "capabilities": ["other"]}
            document["capabilities"]["other"] = others
            profile["profiles"] = ["VP_other"]
        with tempfile.TemporaryDirectory() as folder:
            device, profiles = pathlib.Path(folder, "device.json"), pathlib.Path(folder, "profiles.json")
            device.write_text(json.dumps(DEVICE))
            profiles.write_text(json.dumps(document))
            run = subprocess.run([sys.executable, "-B", CHECKER, "--device", device, "--only", "VP_test", *arguments,
                                  profiles], stdout=subprocess.PIPE, text=True, check=False)
        lines = run.stdout.splitlines()
        self.assertEqual(lines[-1], f"VP_test: {len(lines) - 1} lacking")
        return [line.split(": ", 1)[1] for line in lines[:-1]], run.returncode

    def test_versions(self):
        self.assertEqual(self.check(version="1.3.239")[0], [])
        self.assertEqual(self.check(version="1.4.300")[0], ["version 1.4.300 (is 1.3.239)"])

    def test_extensions_of_devices_and_instances(self):
        lacking = self.check({"extensions": {"VK_EXT_robustness2": 1, "VK_KHR_surface": 1, "VK_KHR_swapchain": 1}})[0]
        self.assertEqual(lacking, ["VK_KHR_swapchain"], "of instances the file says nothing")

    def test_features_count_in_any_structure(self):
        names = {"descriptorIndexing": True, "samplerMirrorClampToEdge": True, "imagelessFramebuffer": False}
        self.assertEqual(self.check({"features": {"VkPhysicalDeviceImagelessFramebufferFeatures": names}})[0],
                         ["feature samplerMirrorClampToEdge"])

    def test_limits_by_their_kind(self):
        good = limits(maxImageDimension2D=8192, minUniformBufferOffsetAlignment=256, minMemoryMapAlignment=64,
                      pointSizeRange=[1.0, 32.0], framebufferColorSampleCounts=["VK_SAMPLE_COUNT_1_BIT"],
                      maxComputeWorkGroupCount=[100, 1, 50])
        self.assertEqual(self.check(good)[0], [])
        for name, wanted in (("maxImageDimension2D", 16384), ("minUniformBufferOffsetAlignment", 16),
                             ("pointSizeRange", [0.5, 32.0]), ("pointSizeRange", [1.0, 65.0]),
                             ("framebufferColorSampleCounts", ["VK_SAMPLE_COUNT_4_BIT"]),
                             ("maxComputeWorkGroupCount", [100, 1, 51])):
            lacking = self.check(limits(**{name: wanted}))[0]
            self.assertEqual(len(lacking), 1, name)
            self.assertIn(f"limits.{name}", lacking[0])

    def test_bits_that_stand_for_several(self):
        stages = {"VkPhysicalDeviceVulkan11Properties": {"subgroupSupportedStages": ["VK_SHADER_STAGE_ALL_GRAPHICS"]}}
        self.assertEqual(self.check({"properties": stages})[0], [])

    def test_formats_by_any_name(self):
        bits = {"VkFormatProperties": {"optimalTilingFeatures": ["VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT",
                                                                 "VK_FORMAT_FEATURE_BLIT_DST_BIT"]}}
        name = "VK_FORMAT_A4R4G4B4_UNORM_PACK16_EXT"
        self.assertEqual(self.check({"formats": {name: bits}})[0],
                         [f"{name} optimalTilingFeatures VK_FORMAT_FEATURE_BLIT_DST_BIT"])

    def test_alternatives_and_other_profiles(self):
        lacks, has = {"extensions": {"VK_KHR_swapchain": 1}}, {"extensions": {"VK_EXT_robustness2": 1}}
        self.assertEqual(self.check([lacks, has])[0], [])
        self.assertEqual(self.check(has, others=lacks)[0], ["VK_KHR_swapchain"])

    def test_expected_counts_decide(self):
        lacks = {"extensions": {"VK_KHR_swapchain": 1}}
        self.assertEqual(self.check(lacks, arguments=["--expect", "VP_test=1"])[1], 0)
        self.assertEqual(self.check(lacks, arguments=["--expect", "VP_test=0"])[1], 1)


@unittest.skipUnless(os.environ.get("VK_DRIVER_FILES"), "VK_DRIVER_FILES names no driver")
class Loader(unittest.TestCase):
    def test_the_device_is_asked_for_what_the_registry_knows(self):
        asked = loader.Asked(profiles.REGISTRY)
        self.assertLessEqual({"multiview", "dynamicRendering", "timelineSemaphore", "descriptorIndexing"}, asked.features)
        self.assertNotIn("meshShader", asked.features)
        self.assertEqual(asked.numbers["VkPhysicalDeviceMultiviewProperties"]["maxMultiviewViewCount"], 6)
        self.assertLessEqual({"VK_SUBGROUP_FEATURE_BASIC_BIT", "VK_SUBGROUP_FEATURE_QUAD_BIT"}, asked.operations)
        if asked.version >= 1 << 22 | 4 << 12:
            self.assertLessEqual({"pushDescriptor", "shaderFloatControls2", "dynamicRenderingLocalRead"}, asked.features)
            self.assertIn("VK_SUBGROUP_FEATURE_ROTATE_CLUSTERED_BIT", asked.operations)


if __name__ == "__main__":
    unittest.main()
