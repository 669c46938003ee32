// The two devices of the suite, in one instance of the real loader.
#pragma once

#include <vulkan/vulkan.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace vitrine::cts {

/// A Vulkan call returned an error: the case fails on this device.
struct VulkanError : std::runtime_error {
  VulkanError(VkResult code, const char* call);
  VkResult code;
};
/// The device does not claim what the case needs: counted as unsupported, not as a failure.
struct Unsupported : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws VulkanError for negative results.
void check(VkResult result, const char* call);
#define CTS_VK(call) ::vitrine::cts::check((call), #call)

/// Feature structures of extensions that cases use: member, structure, its sType, the extension that brings it. A
/// device gets every feature that it offers, of every extension here that it offers.
#define CTS_EXTENSION_FEATURES(X)                                                                                      \
  X(storage_8bit, VkPhysicalDevice8BitStorageFeatures, 8BIT_STORAGE_FEATURES, "VK_KHR_8bit_storage")                   \
  X(storage_16bit, VkPhysicalDevice16BitStorageFeatures, 16BIT_STORAGE_FEATURES, "VK_KHR_16bit_storage")               \
  X(float16_int8, VkPhysicalDeviceShaderFloat16Int8Features, SHADER_FLOAT16_INT8_FEATURES,                             \
    "VK_KHR_shader_float16_int8")                                                                                      \
  X(atomic_int64, VkPhysicalDeviceShaderAtomicInt64Features, SHADER_ATOMIC_INT64_FEATURES,                             \
    "VK_KHR_shader_atomic_int64")                                                                                      \
  X(integer_dot_product, VkPhysicalDeviceShaderIntegerDotProductFeatures, SHADER_INTEGER_DOT_PRODUCT_FEATURES,         \
    "VK_KHR_shader_integer_dot_product")                                                                               \
  X(transform_feedback, VkPhysicalDeviceTransformFeedbackFeaturesEXT, TRANSFORM_FEEDBACK_FEATURES_EXT,                 \
    "VK_EXT_transform_feedback")                                                                                       \
  X(primitives_generated_query, VkPhysicalDevicePrimitivesGeneratedQueryFeaturesEXT,                                   \
    PRIMITIVES_GENERATED_QUERY_FEATURES_EXT, "VK_EXT_primitives_generated_query")                                      \
  X(atomic_float, VkPhysicalDeviceShaderAtomicFloatFeaturesEXT, SHADER_ATOMIC_FLOAT_FEATURES_EXT,                      \
    "VK_EXT_shader_atomic_float")                                                                                      \
  X(atomic_float2, VkPhysicalDeviceShaderAtomicFloat2FeaturesEXT, SHADER_ATOMIC_FLOAT_2_FEATURES_EXT,                  \
    "VK_EXT_shader_atomic_float2")                                                                                     \
  X(buffer_address, VkPhysicalDeviceBufferDeviceAddressFeatures, BUFFER_DEVICE_ADDRESS_FEATURES,                       \
    "VK_KHR_buffer_device_address")                                                                                    \
  X(color_write_enable, VkPhysicalDeviceColorWriteEnableFeaturesEXT, COLOR_WRITE_ENABLE_FEATURES_EXT,                  \
    "VK_EXT_color_write_enable")                                                                                       \
  X(conditional_rendering, VkPhysicalDeviceConditionalRenderingFeaturesEXT, CONDITIONAL_RENDERING_FEATURES_EXT,        \
    "VK_EXT_conditional_rendering")                                                                                    \
  X(demote, VkPhysicalDeviceShaderDemoteToHelperInvocationFeatures, SHADER_DEMOTE_TO_HELPER_INVOCATION_FEATURES,       \
    "VK_EXT_shader_demote_to_helper_invocation")                                                                       \
  X(depth_clip_control, VkPhysicalDeviceDepthClipControlFeaturesEXT, DEPTH_CLIP_CONTROL_FEATURES_EXT,                  \
    "VK_EXT_depth_clip_control")                                                                                       \
  X(depth_clip_enable, VkPhysicalDeviceDepthClipEnableFeaturesEXT, DEPTH_CLIP_ENABLE_FEATURES_EXT,                     \
    "VK_EXT_depth_clip_enable")                                                                                        \
  X(descriptor_indexing, VkPhysicalDeviceDescriptorIndexingFeatures, DESCRIPTOR_INDEXING_FEATURES,                     \
    "VK_EXT_descriptor_indexing")                                                                                      \
  X(attachment_feedback_loop, VkPhysicalDeviceAttachmentFeedbackLoopLayoutFeaturesEXT,                                 \
    ATTACHMENT_FEEDBACK_LOOP_LAYOUT_FEATURES_EXT, "VK_EXT_attachment_feedback_loop_layout")                            \
  X(rasterization_order, VkPhysicalDeviceRasterizationOrderAttachmentAccessFeaturesEXT,                                \
    RASTERIZATION_ORDER_ATTACHMENT_ACCESS_FEATURES_EXT, "VK_EXT_rasterization_order_attachment_access")                \
  X(draw_parameters, VkPhysicalDeviceShaderDrawParametersFeatures, SHADER_DRAW_PARAMETERS_FEATURES,                    \
    "VK_KHR_shader_draw_parameters")                                                                                   \
  X(dynamic_rendering, VkPhysicalDeviceDynamicRenderingFeatures, DYNAMIC_RENDERING_FEATURES,                           \
    "VK_KHR_dynamic_rendering")                                                                                        \
  X(extended_dynamic_state, VkPhysicalDeviceExtendedDynamicStateFeaturesEXT, EXTENDED_DYNAMIC_STATE_FEATURES_EXT,      \
    "VK_EXT_extended_dynamic_state")                                                                                   \
  X(extended_dynamic_state2, VkPhysicalDeviceExtendedDynamicState2FeaturesEXT, EXTENDED_DYNAMIC_STATE_2_FEATURES_EXT,  \
    "VK_EXT_extended_dynamic_state2")                                                                                  \
  X(extended_dynamic_state3, VkPhysicalDeviceExtendedDynamicState3FeaturesEXT, EXTENDED_DYNAMIC_STATE_3_FEATURES_EXT,  \
    "VK_EXT_extended_dynamic_state3")                                                                                  \
  X(graphics_pipeline_library, VkPhysicalDeviceGraphicsPipelineLibraryFeaturesEXT,                                     \
    GRAPHICS_PIPELINE_LIBRARY_FEATURES_EXT, "VK_EXT_graphics_pipeline_library")                                        \
  X(host_query_reset, VkPhysicalDeviceHostQueryResetFeatures, HOST_QUERY_RESET_FEATURES, "VK_EXT_host_query_reset")    \
  X(image_robustness, VkPhysicalDeviceImageRobustnessFeatures, IMAGE_ROBUSTNESS_FEATURES, "VK_EXT_image_robustness")   \
  X(imageless_framebuffer, VkPhysicalDeviceImagelessFramebufferFeatures, IMAGELESS_FRAMEBUFFER_FEATURES,               \
    "VK_KHR_imageless_framebuffer")                                                                                    \
  X(index_type_uint8, VkPhysicalDeviceIndexTypeUint8FeaturesEXT, INDEX_TYPE_UINT8_FEATURES_EXT,                        \
    "VK_EXT_index_type_uint8")                                                                                         \
  X(inline_uniform_block, VkPhysicalDeviceInlineUniformBlockFeatures, INLINE_UNIFORM_BLOCK_FEATURES,                   \
    "VK_EXT_inline_uniform_block")                                                                                     \
  X(line_rasterization, VkPhysicalDeviceLineRasterizationFeaturesEXT, LINE_RASTERIZATION_FEATURES_EXT,                 \
    "VK_EXT_line_rasterization")                                                                                       \
  X(formats_4444, VkPhysicalDevice4444FormatsFeaturesEXT, 4444_FORMATS_FEATURES_EXT, "VK_EXT_4444_formats")            \
  X(custom_border, VkPhysicalDeviceCustomBorderColorFeaturesEXT, CUSTOM_BORDER_COLOR_FEATURES_EXT,                     \
    "VK_EXT_custom_border_color")                                                                                      \
  X(border_swizzle, VkPhysicalDeviceBorderColorSwizzleFeaturesEXT, BORDER_COLOR_SWIZZLE_FEATURES_EXT,                  \
    "VK_EXT_border_color_swizzle")                                                                                     \
  X(view_of_3d, VkPhysicalDeviceImage2DViewOf3DFeaturesEXT, IMAGE_2D_VIEW_OF_3D_FEATURES_EXT,                          \
    "VK_EXT_image_2d_view_of_3d")                                                                                      \
  X(non_seamless_cube, VkPhysicalDeviceNonSeamlessCubeMapFeaturesEXT, NON_SEAMLESS_CUBE_MAP_FEATURES_EXT,              \
    "VK_EXT_non_seamless_cube_map")                                                                                    \
  X(list_restart, VkPhysicalDevicePrimitiveTopologyListRestartFeaturesEXT,                                             \
    PRIMITIVE_TOPOLOGY_LIST_RESTART_FEATURES_EXT, "VK_EXT_primitive_topology_list_restart")                            \
  X(maintenance4, VkPhysicalDeviceMaintenance4Features, MAINTENANCE_4_FEATURES, "VK_KHR_maintenance4")                 \
  X(memory_model, VkPhysicalDeviceVulkanMemoryModelFeatures, VULKAN_MEMORY_MODEL_FEATURES,                             \
    "VK_KHR_vulkan_memory_model")                                                                                      \
  X(single_sampled, VkPhysicalDeviceMultisampledRenderToSingleSampledFeaturesEXT,                                      \
    MULTISAMPLED_RENDER_TO_SINGLE_SAMPLED_FEATURES_EXT, "VK_EXT_multisampled_render_to_single_sampled")                \
  X(advanced_blend, VkPhysicalDeviceBlendOperationAdvancedFeaturesEXT, BLEND_OPERATION_ADVANCED_FEATURES_EXT,          \
    "VK_EXT_blend_operation_advanced")                                                                                 \
  X(multi_draw, VkPhysicalDeviceMultiDrawFeaturesEXT, MULTI_DRAW_FEATURES_EXT, "VK_EXT_multi_draw")                    \
  X(multiview, VkPhysicalDeviceMultiviewFeatures, MULTIVIEW_FEATURES, "VK_KHR_multiview")                              \
  X(provoking_vertex, VkPhysicalDeviceProvokingVertexFeaturesEXT, PROVOKING_VERTEX_FEATURES_EXT,                       \
    "VK_EXT_provoking_vertex")                                                                                         \
  X(robustness2, VkPhysicalDeviceRobustness2FeaturesEXT, ROBUSTNESS_2_FEATURES_EXT, "VK_EXT_robustness2")              \
  X(workgroup_layout, VkPhysicalDeviceWorkgroupMemoryExplicitLayoutFeaturesKHR,                                        \
    WORKGROUP_MEMORY_EXPLICIT_LAYOUT_FEATURES_KHR, "VK_KHR_workgroup_memory_explicit_layout")                          \
  X(zero_workgroup, VkPhysicalDeviceZeroInitializeWorkgroupMemoryFeatures, ZERO_INITIALIZE_WORKGROUP_MEMORY_FEATURES,  \
    "VK_KHR_zero_initialize_workgroup_memory")                                                                         \
  X(scalar_block_layout, VkPhysicalDeviceScalarBlockLayoutFeatures, SCALAR_BLOCK_LAYOUT_FEATURES,                      \
    "VK_EXT_scalar_block_layout")                                                                                      \
  X(separate_depth_stencil_layouts, VkPhysicalDeviceSeparateDepthStencilLayoutsFeatures,                               \
    SEPARATE_DEPTH_STENCIL_LAYOUTS_FEATURES, "VK_KHR_separate_depth_stencil_layouts")                                  \
  X(shader_clock, VkPhysicalDeviceShaderClockFeaturesKHR, SHADER_CLOCK_FEATURES_KHR, "VK_KHR_shader_clock")            \
  X(subgroup_extended_types, VkPhysicalDeviceShaderSubgroupExtendedTypesFeatures,                                      \
    SHADER_SUBGROUP_EXTENDED_TYPES_FEATURES, "VK_KHR_shader_subgroup_extended_types")                                  \
  X(subgroup_size, VkPhysicalDeviceSubgroupSizeControlFeatures, SUBGROUP_SIZE_CONTROL_FEATURES,                        \
    "VK_EXT_subgroup_size_control")                                                                                    \
  X(synchronization2, VkPhysicalDeviceSynchronization2Features, SYNCHRONIZATION_2_FEATURES, "VK_KHR_synchronization2") \
  X(terminate, VkPhysicalDeviceShaderTerminateInvocationFeatures, SHADER_TERMINATE_INVOCATION_FEATURES,                \
    "VK_KHR_shader_terminate_invocation")                                                                              \
  X(texel_buffer_alignment, VkPhysicalDeviceTexelBufferAlignmentFeaturesEXT, TEXEL_BUFFER_ALIGNMENT_FEATURES_EXT,      \
    "VK_EXT_texel_buffer_alignment")                                                                                   \
  X(timeline_semaphore, VkPhysicalDeviceTimelineSemaphoreFeatures, TIMELINE_SEMAPHORE_FEATURES,                        \
    "VK_KHR_timeline_semaphore")                                                                                       \
  X(uniform_buffer_standard_layout, VkPhysicalDeviceUniformBufferStandardLayoutFeatures,                               \
    UNIFORM_BUFFER_STANDARD_LAYOUT_FEATURES, "VK_KHR_uniform_buffer_standard_layout")                                  \
  X(variable_pointers, VkPhysicalDeviceVariablePointersFeatures, VARIABLE_POINTERS_FEATURES,                           \
    "VK_KHR_variable_pointers")                                                                                        \
  X(vertex_attribute_divisor, VkPhysicalDeviceVertexAttributeDivisorFeaturesEXT,                                       \
    VERTEX_ATTRIBUTE_DIVISOR_FEATURES_EXT, "VK_EXT_vertex_attribute_divisor")                                          \
  X(vertex_input_dynamic_state, VkPhysicalDeviceVertexInputDynamicStateFeaturesEXT,                                    \
    VERTEX_INPUT_DYNAMIC_STATE_FEATURES_EXT, "VK_EXT_vertex_input_dynamic_state")                                      \
  X(ycbcr, VkPhysicalDeviceSamplerYcbcrConversionFeatures, SAMPLER_YCBCR_CONVERSION_FEATURES,                          \
    "VK_KHR_sampler_ycbcr_conversion")

