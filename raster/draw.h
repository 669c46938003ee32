// One draw, as a value: everything the fixed-function pipeline needs, resolved from pipeline, dynamic state, vertex
// buffers and descriptors. No handles, no pNext; pointers stay valid until the Pass that took the draw is flushed.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "raster/fragment_rate.h"
#include "raster/sample_locations.h"
#include "spirv/shader.h"
#include "texel/view.h"

namespace vitrine::raster {

inline constexpr std::uint32_t kMaxColorAttachments = 8;
inline constexpr std::uint32_t kMaxViewports = 16;
inline constexpr std::uint32_t kMaxVertexBindings = 32;
inline constexpr std::uint32_t kMaxVertexAttributes = 32;
inline constexpr std::uint32_t kMaxPatchVertices = 32;
inline constexpr std::uint32_t kMaxDiscardRectangles = 8;

struct VertexBinding {
  const std::byte* data = nullptr;  ///< null: reads as out of bounds
  std::uint64_t size = 0;           ///< bytes readable from `data`
  std::uint32_t stride = 0;         ///< bytes
  bool per_instance = false;
  std::uint32_t divisor = 1;  ///< per_instance: instances per element; 0: always the first
};

struct VertexAttribute {
  std::uint32_t location = 0;
  std::uint32_t binding = 0;
  VkFormat format = VK_FORMAT_UNDEFINED;
  std::uint32_t offset = 0;  ///< bytes
};

struct StencilFace {
  VkStencilOp fail = VK_STENCIL_OP_KEEP, pass = VK_STENCIL_OP_KEEP, depth_fail = VK_STENCIL_OP_KEEP;
  VkCompareOp compare = VK_COMPARE_OP_ALWAYS;
  std::uint8_t compare_mask = 0xff, write_mask = 0xff, reference = 0;
};

struct BlendAttachment {
  bool enable = false;
  VkBlendFactor src_color = VK_BLEND_FACTOR_ONE, dst_color = VK_BLEND_FACTOR_ZERO;
  VkBlendFactor src_alpha = VK_BLEND_FACTOR_ONE, dst_alpha = VK_BLEND_FACTOR_ZERO;
  VkBlendOp color_op = VK_BLEND_OP_ADD, alpha_op = VK_BLEND_OP_ADD;
  VkColorComponentFlags write_mask = 0xf;
  // of advanced operations (VK_EXT_blend_operation_advanced)
  bool src_premultiplied = true, dst_premultiplied = true;
  bool clamped = false;  ///< dynamic state alone
  VkBlendOverlapEXT overlap = VK_BLEND_OVERLAP_UNCORRELATED_EXT;
  bool advances() const { return color_op >= VK_BLEND_OP_ZERO_EXT && color_op <= VK_BLEND_OP_BLUE_EXT; }
};

/// What a depth bias's constant counts (Vulkan 1.4.309, Depth Bias Computation): units of the attachment's format,
/// those of a fixed-point format also where it is one of floats, or depth itself. Exactly means that a unit of n bits
/// is 2^-n and not what the reference takes.
enum class DepthBiasUnit : std::uint8_t { kFormat, kExactFormat, kUnorm, kExactUnorm, kOne };

/// Fixed-function state, named after the Vulkan structures it comes from. Plain values.
struct State {
  // input assembly
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  bool primitive_restart = false;
  bool provoking_vertex_last = false;
  // tessellation
  std::uint32_t patch_control_points = 0;
  bool domain_origin_lower_left = false;
  // vertex input
  std::uint32_t attribute_count = 0;
  std::array<VertexAttribute, kMaxVertexAttributes> attribute{};
  // viewport
  std::uint32_t viewport_count = 1;
  std::array<VkViewport, kMaxViewports> viewport{};
  std::array<VkRect2D, kMaxViewports> scissor{};
  bool negative_one_to_one = false;
  std::uint32_t discard_count = 0;  ///< rectangles below that count
  bool discard_inside = false;      ///< whether what they contain is discarded, or what they do not
  std::array<VkRect2D, kMaxDiscardRectangles> discard{};
  // rasterization
  std::uint32_t rasterized_stream = 0;  ///< of a geometry shader's vertex streams
  bool rasterizer_discard = false;
  bool depth_clamp = false;
  bool depth_clip = true;
  bool unrestricted_depth = false;  ///< VK_EXT_depth_range_unrestricted: depth of floats may lie outside [0, 1]
  VkPolygonMode polygon_mode = VK_POLYGON_MODE_FILL;
  VkCullModeFlags cull_mode = VK_CULL_MODE_NONE;
  VkFrontFace front_face = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  bool depth_bias = false;
  float depth_bias_constant = 0, depth_bias_clamp = 0, depth_bias_slope = 0;
  DepthBiasUnit depth_bias_unit = DepthBiasUnit::kFormat;  ///< of the constant
  bool overestimates = false;                              ///< conservative rasterization: whatever a triangle touches
  float line_width = 1;
  VkLineRasterizationModeEXT line_mode = VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT;
  bool line_stipple = false;
  std::uint32_t line_stipple_factor = 1;
  std::uint16_t line_stipple_pattern = 0xffff;
  // multisample
  std::uint32_t samples = 1;
  bool sample_shading = false;
  float min_sample_shading = 0;
  std::uint32_t sample_mask = ~0u;
  bool alpha_to_coverage = false, alpha_to_one = false;
  bool custom_locations = false;
  SampleLocations
      locations{};  ///< counts where custom_locations is set and its sample count is that of the attachments
  // fragment shading rate
  VkExtent2D fragment_size{1, 1};                                      ///< pixels
  std::array<VkFragmentShadingRateCombinerOpKHR, 2> rate_combiners{};  ///< with the primitive's, with the attachment's
  /// Fragments see in input attachments what earlier primitives of the draw wrote.
  bool ordered_attachment_access = false;
  // depth and stencil
  bool depth_test = false, depth_write = false, depth_bounds_test = false, stencil_test = false;
  VkCompareOp depth_compare = VK_COMPARE_OP_ALWAYS;
  float min_depth_bounds = 0, max_depth_bounds = 1;
  StencilFace front, back;
  // color blend
  bool logic_op_enable = false;
  VkLogicOp logic_op = VK_LOGIC_OP_COPY;
  std::array<float, 4> blend_constants{};
  std::array<BlendAttachment, kMaxColorAttachments> blend{};
};

inline constexpr std::uint32_t kMaxStreams = 4;

/// A buffer bound for transform feedback.
struct XfbBuffer {
  std::byte* data = nullptr;  ///< null: takes nothing
  std::uint64_t size = 0;     ///< bytes
  std::uint64_t offset = 0;   ///< bytes: where the next vertex goes
};

/// Transform feedback while it is active. Draws move the offsets on, in order, until Pass::flush() is done.
struct TransformFeedback {
  std::array<XfbBuffer, spirv::kMaxXfbBuffers> buffer{};
};

/// Counters of a pipeline statistics query, in the order of VkQueryPipelineStatisticFlagBits.
enum class Statistic : std::uint8_t {
  kInputAssemblyVertices,
  kInputAssemblyPrimitives,
  kVertexInvocations,
  kGeometryInvocations,
  kGeometryPrimitives,
  kClippingInvocations,
  kClippingPrimitives,
  kFragmentInvocations,
  kTessellationControlPatches,
  kTessellationEvaluationInvocations,
  kComputeInvocations,
};

/// Counters of active queries; null members do not count. Fixed function adds to them while it works; they are final
/// after Pass::flush().
struct QueryCounters {
  std::atomic<std::uint64_t>* occlusion = nullptr;  ///< samples that passed all tests
  /// One counter for each Statistic; null: off.
  std::atomic<std::uint64_t>* statistics = nullptr;
  /// Per vertex stream: primitives written by transform feedback, and primitives that would have been; two counters.
  std::array<std::atomic<std::uint64_t>*, kMaxStreams> feedback{};
  std::array<std::atomic<std::uint64_t>*, kMaxStreams> generated{};  ///< per vertex stream: primitives

