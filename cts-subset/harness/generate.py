#!/usr/bin/env python3
"""Generates what the suite enables on its devices: every extension that manifest/ claims, with all of its features.

usage: generate.py VK_XML MANIFEST_FOLDER OUTPUT_FILE
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "icd" / "registry"))
import claims as claims_module
import vkxml

API = vkxml.version_number("1.1")  # of the suite's instance (harness/gpu.cpp)
# Claimed, but not enabled.
LEFT_OUT = {
    "VK_EXT_depth_range_unrestricted": "changes what every draw does; its cases have a device of their own",
    "VK_KHR_swapchain": "needs an instance extension for surfaces, and so do those below",
    "VK_KHR_swapchain_mutable_format": "VK_KHR_swapchain",
    "VK_KHR_incremental_present": "VK_KHR_swapchain",
    "VK_KHR_present_id": "VK_KHR_swapchain",
    "VK_KHR_present_wait": "VK_KHR_swapchain",
    "VK_EXT_swapchain_maintenance1": "VK_KHR_swapchain",
    "VK_EXT_hdr_metadata": "VK_KHR_swapchain",
    **dict.fromkeys(("VK_EXT_attachment_feedback_loop_dynamic_state", "VK_EXT_depth_bias_control",
                     "VK_EXT_dynamic_rendering_unused_attachments", "VK_EXT_host_image_copy",
                     "VK_EXT_image_sliced_view_of_3d", "VK_EXT_legacy_vertex_attributes",
                     "VK_EXT_nested_command_buffer", "VK_EXT_shader_object",
                     "VK_EXT_shader_replicated_composites",
                     "VK_KHR_calibrated_timestamps", "VK_KHR_compute_shader_derivatives",
                     "VK_KHR_depth_clamp_zero_one", "VK_KHR_dynamic_rendering_local_read", "VK_KHR_index_type_uint8",
                     "VK_KHR_line_rasterization", "VK_KHR_load_store_op_none", "VK_KHR_maintenance5",
                     "VK_KHR_maintenance6", "VK_KHR_maintenance7", "VK_KHR_maintenance8",
                     "VK_KHR_map_memory2", "VK_KHR_pipeline_binary", "VK_KHR_shader_expect_assume", "VK_KHR_shader_float_controls2",
                     "VK_KHR_shader_maximal_reconvergence", "VK_KHR_shader_quad_control",
                     "VK_KHR_shader_relaxed_extended_instruction", "VK_KHR_shader_subgroup_rotate",
                     "VK_KHR_vertex_attribute_divisor"),
                    "came after Vulkan 1.3.239: Debian 12's validation layer takes its structures for mistakes"),
}


def main():
    registry = vkxml.Registry(sys.argv[1])
    claimed = claims_module.Claims(pathlib.Path(sys.argv[2])).extensions
    names = sorted(n for n, e in registry.extensions.items() if n in claimed and not e.is_instance and n not in LEFT_OUT)
    bases, links = [], []
    for struct in registry.structs.values():
        if "VkPhysicalDeviceFeatures2" not in struct.extends:
            continue
        core = any(not g.extensions and g.version <= API for g in struct.gates)
        brought_by = sorted({e for g in struct.gates for e in g.extensions if e in names})
        if core or brought_by:
            bases.append(struct.name)
            terms = ["true"] if core else [f'has("{e}")' for e in brought_by]
            links.append(f"  link(static_cast<{struct.name}&>(all), {struct.stype}, {' || '.join(terms)});\n")
    separator = ",\n                           "
    pathlib.Path(sys.argv[3]).write_text(f"""// Generated from vk.xml and manifest/ by cts-subset/harness/generate.py.
#pragma once

#include <vulkan/vulkan.h>

namespace vitrine::cts {{

/// What cases may use of a device: enabled where it is offered.
inline constexpr const char* kWantedExtensions[] = {{
{"".join(f'    "{n}",{chr(10)}' for n in names)}}};

/// The feature structures that they bring, or core versions up to 1.1: features are members of this one.
struct ExtensionFeatures : {separator.join(bases)} {{}};

/// Calls link(structure, its type, whether it is there) for each.
template <class Has, class Link>
void for_each_structure(ExtensionFeatures& all, Has has, Link link) {{
{"".join(links)}}}

}}  // namespace vitrine::cts
""")


if __name__ == "__main__":
    main()