/// Extensions without features that cases use: enabled where offered.
#define CTS_EXTENSIONS(X)                 \
  X("VK_EXT_load_store_op_none")          \
  X("VK_EXT_post_depth_coverage")         \
  X("VK_EXT_sample_locations")            \
  X("VK_EXT_sampler_filter_minmax")       \
  X("VK_EXT_separate_stencil_usage")      \
  X("VK_EXT_shader_stencil_export")       \
  X("VK_EXT_shader_subgroup_ballot")      \
  X("VK_EXT_shader_subgroup_vote")        \
  X("VK_EXT_shader_viewport_index_layer") \
  X("VK_GOOGLE_decorate_string")          \
  X("VK_GOOGLE_hlsl_functionality1")      \
  X("VK_KHR_copy_commands2")              \
  X("VK_KHR_create_renderpass2")          \
  X("VK_KHR_depth_stencil_resolve")       \
  X("VK_KHR_draw_indirect_count")         \
  X("VK_KHR_image_format_list")           \
  X("VK_KHR_pipeline_library")            \
  X("VK_KHR_push_descriptor")             \
  X("VK_KHR_shader_float_controls")       \
  X("VK_KHR_shader_non_semantic_info")    \
  X("VK_KHR_spirv_1_4")

struct ExtensionFeatures {
#define CTS_MEMBER(member, type, stype, extension) type member{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_##stype};
  CTS_EXTENSION_FEATURES(CTS_MEMBER)
#undef CTS_MEMBER
};

