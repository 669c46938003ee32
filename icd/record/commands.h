// Every recorded command: a trivially destructible struct each, Cmd and its name in icd/record/commands.def, the one
// list of them all. Replay has an execute() per row (icd/replay/replay.h); a missing one does not link.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "icd/edge/vulkan_api.h"
#include "icd/object/color_locations.h"
#include "icd/object/shader_links.h"
#include "icd/properties.h"
#include "icd/record/dynamic_state.h"

namespace vitrine::icd {

struct Buffer;
struct CommandBuffer;
struct DescriptorSet;
struct Event;
struct Framebuffer;
struct Image;
struct ImageView;
struct Pipeline;
struct QueryPool;
struct RenderPass;
struct ShaderObject;

// ---- state

inline constexpr std::uint32_t kMaxDescriptorBuffers =
    kClaimedPhysicalDeviceDescriptorBufferPropertiesEXT.maxDescriptorBufferBindings;

struct CmdBindPipeline {
  const Pipeline* pipeline;
};
#ifdef VK_EXT_shader_object
struct CmdBindShaders {
  std::array<ShaderObject*, kGraphicsStages + 1> stages;  ///< graphics stages, then compute; null: none from now on
  std::uint32_t bound;                                    ///< bit i: stages[i] counts
};
/// What shader objects draw to; pipelines know it themselves.
struct CmdSetColorLocations {
  ColorLocations locations;
};
#endif
struct CmdBindDescriptorSets {
  VkPipelineBindPoint bind_point;
  std::uint32_t first_set;
  std::span<DescriptorSet* const> sets;
  std::span<const std::uint32_t> first_dynamic;  ///< per set, in the pseudo set of dynamic buffers
  std::span<const std::uint32_t> offsets;        ///< dynamic offsets of all sets in order
};
/// Buffers that descriptors are read from, by index: their addresses.
struct CmdBindDescriptorBuffers {
  std::span<const VkDeviceAddress> addresses;  ///< at most kMaxDescriptorBuffers
};
/// Sets that are read there.
struct CmdSetDescriptorBufferOffsets {
  VkPipelineBindPoint bind_point;
  std::uint32_t first_set;
  std::span<const std::uint32_t> buffers;  ///< per set: index of the buffer
  std::span<const VkDeviceSize> offsets;   ///< per set: bytes into it
};
struct CmdPushConstants {
  std::uint32_t offset;
  std::span<const std::byte> bytes;
  std::span<const VkPushConstantRange> ranges;  ///< of the layout, which may be gone when the command is replayed
};
struct CmdBindVertexBuffers {
  std::uint32_t first;
  std::span<const Buffer* const> buffers;  ///< null: reads as out of bounds
  std::span<const VkDeviceSize> offsets;
  std::span<const VkDeviceSize> sizes;    ///< empty: to the end
  std::span<const VkDeviceSize> strides;  ///< empty: as they are
};
struct CmdBindIndexBuffer {
  const Buffer* buffer;
  VkDeviceSize offset;
  VkDeviceSize size;  ///< VK_WHOLE_SIZE: to the end
  VkIndexType type;
};
struct CmdSetViewport {
  std::uint32_t first;
  std::span<const VkViewport> viewports;
  bool sets_count;
};
struct CmdSetScissor {
  std::uint32_t first;
  std::span<const VkRect2D> scissors;
};
struct CmdSetDiscardRectangle {
  std::uint32_t first;
  std::span<const VkRect2D> rectangles;
};
struct CmdSetDepthBias {
  float constant, clamp, slope;
  raster::DepthBiasUnit unit;
};
struct CmdSetFragmentShadingRate {
  VkExtent2D size;
  std::array<VkFragmentShadingRateCombinerOpKHR, 2> combiners;
};
struct CmdSetBlendConstants {
  std::array<float, 4> constants;
};
struct CmdSetDepthBounds {
  float min, max;
};
struct CmdSetStencil {
  std::uint8_t raster::StencilFace::*which;
  VkStencilFaceFlags faces;
  std::uint32_t value;
};
struct CmdSetStencilOp {
  VkStencilFaceFlags faces;
  VkStencilOp fail, pass, depth_fail;
  VkCompareOp compare;
};
/// A state that is one word: VITRINE_DYNAMIC_VALUE and VITRINE_DYNAMIC_COMMAND of dynamic_state.def.
struct CmdSetValue {
  DynamicState which;
  std::uint32_t value;
};
struct CmdSetSampleLocations {
  raster::SampleLocations locations;
};
struct CmdSetLineStipple {
  std::uint32_t factor;
  std::uint16_t pattern;
};
struct CmdSetColorWriteEnable {
  ColorWrites writes;
};
/// One of kBlendEnable, kBlendEquation, kWriteMask for attachments from `first` on: the members that it names.
struct CmdSetBlend {
  DynamicState which;
  std::uint32_t first;
  std::span<const raster::BlendAttachment> attachments;
};
struct CmdSetVertexInput {
  std::span<const VkVertexInputBindingDescription2EXT> bindings;
  std::span<const VkVertexInputAttributeDescription2EXT> attributes;
};

// ---- work

struct CmdDraw {
  std::uint32_t vertex_count, instance_count, first_vertex, first_instance;
};
struct CmdDrawIndexed {
  std::uint32_t index_count, instance_count, first_index;
  std::int32_t vertex_offset;
  std::uint32_t first_instance;
};
struct CmdDrawMulti {
  std::span<const VkMultiDrawInfoEXT> draws;
  std::uint32_t instance_count, first_instance;
};
struct CmdDrawMultiIndexed {
  std::span<const VkMultiDrawIndexedInfoEXT> draws;
  std::uint32_t instance_count, first_instance;
};
/// Draws, dispatches and clears of attachments have no effect while the word is zero (or, inverted, is not).
struct CmdBeginConditionalRendering {
  const Buffer* buffer;
  VkDeviceSize offset;
  bool inverted;
};
struct CmdEndConditionalRendering {};
struct CmdDrawIndirect {
  const Buffer* buffer;
  VkDeviceSize offset;
  const Buffer* count_buffer;  ///< null: draw_count as it is
  VkDeviceSize count_offset;
  std::uint32_t draw_count;  ///< at most
  std::uint32_t stride;
  bool indexed;
};
struct CounterBuffer {
  Buffer* buffer;  ///< may be null
  VkDeviceSize offset;
};
/// vkCmdDrawIndirectByteCountEXT: (counter - subtracted) / stride vertices.
struct CmdDrawByteCount {
  CounterBuffer counter;
  std::uint32_t instance_count, first_instance, subtracted, stride;
};
struct FeedbackBinding {
  Buffer* buffer;  ///< may be null
  VkDeviceSize offset, size;
};
struct CmdBindTransformFeedbackBuffers {
  std::uint32_t first;
  std::span<const FeedbackBinding> bindings;
};
struct CmdBeginTransformFeedback {
  std::uint32_t first;
  std::span<const CounterBuffer> counters;
};
struct CmdEndTransformFeedback {
  std::uint32_t first;
  std::span<const CounterBuffer> counters;
};
struct CmdDispatch {
  std::uint32_t base[3];
  std::uint32_t groups[3];
};
struct CmdDispatchIndirect {
  const Buffer* buffer;
  VkDeviceSize offset;
};

// ---- render passes

struct CmdBeginRenderPass {
  const RenderPass* render_pass;
  const Framebuffer* framebuffer;
  VkRect2D area;
  std::span<const VkClearValue> clear_values;
  std::span<const ImageView* const> attachments;  ///< the framebuffer's
};
struct RenderingAttachment {
  const ImageView* view;               ///< null: unused
  const ImageView* resolve;            ///< null: none
  VkResolveModeFlagBits resolve_mode;  ///< of `resolve`
  VkAttachmentLoadOp load;
  VkAttachmentStoreOp store;  ///< what observers are told
  VkClearValue clear;
  VkImageLayout layout, resolve_layout;  ///< what observers are told
};
struct CmdBeginRendering {
  VkRenderingFlags flags;
  VkRect2D area;
  std::uint32_t layers, view_mask;
  std::uint32_t forced_samples;  ///< of single-sampled attachments while they are drawn to
  std::span<const RenderingAttachment> colors;
  RenderingAttachment depth, stencil;
  const ImageView* shading_rate;    ///< null: none
  VkExtent2D shading_rate_texel{};  ///< of that
};
struct CmdEndRendering {};
struct CmdNextSubpass {};
struct CmdEndRenderPass {};
struct CmdClearAttachments {
  std::span<const VkClearAttachment> attachments;
  std::span<const VkClearRect> rects;
};
struct CmdExecuteCommands {
  std::span<const CommandBuffer* const> buffers;
};

// ---- transfers

struct CmdCopyBuffer {
  const Buffer* source;
  const Buffer* target;
  std::span<const VkBufferCopy> regions;
};
struct CmdCopyImage {
  const Image* source;
  const Image* target;
  std::span<const VkImageCopy> regions;
};
struct CmdBlitImage {
  const Image* source;
  const Image* target;
  std::span<const VkImageBlit> regions;
  VkFilter filter;
};
struct CmdResolveImage {
  const Image* source;
  const Image* target;
  std::span<const VkImageResolve> regions;
};
struct CmdCopyBufferToImage {
  const Buffer* source;
  const Image* target;
  std::span<const VkBufferImageCopy> regions;
};
struct CmdCopyImageToBuffer {
  const Image* source;
  const Buffer* target;
  std::span<const VkBufferImageCopy> regions;
};
struct CmdUpdateBuffer {
  const Buffer* target;
  VkDeviceSize offset;
  std::span<const std::byte> bytes;
};
struct CmdFillBuffer {
  const Buffer* target;
  VkDeviceSize offset, size;  ///< size may be VK_WHOLE_SIZE
  std::uint32_t value;
};
struct CmdClearColorImage {
  const Image* image;
  VkClearColorValue value;
  std::span<const VkImageSubresourceRange> ranges;
};
struct CmdClearDepthStencilImage {
  const Image* image;
  VkClearDepthStencilValue value;
  std::span<const VkImageSubresourceRange> ranges;
};

// ---- synchronisation and queries

struct CmdPipelineBarrier {};
struct CmdSetEvent {
  Event* event;
  bool set;
};
struct CmdWaitEvents {
  std::span<const VkEvent> events;
};
struct CmdBeginQuery {
  QueryPool* pool;
  std::uint32_t query;
  VkQueryControlFlags flags;
  std::uint32_t index = 0;  ///< vertex stream
};
struct CmdEndQuery {
  QueryPool* pool;
  std::uint32_t query;
  std::uint32_t index = 0;  ///< vertex stream
};
struct CmdResetQueryPool {
  QueryPool* pool;
  std::uint32_t first, count;
};
struct CmdWriteTimestamp {
  QueryPool* pool;
  std::uint32_t query;
  bool after_work;  ///< the stage needs earlier commands to be done
};
struct CmdCopyQueryPoolResults {
  const QueryPool* pool;
  std::uint32_t first, count;
  const Buffer* target;
  VkDeviceSize offset, stride;
  VkQueryResultFlags flags;
};

// ---- what observers are told; a command buffer has none where no tool is on

/// The application called a command: what follows, to the next mark, is what it recorded.
struct CmdMark {
  const char* name;  ///< "vkCmdDraw", static
};
struct CmdBeginLabel {
  std::span<const char> name;
};
struct CmdEndLabel {};
struct CmdInsertLabel {
  std::span<const char> name;
};
struct DiscardedImage {
  const Image* image;
  VkImageSubresourceRange range;
};
/// Barriers from VK_IMAGE_LAYOUT_UNDEFINED: they leave the contents of these images undefined.
struct CmdDiscardImages {
  std::span<const DiscardedImage> images;
};

/// A memory barrier: of all memory, a buffer or an image.
struct RecordedBarrier {
  VkPipelineStageFlags2 first_stages, second_stages;
  VkAccessFlags2 first_accesses, second_accesses;
  const Buffer* buffer;  ///< null: not of one
  VkDeviceSize offset, size;
  const Image* image;  ///< null: not of one
  VkImageSubresourceRange range;
  VkImageLayout from, to;
};
/// What orders commands, as the tool sync is told: behind the command that does it.
struct CmdDependency {
  enum class Kind : std::uint8_t { kBarrier, kSetEvent, kWaitEvents } kind;
  std::span<const VkEvent> events;
  std::span<const RecordedBarrier> barriers;
};

struct UsedLayout {
  const Image* image;
  VkImageSubresourceRange range;
  VkImageLayout layout;
};
/// The layouts that the command before it says images have.
struct CmdUsedLayouts {
  std::span<const UsedLayout> images;
};

/// Every recorded command, numbered.
enum class CommandType : std::uint32_t {
#define VITRINE_COMMAND(name) k##name,
#include "icd/record/commands.def"
};

/// Number of a command's struct.
template <class T>
inline constexpr CommandType kCommandType = T::missing_from_commands_def;
#define VITRINE_COMMAND(name) \
  template <>                 \
  inline constexpr CommandType kCommandType<Cmd##name> = CommandType::k##name;
#include "icd/record/commands.def"

}  // namespace vitrine::icd