  void count(Statistic statistic, std::uint64_t value) const {
    if (statistics) statistics[static_cast<std::size_t>(statistic)].fetch_add(value, std::memory_order_relaxed);
  }
};

struct NativeShader;  // raster/stage.h
class DrawObserver;   // raster/observe.h
class TileObserver;   // raster/observe.h

struct DrawCall {
  const State* state = nullptr;  ///< lives until the flush
  const spirv::Shader* vertex = nullptr;
  const spirv::Shader *control = nullptr, *evaluation = nullptr;  ///< both or none
  const spirv::Shader* geometry = nullptr;
  const spirv::Shader* fragment = nullptr;  ///< null: no fragment shader
  spirv::ResourceTable vertex_resources;  ///< of all stages before rasterization: descriptors, dynamic offsets applied,
                                          ///< push constants
  spirv::ResourceTable fragment_resources;
  const NativeShader* native_vertex = nullptr;    ///< instead of `vertex`: a stage written in C++
  const NativeShader* native_fragment = nullptr;  ///< instead of `fragment`
  spirv::Fault* fault = nullptr;
  std::array<VertexBinding, kMaxVertexBindings> vertex_binding{};
  // indices: null for non-indexed draws
  const std::byte* index_data = nullptr;  ///< index 0 of the bound index buffer
  std::uint64_t index_bytes = 0;          ///< readable from index_data; beyond: index 0
  VkIndexType index_type = VK_INDEX_TYPE_UINT16;
  std::uint32_t first = 0;  ///< firstVertex or firstIndex
  std::uint32_t count = 0;  ///< vertexCount or indexCount
  std::int32_t vertex_offset = 0;
  std::uint32_t first_instance = 0, instance_count = 1;
  std::uint32_t skipped_instances = 0;  ///< of those, the first ones that are not drawn
  std::uint32_t draw_index = 0;
  QueryCounters queries;
  bool general_path = false;              ///< tests: without the fast paths, which must not be noticed otherwise
  TransformFeedback* feedback = nullptr;  ///< null: not active; lives until the flush
  DrawObserver* observer = nullptr;       ///< null: nobody observes
  TileObserver* tile_observer = nullptr;  ///< null: nobody observes single tiles

  /// Whether only packed waves are drawn.
  bool takes_general_path() const { return general_path || observer != nullptr; }
};

}  // namespace vitrine::raster