struct Gpu {
  std::string name;
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  uint32_t family = 0;
  VkPhysicalDeviceProperties properties{};
  VkPhysicalDeviceFeatures features{};   ///< all that the device offers; all are enabled
  ExtensionFeatures extension_features;  ///< offered and enabled; all false where the extension is missing
  std::vector<std::string> extensions;   ///< of CTS_EXTENSIONS and CTS_EXTENSION_FEATURES: offered and enabled
  VkPhysicalDeviceMemoryProperties memory{};

  VkFormatFeatureFlags features_of(VkFormat format, VkImageTiling tiling = VK_IMAGE_TILING_OPTIMAL) const;
  /// Index of a memory type out of `allowed` with all of `wanted`.
  uint32_t memory_type(uint32_t allowed, VkMemoryPropertyFlags wanted) const;
  bool has(const char* extension) const;
  PFN_vkVoidFunction command(const char* name) const;
};

/// A command of an extension: CTS_COMMAND(run.gpu, CmdCopyBuffer2KHR)(cmd, &info). Null if the device does not have it.
#define CTS_COMMAND(gpu, name) (reinterpret_cast<PFN_vk##name>((gpu).command("vk" #name)))

struct Gpus {
  VkInstance instance = VK_NULL_HANDLE;
  uint32_t api_version = VK_API_VERSION_1_0;  ///< what both devices support, at most 1.1
  Gpu device, reference;
  bool same_driver = false;  ///< the reference stands on both sides: the suite tests itself
};

/// Creates both devices at the first call. Throws if a driver cannot be found.
Gpus& gpus();
/// Destroys and creates a device again, after it was lost.
void recreate(Gpu& gpu);
void destroy_gpus();

/// Validation errors since the last call, each once.
std::vector<std::string> take_validation_errors();
/// Whether the validation layer is there and on.
bool validation_is_on();

}  // namespace vitrine::cts
